/* First bounce: the light that a rough interface sends back after one hit, for many Fresnel curves at once.
 *
 *     escaping(mu)  = integral f(omega.m) D_omega(m) G dm          (B18 eq. 2 with F = f)
 *     remaining(mu) = integral f(omega.m) D_omega(m) (1 - G) dm    what goes on to hit again
 *
 * with G = (1 + Lambda_i)/(1 + Lambda_i + Lambda_o) for height-correlated masking, 1/(1 + Lambda_o) for
 * separable masking, and 0 where the reflection goes down. For f = 1 the two add up to 1 exactly.
 */
#ifndef LACQUER_PRECOMPUTE_FIRST_BOUNCE_H
#define LACQUER_PRECOMPUTE_FIRST_BOUNCE_H

#include "lacquer.h"
#include "microfacet/facets.h"
#include "precompute/curves.h"

/* Roughness below which an interface is treated as smooth: angles, held in doubles, no longer resolve the
 * lobe. */
#define LQ_SMOOTH_ALPHA 1e-8

/* What treating it so can cost `escaping` at F = 1: masking takes up to 0.12 at mu ~ alpha, and
 * (alpha/mu)^2 away from grazing. The largest over `count` cosines. */
double lq_smooth_masking_error(double alpha, const double *mu, size_t count);

/* Both integrals of every curve at cosine mu in [0,1], alpha in (0,1]; arrays of curves->count. */
void lq_first_bounce(const lq_ndf *ndf, double alpha, lq_masking masking, double mu, const lq_curves *curves,
                     const lq_facet_rule *rule, double *escaping, double *remaining);

/* `escaping` for `count` cosines, [mu * curves->count + k], each at increasing resolution until its error
 * estimate, from the changes of the parts of its integral, is at most `tolerance`. Returns the largest
 * estimate. */
double lq_first_bounce_converged(const lq_ndf *ndf, double alpha, lq_masking masking, const double *mu,
                                 size_t count, const lq_curves *curves, double tolerance, double *escaping);

/* What a level of a refinement can be off by, from its change against the level before, as a sum over parts
 * of the integral without their signs, and from that level's own change (0: it was the first). */
double lq_first_bounce_estimate(double change, double older);

#endif
