/* Walks above the microsurface: what all walks share, the reflection-only walk and single scattering. */
#include "validate/walk.h"

#include "microfacet/fresnel.h"
#include "system/status.h"
#include "validate/sample_visible.h"
#include "validate/walk_ray.h"
#include "validate/walk_reduce.h"

#include <math.h>

typedef struct context {
    const lq_walk *walk;
    lq_visible visible;
    lq_masking masking;
    size_t order_count;
} context;

lq_walk lq_walk_default(void) {
    const lq_walk walk = {.ndf = lq_ndf_find("ggx"),
                          .alpha = 0.5,
                          .fresnel = LQ_WALK_SCHLICK,
                          .n = 1.0,
                          .f0 = 1.0,
                          .f90 = 1.0,
                          .mu = 1.0,
                          .tau_near = 1.0,
                          .tau_far = 1.0,
                          .samples = 100000,
                          .seed = 1};
    return walk;
}

static double fresnel(const lq_walk *walk, double cosine) {
    if (walk->fresnel == LQ_WALK_CONDUCTOR)
        return lq_fresnel_conductor(fmin(cosine, 1.0), walk->n, walk->kappa);
    if (walk->fresnel == LQ_WALK_DIELECTRIC) return lq_fresnel_dielectric(fmin(cosine, 1.0), walk->n, NULL);
    const double rest = fmax(1.0 - cosine, 0.0);
    const double square = rest * rest;
    return walk->f0 + (walk->f90 - walk->f0) * square * square * rest;
}

static void sample_reflect(const void *data, lq_stream *stream, double *values) {
    const context *c = data;
    const lq_walk *walk = c->walk;
    const double mu = lq_ray_incidence(walk, stream);
    lq_ray ray = {.z = -mu, .s = lq_sine(mu), .weight = 1.0};
    lq_ray_descend(&ray, walk->ndf, walk->alpha, stream);
    for (size_t order = 1; ray.weight > 0.0; order++) {
        lq_facet facet;
        lq_visible_sample(&c->visible, -ray.z, ray.s, stream, &facet);
        lq_ray_reflect(&ray, &facet);
        ray.weight *= fresnel(walk, facet.cosine);
        if (ray.z < 0.0) {
            lq_ray_descend(&ray, walk->ndf, walk->alpha, stream);
        } else if (lq_ray_rise(&ray, walk->ndf, walk->alpha, stream)) {
            values[0] = ray.weight;
            if (order <= c->order_count) values[order] = ray.weight;
            return;
        }
        lq_ray_roulette(&ray, stream);
    }
}

static void sample_single(const void *data, lq_stream *stream, double *values) {
    const context *c = data;
    const lq_walk *walk = c->walk;
    const double mu = lq_ray_incidence(walk, stream);
    lq_ray ray = {.z = -mu, .s = lq_sine(mu), .weight = 1.0};
    lq_facet facet;
    lq_visible_sample(&c->visible, mu, ray.s, stream, &facet);
    lq_ray_reflect(&ray, &facet);
    if (ray.z <= 0.0) return;
    /* Correlated: (1 + L_i)/(1 + L_i + L_o), times mu_i mu_o so that grazing stays finite. */
    const double in = lq_area_above(walk->ndf, walk->alpha, mu, lq_sine(mu));
    const double out = walk->ndf->area_below(walk->ndf, walk->alpha, ray.z, ray.s);
    const double g =
        c->masking == LQ_SEPARABLE ? ray.z / (ray.z + out) : in * ray.z / (in * ray.z + mu * out);
    values[0] = fresnel(walk, facet.cosine) * g;
}

static void sample_smooth(const void *data, lq_stream *stream, double *values) {
    const context *c = data;
    values[0] = values[1] = fresnel(c->walk, lq_ray_incidence(c->walk, stream));
}

static bool in_range(double x, double low, double high) {
    return x >= low && x <= high;
}

lq_status lq_walk_check(const lq_walk *walk, lq_error *error) {
    if (!walk->ndf) return lq_fail(error, LQ_BAD_INPUT, "random walk: no NDF");
    if (!in_range(walk->alpha, 0.0, 1.0))
        return lq_fail(error, LQ_BAD_INPUT, "random walk: alpha = %g is not in [0, 1]", walk->alpha);
    if (!walk->cosine && !in_range(walk->mu, 0.0, 1.0))
        return lq_fail(error, LQ_BAD_INPUT, "random walk: mu = %g is not in [0, 1]", walk->mu);
    if (!(walk->n >= 0.0) || !(walk->kappa >= 0.0) || !isfinite(walk->n) || !isfinite(walk->kappa))
        return lq_fail(error, LQ_BAD_INPUT, "random walk: index %g + %g i is not finite and >= 0", walk->n,
                       walk->kappa);
    if (!in_range(walk->f0, 0.0, 1.0) || !in_range(walk->f90, 0.0, 1.0))
        return lq_fail(error, LQ_BAD_INPUT, "random walk: F0 = %g, F90 = %g are not both in [0, 1]", walk->f0,
                       walk->f90);
    if (!in_range(walk->tau_near, 0.0, 1.0) || !in_range(walk->tau_far, 0.0, 1.0))
        return lq_fail(error, LQ_BAD_INPUT, "random walk: transmittances %g, %g are not both in [0, 1]",
                       walk->tau_near, walk->tau_far);
    if (!in_range(walk->rho, 0.0, 1.0))
        return lq_fail(error, LQ_BAD_INPUT, "random walk: albedo %g of the base is not in [0, 1]", walk->rho);
    if (walk->samples == 0 || walk->samples > LQ_WALK_MAX_SAMPLES)
        return lq_fail(error, LQ_BAD_INPUT, "random walk: %zu samples, accepted are 1 to %zu", walk->samples,
                       (size_t)LQ_WALK_MAX_SAMPLES);
    return LQ_OK;
}

lq_status lq_walk_reflect(const lq_walk *walk, lq_walk_mean *energy, lq_walk_mean *orders, size_t order_count,
                          lq_error *error) {
    lq_status status = lq_walk_check(walk, error);
    if (status != LQ_OK) return status;
    if (!orders) order_count = 0;
    if (order_count > LQ_WALK_MAX_ORDERS)
        return lq_fail(error, LQ_BAD_INPUT, "random walk: %zu orders, at most %d", order_count,
                       LQ_WALK_MAX_ORDERS);
    context c = {.walk = walk, .order_count = order_count};
    lq_walk_mean means[LQ_WALK_MAX_ORDERS + 1] = {{0.0, 0.0}};
    if (walk->alpha > 0.0) {
        lq_visible_make(&c.visible, walk->ndf, walk->alpha, true);
        status = lq_walk_reduce(walk, sample_reflect, &c, order_count + 1, means, error);
    } else {
        status = lq_walk_reduce(walk, sample_smooth, &c, 2, means, error);
    }
    if (status != LQ_OK) return status;
    *energy = means[0];
    for (size_t i = 0; i < order_count; i++) orders[i] = means[i + 1];
    return LQ_OK;
}

lq_status lq_walk_single(const lq_walk *walk, lq_masking masking, lq_walk_mean *energy, lq_error *error) {
    lq_status status = lq_walk_check(walk, error);
    if (status != LQ_OK) return status;
    context c = {.walk = walk, .masking = masking};
    if (walk->alpha == 0.0) {
        lq_walk_mean means[2];
        status = lq_walk_reduce(walk, sample_smooth, &c, 2, means, error);
        if (status == LQ_OK) *energy = means[0];
        return status;
    }
    lq_visible_make(&c.visible, walk->ndf, walk->alpha, true);
    return lq_walk_reduce(walk, sample_single, &c, 1, energy, error);
}
