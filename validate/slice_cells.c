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

bool lq_slice_point_at(lq_slice_layout layout, double mu, size_t cell, int sub, lq_slice_point *p) {
    const double step = pi / 180.0 / LQ_SLICE_SUB;
    const double theta = step * ((double)(cell / LQ_SLICE_PHI * LQ_SLICE_SUB) + sub / LQ_SLICE_SUB);
    const double phi = step * ((double)(cell % LQ_SLICE_PHI * LQ_SLICE_SUB) + sub % LQ_SLICE_SUB + 0.5);
    const double s = sin(theta + 0.5 * step);
    *p = (lq_slice_point){.x = s * cos(phi),
                          .y = s * sin(phi),
                          .z = cos(theta + 0.5 * step),
                          .solid = 2.0 * step * s * sin(0.5 * step)};
    if (layout == LQ_SLICE_HALF) mirror(mu, p);
    return p->z > 0.0 && p->solid > 0.0;
}

void lq_slice_solids(lq_slice_layout layout, double mu, double *solid) {
    for (size_t cell = 0; cell < LQ_SLICE_CELLS; cell++) {
        solid[cell] = 0.0;
        for (int sub = 0; sub < LQ_SLICE_SUB * LQ_SLICE_SUB; sub++) {
            lq_slice_point p;
            lq_slice_point_at(layout, mu, cell, sub, &p);
            solid[cell] += p.solid;
        }
    }
}
