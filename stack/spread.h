/* spread.h - how far a GGX lobe spreads across the plane of incidence, and which roughness spreads so far.
 *
 * The lobe is the one that shaders evaluate: D G2 / (4 mu_i) with height-correlated masking, cut at the
 * horizon and normalised to its own energy.
 */
#ifndef LACQUER_STACK_SPREAD_H
#define LACQUER_STACK_SPREAD_H

#include "lacquer.h"

/* E[sin^2 theta sin^2 phi] of the lobe, light arriving at cosine mu; 0 <= alpha <= 1. To some 1e-4. */
double lq_spread_across(double mu, double alpha);
/* That, E[sin^2 theta] and E[sin theta cos phi], positive away from the light; of energy 1. */
lq_stack_lobe lq_spread_lobe(double mu, double alpha);

/* The same turned round, for a list of cosines. */
typedef struct lq_spread {
    size_t count;
    double *across; /* of each cosine, at alphas that lie like squares */
} lq_spread;

lq_status lq_spread_make(lq_spread *spread, const double *mu, size_t count, lq_error *error);
void lq_spread_free(lq_spread *spread);

/* The least alpha whose lobe spreads so far at cosine `m` of the list; 1 where none does. */
double lq_spread_alpha(const lq_spread *spread, size_t m, double across);

/* The same of one cosine. */
lq_status lq_spread_alpha_at(double mu, double across, double *alpha, lq_error *error);

#endif
