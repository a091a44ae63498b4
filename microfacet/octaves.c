/* Cubics through four even points a cell. */
#include "microfacet/octaves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MANTISSA_BITS = 52 };

static int64_t bits_of(double x) {
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

int lq_octaves_make(lq_octaves *o, int octaves, int bits) {
    *o = (lq_octaves){.floor = ldexp(1.0, -octaves), .shift = MANTISSA_BITS - bits};
    o->first = bits_of(o->floor) >> o->shift;
    o->cells = (size_t)octaves << bits;
    o->cubic = calloc(o->cells, sizeof *o->cubic);
    return o->cubic != NULL;
}

void lq_octaves_free(lq_octaves *o) {
    free(o->cubic);
    o->cubic = NULL;
}

double lq_octaves_start(const lq_octaves *o, size_t cell) {
    const int64_t bits = (o->first + (int64_t)cell) * ((int64_t)1 << o->shift);
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static double width_of(const lq_octaves *o, size_t cell) {
    return lq_octaves_start(o, cell + 1) - lq_octaves_start(o, cell);
}

double lq_octaves_at(const lq_octaves *o, size_t i) {
    const size_t cell = i / 3;
    return lq_octaves_start(o, cell) + (double)(i % 3) / 3.0 * width_of(o, cell);
}

void lq_octaves_fit(lq_octaves *o, const double *samples) {
    for (size_t cell = 0; cell < o->cells; cell++) {
        const double *y = samples + 3 * cell;
        const double third = 3.0 / width_of(o, cell);
        const double d1 = y[1] - y[0], d2 = y[2] - 2.0 * y[1] + y[0], d3 = y[3] - 3.0 * (y[2] - y[1]) - y[0];
        /* Newton: y0 + u d1 + u(u-1)/2 d2 + u(u-1)(u-2)/6 d3, u in thirds */
        o->cubic[cell][0] = y[0];
        o->cubic[cell][1] = (d1 - 0.5 * d2 + d3 / 3.0) * third;
        o->cubic[cell][2] = 0.5 * (d2 - d3) * third * third;
        o->cubic[cell][3] = d3 / 6.0 * third * third * third;
    }
}

double lq_octaves_integral(const lq_octaves *o, size_t cell, double offset) {
    const double *c = o->cubic[cell];
    return offset * (c[0] + offset * (c[1] / 2.0 + offset * (c[2] / 3.0 + offset * c[3] / 4.0)));
}

double lq_octaves_value(const lq_octaves *o, double x) {
    const double inside = fmin(fmax(x, o->floor), 0x1.fffffffffffffp-1);
    const size_t cell = (size_t)((bits_of(inside) >> o->shift) - o->first);
    const double u = inside - lq_octaves_start(o, cell), *c = o->cubic[cell];
    return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}
