/* Energies of one roughness at many relative indices, from exact solves at few.
 *
 * From the rarer side energies are smooth functions of x = ln sqrt(eta^2 - 1): Fresnel's reflectance depends
 * on sqrt(eta^2 - 1 + mu^2), so that their nearest singularities lie pi / 2 off the real x axis, whatever the
 * cosine. Chebyshev interpolation in x therefore converges geometrically: a dozen solves
 * replace any number of them. The last coefficients of the series say how far it has come.
 */
#ifndef LACQUER_PRECOMPUTE_ETA_CURVE_H
#define LACQUER_PRECOMPUTE_ETA_CURVE_H

#include "lacquer.h"

/* All `count` values at one index to a tolerance, and their error. */
typedef lq_status lq_eta_solve(const void *user, double eta, double tolerance, double *values,
                               double *estimate, lq_error *error);

typedef struct lq_eta_curve {
    lq_eta_solve *solve;
    const void *user;
    size_t count; /* values of one index */
    double from;  /* the smallest index, above 1, that may be interpolated to */
    double tolerance;
} lq_eta_curve;

/* values[e * count + i] of every index; *estimate is of the largest error. Indices below `from`, and all of
 * them where there are few, are solved one by one; so are those that no series reaches. */
lq_status lq_eta_sweep(const lq_eta_curve *curve, const double *eta, size_t etas, double *values,
                       double *estimate, lq_error *error);

#endif
