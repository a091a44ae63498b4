/* The reflection lobe at normal incidence, F = G = 1: what its roughness is worth as a variance (B18
 * sec. 4.1). */
#ifndef LACQUER_MICROFACET_LOBE_H
#define LACQUER_MICROFACET_LOBE_H

#include "microfacet/ndf.h"

/* v1(alpha) = E[sin^2 theta_o] of the lobe f_r cos theta_o, cut at the horizon and normalised there; the
 * trace of the variance in the projected disc. 0 at alpha = 0; GGX at alpha = 1: 2/3. Accurate to 1e-12. */
double lq_lobe_variance(const lq_ndf *ndf, double alpha);

/* The alpha in [0,1] whose lobe has this variance, clamped to the ends. */
double lq_lobe_roughness(const lq_ndf *ndf, double variance);

#endif
