/* f, the mapping of roughness into which bounces add (B18 sec. 4.1): f(phi(alpha)) = 2 f(alpha), f ~ v1 at 0,
 * phi = v1^-1 o v2; by its Koenigs limit f = lim 2^n v1(phi^-n(alpha)). */
#ifndef LACQUER_FIT_CURVE_H
#define LACQUER_FIT_CURVE_H

#include "microfacet/ndf.h"

enum { LQ_CURVE_DEGREE = 127, LQ_CURVE_NODES = 1024 };

/* v1, v2 and f of one NDF, tabulated once; plain data. */
typedef struct lq_curve {
    const lq_ndf *ndf;
    double v1[LQ_CURVE_DEGREE + 1], v2[LQ_CURVE_DEGREE + 1]; /* Chebyshev: ln v1, ln v2 over ln alpha */
    double pole;                  /* of f: where two bounces are no wider than one */
    double accuracy;              /* relative, of v1 and v2 together */
    double log_f[LQ_CURVE_NODES]; /* over ln(alpha / (pole - alpha)) */
} lq_curve;

#define LQ_CURVE_LEAST 1e-5 /* below, f = v1 to 1e-8 */
#define LQ_CURVE_TOP   0.97 /* of the pole: the tabulated part; beyond, f is computed from its definition */

/* The pole is at alpha = 1 where that is the uniform hemisphere (GGX, GTR). Wide lobes of Beckmann and
 * Student-t lose to the horizon what a second bounce gives back: v2 = v1 at a pole below 1, and no f beyond.
 * LQ_BAD_INPUT: an NDF without roughnesses down to 0, where the limit is taken. LQ_NOT_CONVERGED: D gives
 * values no lobe has. */
lq_status lq_curve_make(lq_curve *curve, const lq_ndf *ndf, lq_error *error);

/* f(alpha); 0 at 0, infinity where it exceeds a double (from the pole on). */
double lq_curve_f(const lq_curve *curve, double alpha);
/* The alpha with this f; lq_curve_inverse(lq_curve_f(alpha)) = alpha to 1e-10. */
double lq_curve_inverse(const lq_curve *curve, double f);

/* From the definition, slowly, with its relative error: truncation of the limit and accuracy of v1 and v2,
 * carried through every step. */
double lq_curve_limit(const lq_curve *curve, double alpha, double *error);

/* phi(alpha), the roughness of two bounces; 1 where two bounces are wider than any alpha. */
double lq_curve_two_bounces(const lq_curve *curve, double alpha);

#endif
