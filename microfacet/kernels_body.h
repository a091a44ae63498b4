/* The loops behind kernels.h. LQ_KERNELS is the name of the function that returns this copy. */
#include "microfacet/fresnel_formula.h"
#include "microfacet/kernels.h"

#include <math.h>
#include <string.h>

static void conductors(double cos_i, size_t count, const double *restrict n, const double *restrict kappa,
                       double *restrict reflectance) {
    for (size_t i = 0; i < count; i++) reflectance[i] = lq_conductor_reflectance(cos_i, n[i], kappa[i]);
}

/* D = a^2 / (pi (a^2 cos^2 + sin^2)^2) */
static void ggx_density(double alpha, size_t count, const double *restrict cos2, const double *restrict sin2,
                        double *restrict d) {
    const double a2 = alpha * alpha, scale = 0.31830988618379067154 * a2;
    for (size_t i = 0; i < count; i++) {
        const double q = a2 * cos2[i] + sin2[i];
        d[i] = scale / (q * q);
    }
}

/* mu Lambda = (sqrt(mu^2 + a^2 sin^2) - mu) / 2, as the quotient that keeps its digits for small a. */
static void ggx_areas_below(double alpha, size_t count, const double *restrict mu, double *restrict area) {
    const double a2 = alpha * alpha;
    for (size_t i = 0; i < count; i++) {
        const double stretch2 = a2 * (1.0 - mu[i]) * (1.0 + mu[i]);
        const double sum = sqrt(mu[i] * mu[i] + stretch2) + mu[i];
        area[i] = sum > 0.0 ? 0.5 * stretch2 / sum : 0.0;
    }
}

/* Cubics at x in [floor, 1), OCTAVE_BLOCK of them; what rounding puts outside is brought back. The four
 * coefficients of a cell are loaded as one vector and four of them transposed: gathers cost twice as much. */
enum { OCTAVE_BLOCK = 16 };
typedef double octave_v4 __attribute__((vector_size(32)));

static void cubics_at(const double *restrict cubic, const int64_t *cell, octave_v4 *c) {
    octave_v4 r[4];
    for (int i = 0; i < 4; i++) memcpy(&r[i], cubic + cell[i], sizeof r[i]);
    const octave_v4 a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
    const octave_v4 b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    const octave_v4 d = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
    const octave_v4 e = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    c[0] = __builtin_shufflevector(a, d, 0, 1, 4, 5);
    c[1] = __builtin_shufflevector(b, e, 0, 1, 4, 5);
    c[2] = __builtin_shufflevector(a, d, 2, 3, 6, 7);
    c[3] = __builtin_shufflevector(b, e, 2, 3, 6, 7);
}

static void octaves_values(const lq_octaves *o, double *restrict x, double *restrict value) {
    const double least = o->floor, most = 0x1.fffffffffffffp-1;
    const int64_t first = o->first;
    const int shift = o->shift;
    int64_t cell[OCTAVE_BLOCK], bits[OCTAVE_BLOCK];
    double start[OCTAVE_BLOCK];
    for (int i = 0; i < OCTAVE_BLOCK; i++) {
        const double up = x[i] < least ? least : x[i];
        x[i] = up > most ? most : up;
    }
    memcpy(bits, x, sizeof bits);
    for (int i = 0; i < OCTAVE_BLOCK; i++) {
        cell[i] = 4 * ((bits[i] >> shift) - first);
        bits[i] &= -((int64_t)1 << shift);
    }
    memcpy(start, bits, sizeof start);
    for (int i = 0; i < OCTAVE_BLOCK; i++) x[i] -= start[i];
    for (int i = 0; i < OCTAVE_BLOCK; i += 4) {
        octave_v4 c[4], u;
        memcpy(&u, x + i, sizeof u);
        cubics_at(&o->cubic[0][0], cell + i, c);
        const octave_v4 v = c[0] + u * (c[1] + u * (c[2] + u * c[3]));
        memcpy(value + i, &v, sizeof v);
    }
    for (int i = 0; i < OCTAVE_BLOCK; i++) value[i] = value[i] > 0.0 ? value[i] : 0.0;
}

static void octaves_density(const lq_octaves *o, size_t count, const double *restrict cos2,
                            const double *restrict sin2, double *restrict d) {
    const double b2 = o->floor;
    double x[OCTAVE_BLOCK] = {0.0}, value[OCTAVE_BLOCK];
    for (size_t from = 0; from < count; from += OCTAVE_BLOCK) {
        const size_t size = count - from < OCTAVE_BLOCK ? count - from : OCTAVE_BLOCK;
        for (size_t i = 0; i < size; i++) x[i] = b2 * cos2[from + i] + sin2[from + i];
        octaves_values(o, x, value);
        memcpy(d + from, value, size * sizeof *d);
    }
}

static void octaves_areas(const lq_octaves *o, size_t count, const double *restrict mu,
                          double *restrict area) {
    const double b = o->floor, rest = 1.0 - b;
    double x[OCTAVE_BLOCK] = {0.0}, value[OCTAVE_BLOCK];
    for (size_t from = 0; from < count; from += OCTAVE_BLOCK) {
        const size_t size = count - from < OCTAVE_BLOCK ? count - from : OCTAVE_BLOCK;
        for (size_t i = 0; i < size; i++) x[i] = b + rest * mu[from + i];
        octaves_values(o, x, value);
        memcpy(area + from, value, size * sizeof *area);
    }
}

static void lunes(const double *restrict term, double cot, size_t count, const double *restrict sine,
                  const double *restrict cosine, double *restrict lune) {
    for (size_t i = 0; i < count; i++) {
        const double rest = 1.0 - cot * cosine[i] / sine[i], x = rest > 0.0 ? rest : 0.0;
        double sum = term[LQ_LUNE_TERMS - 1];
#pragma GCC unroll 32 /* or the outer loop stays scalar */
        for (int k = LQ_LUNE_TERMS - 2; k >= 0; k--) sum = sum * x + term[k];
        lune[i] = x * sqrt(x) * sum;
    }
}

/* sin h on [0, pi/2] by its Taylor series, absolute error below 1e-17. */
enum { SIN_TERMS = 11 };
static const double sin_series[SIN_TERMS] = {
    1.0,
    -1.6666666666666666667e-1,
    8.3333333333333333333e-3,
    -1.9841269841269841270e-4,
    2.7557319223985890653e-6,
    -2.5052108385441718775e-8,
    1.6059043836821614599e-10,
    -7.6471637318198164759e-13,
    2.8114572543455207632e-15,
    -8.2206352466243297170e-18,
    1.9572941063391261231e-20,
};

static void place_facets(const lq_fan_constants *k, size_t count, const double *restrict h,
                         double *restrict dpsi, double *restrict mirror, double *restrict e_z,
                         double *restrict cos2, double *restrict sin2) {
    const double lambda = k->lambda, lambda2 = k->lambda2, sin_v = k->sin_v;
    const double tilt0 = k->tilt0, tilt1 = k->tilt1, mirror0 = k->mirror0, mirror1 = k->mirror1;
    for (size_t i = 0; i < count; i++) {
        /* The cosine has a series of its own: against lambda^2 ~ alpha^2, 1 - sin^2 would be rounding. */
        const double h2 = h[i] * h[i], g = 1.57079632679489661923 - h[i], g2 = g * g;
        double s = sin_series[SIN_TERMS - 1], c = sin_series[SIN_TERMS - 1];
        for (int t = SIN_TERMS - 2; t >= 0; t--) {
            s = s * h2 + sin_series[t];
            c = c * g2 + sin_series[t];
        }
        s *= h[i];
        c *= g;
        const double s2 = s * s, c2 = c * c;
        const double inverse = 1.0 / (c2 + lambda2 * s2);
        const double half = lambda2 * s2 * inverse; /* sin^2(psi/2) */
        const double tilt = tilt0 + tilt1 * half;
        e_z[i] = sin_v * (1.0 - 2.0 * half);
        const double cosine = fabs(mirror0 + mirror1 * e_z[i]);
        mirror[i] = cosine < 1.0 ? cosine : 1.0;
        cos2[i] = (1.0 - tilt) * (1.0 - tilt);
        sin2[i] = tilt * (2.0 - tilt);
        dpsi[i] *= 2.0 * lambda * inverse;
    }
}

const lq_microfacet_kernels *LQ_KERNELS(void) {
    static const lq_microfacet_kernels kernels = {
        conductors, ggx_density, ggx_areas_below, octaves_density, octaves_areas, lunes, place_facets};
    return &kernels;
}
