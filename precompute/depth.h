/* How rays travel between the facets of a microsurface that is lit from both sides.
 *
 * Of a height h only u = C1(h) in (0,1) matters (H16): light above meets facets at the rate Lambda du/u on
 * its way up and (1 + Lambda) du/u on its way down; below the surface u is replaced by 1 - u, and the frame
 * is turned over. Functions of u are held at collocation points u = t^4 (35 - 84t + 70t^2 - 20t^3), t a
 * Chebyshev point: dense at both ends, and symmetric, so that u and 1 - u are the same points read backwards.
 *
 * Travel is a linear map from C, the value of a ray about to meet a facet at u', to E, its value setting out
 * at u: up:    E(u) = u^Lambda reward + integral over q in (u^Lambda, 1) of C(u q^(-1/Lambda)) dq down:  E(u)
 * = integral over q in (0, 1) of C(u q^(1/(1 + Lambda))) dq
 */
#ifndef LACQUER_PRECOMPUTE_DEPTH_H
#define LACQUER_PRECOMPUTE_DEPTH_H

#include "microfacet/gauss.h"
#include "precompute/kernels.h"

enum { LQ_DEPTHS_MAX = LQ_DEPTHS_LIMIT };

typedef struct lq_depths {
    int count;
    lq_gauss rule;           /* of the travel integrals */
    double u[LQ_DEPTHS_MAX]; /* ascending; u[k] + u[count - 1 - k] = 1 */
} lq_depths;

/* 4 <= count <= LQ_DEPTHS_MAX, even. */
void lq_depths_make(lq_depths *depths, int count);

/* Weights of C at the collocation points: E(from) = sum_l weights[l] C(u_l), exact for the interpolant of C
 * to rounding. Down, they add up to 1, for any lambda >= 0 and 0 < from <= 1; up to 1 - from^lambda. */
void lq_travel_down(const lq_depths *depths, double lambda, double from, double *weights);
void lq_travel_up(const lq_depths *depths, double lambda, double from, double *weights);

/* from^lambda, the part that leaves unhindered; lambda may be infinite. */
double lq_survival(double lambda, double from);

#endif
