/* One ray of a random walk inside the microsurface: where it is, and its flights between hits.
 *
 * The depth t = -ln C1(h) is all that matters of a height (H16, restated without heights).
 * Per unit of t a ray meets the surface at the rate sigma(-omega) / |omega_z|: 1 + Lambda going down,
 * Lambda going up. The flights divide by the projected area, which is finite at grazing, not by Lambda.
 */
#ifndef LACQUER_VALIDATE_WALK_RAY_H
#define LACQUER_VALIDATE_WALK_RAY_H

#include "microfacet/ndf.h"
#include "validate/sample_visible.h"
#include "validate/stream.h"
#include "validate/walk.h"

#include <math.h>
#include <stdbool.h>

typedef struct lq_ray {
    double z, s; /* cosine (signed, up positive) and sine of the direction of travel */
    double t;    /* depth below the top of the microsurface, >= 0 */
    double weight;
} lq_ray;

/* Downwards to the next hit, `area` of the facets that face it. There always is one. */
static inline void lq_ray_descend_in(lq_ray *ray, double area, lq_stream *stream) {
    ray->t += log(lq_stream_uniform(stream)) * ray->z / area;
}

static inline void lq_ray_descend(lq_ray *ray, const lq_ndf *ndf, double alpha, lq_stream *stream) {
    lq_ray_descend_in(ray, lq_area_above(ndf, alpha, -ray->z, ray->s), stream);
}

/* Upwards: true when it leaves at the top, otherwise it is at its next hit. */
static inline bool lq_ray_rise_in(lq_ray *ray, double area, lq_stream *stream) {
    const double flight = -log(lq_stream_uniform(stream));
    /* At the very top, t = 0, even a grazing ray leaves. */
    if (flight * ray->z >= ray->t * area) return true;
    ray->t = fmax(ray->t - flight * ray->z / area, 0.0);
    return false;
}

static inline bool lq_ray_rise(lq_ray *ray, const lq_ndf *ndf, double alpha, lq_stream *stream) {
    return lq_ray_rise_in(ray, ndf->area_below(ndf, alpha, ray->z, ray->s), stream);
}

/* The cosine of incidence of one sample. */
static inline double lq_ray_incidence(const lq_walk *walk, lq_stream *stream) {
    return walk->cosine ? sqrt(lq_stream_uniform(stream)) : walk->mu;
}

/* tau^(1/z); tau = 1 costs nothing even at grazing. */
static inline double lq_ray_crossing(double log_tau, double z) {
    return log_tau == 0.0 ? 1.0 : exp(log_tau / z);
}

/* The depth of the same height seen from the other side; at most that of u = 1e-300. */
static inline double lq_ray_flip_depth(double t) {
    const double flipped = t < 0.69 ? -log(-expm1(-t)) : -log1p(-exp(-t));
    return fmin(flipped, 690.0);
}

/* Weights below `faint` play Russian roulette: what they can still add is not worth a step each. */
static inline void lq_ray_roulette(lq_ray *ray, lq_stream *stream) {
    const double faint = 0.05;
    if (ray->weight >= faint) return;
    ray->weight = lq_stream_uniform(stream) * faint < ray->weight ? faint : 0.0;
}

/* Mirror reflection of the direction -v about the facet. */
static inline void lq_ray_reflect(lq_ray *ray, const lq_facet *facet) {
    const double twice = 2.0 * facet->cosine;
    const double x = twice * facet->x - ray->s; /* v leans to +x, the ray to -x */
    const double y = twice * facet->y;
    ray->z += twice * facet->z;
    ray->s = sqrt(x * x + y * y);
}

#endif
