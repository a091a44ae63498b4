/* How rays travel between the facets of a microsurface that is lit from both sides.
 *
 * Of a height h only u = C1(h) in (0,1) matters (H16): light above meets facets at the rate Lambda du/u on
 * its way up and (1 + Lambda) du/u on its way down; below the surface u is replaced by 1 - u, and the frame
 * is turned over. Functions of u are held at collocation points u = I_t(8, 8), an incomplete beta function, t
 * a Chebyshev point: symmetric, so that u and 1 - u are the same points read backwards, and so dense at both
 * ends that powers of the depth by next to no masking, t^(8 Lambda), can be interpolated.
 *
 * Travel is a linear map from C, the value of a ray about to meet a facet at u', to E, its value setting out
 * at u:
 * up:   E(u) = u^Lambda reward + integral over u' in (u, 1) of C(u') Lambda u^Lambda u'^(-Lambda - 1) du'
 * down: E(u) = integral over u' in (0, u) of C(u') (1 + Lambda) u'^Lambda u^(-Lambda - 1) du'
 */
#ifndef LACQUER_PRECOMPUTE_DEPTH_H
#define LACQUER_PRECOMPUTE_DEPTH_H

#include "microfacet/gauss.h"
#include "precompute/kernels.h"

enum { LQ_DEPTHS_MAX = LQ_DEPTHS_LIMIT };

typedef struct lq_depths {
    int count;
    lq_gauss rule;               /* of the travel integrals */
    double t[LQ_DEPTHS_MAX];     /* ascending */
    double u[LQ_DEPTHS_MAX];     /* u[k] + u[count - 1 - k] = 1 */
    double two_x[LQ_DEPTHS_MAX]; /* of the Chebyshev points x = 2 t - 1 */
} lq_depths;

/* 4 <= count <= LQ_DEPTHS_MAX, a multiple of 4: the kernels take four at a time. */
void lq_depths_make(lq_depths *depths, int count);

/* Weights of C at the collocation points: E(u_k) = sum_l weights[l] C(u_l), exact for the interpolant of C
 * to rounding. Down, they add up to 1, for any lambda >= 0; up to 1 - u_k^lambda. */
void lq_travel_down(const lq_depths *depths, double lambda, int k, double *weights);
void lq_travel_up(const lq_depths *depths, double lambda, int k, double *weights);

/* Where a ray from outside meets its first facet: weights that add up to 1. What that facet reflects upwards
 * and does not leave meets its next one at depths of the very same distribution. */
void lq_arrival(const lq_depths *depths, double lambda, double *weights);

/* Where light that is refracted at its first facet and rises on the other side meets its next one, depths of
 * the other side: weights that add up to 1 - lq_refracted_escape. */
void lq_refracted_hits(const lq_depths *depths, double lambda_i, double lambda_o, double *weights);

/* The chances that light which arrives with lambda_i leaves after one facet with lambda_o unhindered:
 * reflected to its own side, refracted to the other. */
double lq_reflected_escape(double lambda_i, double lambda_o);
double lq_refracted_escape(double lambda_i, double lambda_o);

/* from^lambda, the part that leaves unhindered; lambda may be infinite. */
double lq_survival(double lambda, double from);

#endif
