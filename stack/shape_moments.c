/* shape_moments.c - what a model's lobes send altogether: sums over half vectors that crowd as GGX has them.
 */
#include <math.h>

#include "stack/model_shape.h"

enum { RINGS = 96, SECTORS = 64 };
static const double PI = 3.14159265358979323846;

typedef struct facet {
    double x, y, z;
    double density; /* of half vectors, over solid angle */
} facet;

/* Slopes of sqrt(u / (1 - u)), stretched by the roughnesses, have the density D cos theta. Rings crowd
 * towards u = 1, the long tail; `share` is what one stands for. */
static facet facet_at(int ring, int sector, const lq_turned_ggx *ggx, double *share) {
    const double left = (ring + 0.5) / RINGS, u = 1.0 - left * left,
                 phi = 2.0 * PI * (sector + 0.5) / SECTORS;
    const double slope = sqrt(u / (1.0 - u)), sx = slope * ggx->x * cos(phi), sy = slope * ggx->y * sin(phi);
    const double z = 1.0 / sqrt(1.0 + sx * sx + sy * sy);
    *share = 2.0 * left / (RINGS * SECTORS);
    return (facet){z * (sx * ggx->cosine - sy * ggx->sine), z * (sx * ggx->sine + sy * ggx->cosine), z,
                   (1.0 - u) * (1.0 - u) / (PI * ggx->x * ggx->y * z * z * z)};
}

static void add_facet(lq_stack_lobe *sum, const lq_model_shape *shape, int channel, size_t k, facet h,
                      double share) {
    const lq_incidence from = shape->lobes[(size_t)channel * shape->count + k].from;
    const double dot = from.cosine * h.z - from.sine * h.x;
    const double x = 2.0 * dot * h.x + from.sine, y = 2.0 * dot * h.y, z = 2.0 * dot * h.z - from.cosine;
    if (!(dot > 0.0) || !(z > 0.0)) return;
    const double flux = share * lq_model_shape_lobe(shape, channel, k, x, y, z) * 4.0 * dot / h.density;
    sum->energy += flux;
    sum->sin2 += flux * (x * x + y * y);
    sum->mean += flux * x;
    sum->across += flux * y * y;
}

static lq_stack_lobe normalised(lq_stack_lobe sum, bool upright) {
    if (!(sum.energy > 0.0)) return (lq_stack_lobe){0};
    return (lq_stack_lobe){sum.energy, sum.sin2 / sum.energy, upright ? 0.0 : sum.mean / sum.energy,
                           sum.across / sum.energy};
}

lq_stack_lobe lq_model_shape_moments(const lq_model_shape *shape, int channel, size_t k) {
    const lq_shape_lobe *lobe = &shape->lobes[(size_t)channel * shape->count + k];
    if (lobe->scale > 0.0 && lobe->window.n > 0.0) return lq_window_light(&lobe->window, lobe->from.cosine);
    const lq_turned_ggx ggx = lobe->turned ? lobe->ggx : (lq_turned_ggx){lobe->alpha, lobe->alpha, 1.0, 0.0};
    lq_stack_lobe sum = {0};
    for (int r = 0; r < RINGS && lobe->scale > 0.0; r++)
        for (int s = 0; s < SECTORS; s++) {
            double share;
            const facet h = facet_at(r, s, &ggx, &share);
            add_facet(&sum, shape, channel, k, h, share);
        }
    return normalised(sum, lobe->from.sine == 0.0); /* there but for rounding */
}

static void add_lobe(lq_stack_lobe *sum, lq_stack_lobe lobe) {
    sum->energy += lobe.energy;
    sum->sin2 += lobe.energy * lobe.sin2;
    sum->mean += lobe.energy * lobe.mean;
    sum->across += lobe.energy * lobe.across;
}

lq_stack_light lq_model_shape_light(const lq_model_shape *shape, int channel) {
    lq_stack_lobe reflected = {0};
    for (size_t k = 0; k + 1 < shape->count; k++)
        add_lobe(&reflected, lq_model_shape_moments(shape, channel, k));
    return (lq_stack_light){.reflected = normalised(reflected, false),
                            .transmitted = lq_model_shape_moments(shape, channel, shape->count - 1)};
}
