/* The transmitted lobe: its variance in the projected disc, against B18 eq. 10 and 13. */
#ifndef LACQUER_FIT_TRANSMISSION_H
#define LACQUER_FIT_TRANSMISSION_H

#include "microfacet/ndf.h"

/* E[|t - mean|^2], t the transmitted direction in the projected disc, of light at cosine `mu` in [0,1] that
 * crosses a rough interface with eta = n2 / n1: facets drawn as seen, <omega.h> D(h), every facet that
 * transmits at all transmits everything, and no masking (F = 0, G = 1). *passed (or NULL): the fraction of
 * facets that transmit. *estimate (or NULL): of the absolute error, from a coarser rule. NaN where nothing
 * passes. alpha > 0. */
double lq_transmitted_variance(const lq_ndf *ndf, double alpha, double eta, double mu, double *passed,
                               double *estimate);

/* B18 eq. 10 in unsigned cosines: s = |1 - eta12 mu_i / mu_t| / 2, eta12 = n1 / n2 = 1 / eta; the lobe has
 * roughness s alpha. *ratio (or NULL): eta12 mu_i / mu_t. NaN under total internal reflection. */
double lq_transmission_scale(double eta, double mu, double *ratio);

/* A lobe of roughness `beta` around normal incidence, F = G = 1 as v1, that crosses such an interface:
 * E[sin^2 theta_t]. alpha = 0: smooth, where the disc is scaled by eta12 and the variance by eta12^2.
 * *estimate (or NULL) as above. */
double lq_transmitted_lobe_variance(const lq_ndf *ndf, double beta, double alpha, double eta,
                                    double *estimate);

#endif
