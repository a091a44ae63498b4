/* weidlich.c - one ray down to a layer and one up again. */
#include "stack/weidlich.h"

#include <math.h>

#include "microfacet/fresnel.h"
#include "stack/description.h"
#include "system/status.h"

static const double PI = 3.14159265358979323846;

lq_status lq_weidlich_check(const lq_stack *stack, lq_error *error) {
    if (stack->layers[stack->layer_count - 1].type != LQ_LAYER_DIELECTRIC) return LQ_OK;
    return lq_fail(
        error, LQ_BAD_INPUT,
        "the last layer lets light through, which the model of Weidlich and Wilkie does not follow; "
        "accepted: a conductor or lambertian as the last one");
}

/* ======================================================================================
 *                                       One interface
 * ====================================================================================== */

typedef struct vector {
    double x, y, z;
} vector;

static double dot(vector a, vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector half_of(vector i, vector o) {
    const vector h = {i.x + o.x, i.y + o.y, i.z + o.z};
    const double scale = 1.0 / sqrt(dot(h, h));
    return (vector){h.x * scale, h.y * scale, h.z * scale};
}

/* mu_o sqrt(1 + alpha^2 tan^2 theta_i) mu_i and the other way round, for masking. */
static double smith(double i, double o, double alpha) {
    const double a2 = alpha * alpha;
    return o * sqrt(a2 + (1.0 - a2) * i * i) + i * sqrt(a2 + (1.0 - a2) * o * o);
}

/* D G2 / (4 mu_i mu_o). */
static double facets(vector i, vector o, double alpha) {
    const vector h = {i.x + o.x, i.y + o.y, i.z + o.z};
    const double a2 = alpha * alpha, tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z), wide = a2 + tan2;
    return a2 * (1.0 + tan2) * (1.0 + tan2) / (PI * wide * wide) / (2.0 * smith(i.z, o.z, alpha));
}

static double fresnel(const lq_layer *layer, int channel, double index, double cosine) {
    double refracted;
    cosine = fmin(cosine, 1.0); /* but for rounding */
    const double n = layer->n.value[channel] / index;
    return layer->type == LQ_LAYER_DIELECTRIC
               ? lq_fresnel_dielectric(cosine, n, &refracted)
               : lq_fresnel_conductor(cosine, n, layer->kappa.value[channel] / index);
}

static double brdf(const lq_weidlich *model, const lq_layer *layer, int channel, double index, vector i,
                   vector o) {
    if (layer->type == LQ_LAYER_LAMBERTIAN) return layer->rho.value[channel] / PI;
    const double alpha = fmax(layer->alpha_x.value[channel], model->least_alpha);
    return fresnel(layer, channel, index, dot(i, half_of(i, o))) * facets(i, o, alpha);
}

/* A direction that leads out through a facet, as it is below it; false where all is reflected. */
static bool refract(vector *w, vector normal, double eta) {
    const double c = dot(*w, normal), below2 = 1.0 - (1.0 - c * c) / (eta * eta);
    if (!(below2 > 0.0)) return false;
    const double shift = sqrt(below2) - c / eta;
    *w =
        (vector){w->x / eta + shift * normal.x, w->y / eta + shift * normal.y, w->z / eta + shift * normal.z};
    return w->z > 0.0;
}

/* ======================================================================================
 *                                      To a layer and back
 * ====================================================================================== */

typedef struct rays {
    vector i, o;
    double index, weight;
} rays;

/* Through a dielectric and its medium, both ways. */
static bool enter(const lq_weidlich *model, const lq_layer *layer, int channel, rays *r) {
    const double eta = layer->n.value[channel] / r->index;
    const vector normal = model->corrected ? (vector){0.0, 0.0, 1.0} : half_of(r->i, r->o);
    const double in = 1.0 - fresnel(layer, channel, r->index, dot(r->i, normal));
    const double out = 1.0 - fresnel(layer, channel, r->index, dot(r->o, normal));
    if (model->corrected) {
        r->weight *= in * out / (eta * eta);
    } else {
        const double alpha = fmax(layer->alpha_x.value[channel], model->least_alpha);
        const double masking = 2.0 * r->i.z * r->o.z / smith(r->i.z, r->o.z, alpha);
        r->weight *= in * (1.0 - masking + out * masking);
    }
    if (!refract(&r->i, normal, eta) || !refract(&r->o, normal, eta)) return false;
    r->weight *= pow(lq_medium_transmittance(&layer->medium, channel), 1.0 / r->i.z + 1.0 / r->o.z);
    r->index = layer->n.value[channel];
    return r->weight > 0.0;
}

double lq_weidlich_value(const lq_weidlich *model, int channel, size_t k, lq_incidence from, double x,
                         double y, double z) {
    rays r = {{-from.sine, 0.0, from.cosine}, {x, y, z}, 1.0, 1.0};
    for (size_t j = 0; j < k; j++)
        if (!enter(model, &model->stack->layers[j], channel, &r)) return 0.0;
    return r.weight * brdf(model, &model->stack->layers[k], channel, r.index, r.i, r.o) * z;
}
