/* slice_cells.c - which cell of a slice a direction falls into, and which directions a cell stands for. */
#include "validate/slice_cells.h"

#include <math.h>

#include "microfacet/ndf.h"

static const double pi = 3.14159265358979323846;

const char *const lq_slice_layout_names[LQ_SLICE_LAYOUTS] = {"classic", "half"};

static size_t degree(double angle, size_t most) {
    const double d = angle * (180.0 / pi);
    return d <= 0.0 ? 0 : d >= (double)most ? most - 1 : (size_t)d;
}

size_t lq_slice_cell(lq_slice_layout layout, double mu, double x, double y, double z) {
    if (layout == LQ_SLICE_HALF) {
        x -= lq_sine(mu);
        z += mu;
    }
    const double phi = atan2(y, x);
    return degree(atan2(sqrt(x * x + y * y), z), LQ_SLICE_THETA) * LQ_SLICE_PHI +
           degree(phi < 0.0 ? phi + 2.0 * pi : phi, LQ_SLICE_PHI);
}

/* The direction that a facet at (x, y, z) mirrors the light to. */
static void mirror(double mu, lq_slice_point *p) {
    const double s = lq_sine(mu), cosine = mu * p->z - s * p->x, twice = 2.0 * cosine;
    p->solid *= 4.0 * (cosine > 0.0 ? cosine : 0.0);
    p->x = twice * p->x + s;
    p->y *= twice;
    p->z = twice * p->z - mu;
}

void lq_slice_points(lq_slice_layout layout, double mu, size_t cell, lq_slice_point points[LQ_SLICE_POINTS]) {
    const double step = pi / 180.0 / LQ_SLICE_SUB;
    double cosine[LQ_SLICE_SUB], sine[LQ_SLICE_SUB];
    for (int i = 0; i < LQ_SLICE_SUB; i++) {
        const double phi = step * ((double)(cell % LQ_SLICE_PHI * LQ_SLICE_SUB) + i + 0.5);
        cosine[i] = cos(phi);
        sine[i] = sin(phi);
    }
    for (int i = 0; i < LQ_SLICE_POINTS; i++) {
        const int row = i / LQ_SLICE_SUB, column = i % LQ_SLICE_SUB;
        const double theta = step * ((double)(cell / LQ_SLICE_PHI * LQ_SLICE_SUB) + row + 0.5);
        const double s = column ? points[i - column].x : sin(theta);
        points[i] = (lq_slice_point){.x = s, .z = column ? points[i - column].z : cos(theta)};
        points[i].solid = 2.0 * step * s * sin(0.5 * step);
    }
    for (int i = 0; i < LQ_SLICE_POINTS; i++) {
        lq_slice_point *p = &points[i];
        p->y = p->x * sine[i % LQ_SLICE_SUB];
        p->x *= cosine[i % LQ_SLICE_SUB];
        if (layout == LQ_SLICE_HALF) mirror(mu, p);
    }
}

void lq_slice_solids(lq_slice_layout layout, double mu, double *solid) {
    for (size_t cell = 0; cell < LQ_SLICE_CELLS; cell++) {
        lq_slice_point points[LQ_SLICE_POINTS];
        lq_slice_points(layout, mu, cell, points);
        solid[cell] = 0.0;
        for (int i = 0; i < LQ_SLICE_POINTS; i++) solid[cell] += points[i].solid;
    }
}
