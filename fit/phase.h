/* Henyey-Greenstein as a lobe (B18 eq. 21). */
#ifndef LACQUER_FIT_PHASE_H
#define LACQUER_FIT_PHASE_H

/* v_HG(g) = E[sin^2 theta] of the phase function over the forward hemisphere, normalised there; g in [0,1].
 * *estimate (or NULL): of the absolute error, from a coarser rule. */
double lq_phase_variance(double g, double *estimate);

#endif
