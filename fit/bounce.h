/* The two-bounce experiment: the variance of a lobe after two identical reflections (B18 sec. 4.1, App. A).
 */
#ifndef LACQUER_FIT_BOUNCE_H
#define LACQUER_FIT_BOUNCE_H

#include "microfacet/ndf.h"

/* E[sin^2 theta] of the reflection lobe, F = G = 1, of light at angle `theta` in [0, pi/2], cut at the
 * horizon and normalised there. alpha > 0. */
double lq_bounce_variance(const lq_ndf *ndf, double alpha, double theta);

/* v2(alpha): every ray of the lobe at normal incidence is the incidence of a second lobe, normalised for
 * itself. *estimate (or NULL) gets the distance to a coarser rule. 0 at alpha = 0. */
double lq_two_bounce_variance(const lq_ndf *ndf, double alpha, double *estimate);

/* v1 = E[sin^2 theta] and E[sin^4 theta] of the lobe at normal incidence, from the same nodes. */
double lq_lobe_fourth_moment(const lq_ndf *ndf, double alpha, double *variance);

#endif
