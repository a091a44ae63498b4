/* Fresnel curves: functions of the cosine of incidence on a facet that a facet integral is taken of.
 *
 * Every operator is linear in the Fresnel reflectance, so an integral is computed once for a few curves and
 * combined for thousands of materials. Curve 0 is the constant 1; curve k >= 1 is an absorptance 1 - F_k, so
 * that a material is  F = 1 - sum_k c_k (1 - F_k)  and total reflection (c = 0) is represented exactly:
 * energy is then conserved to rounding whatever the quadrature does.
 */
#ifndef LACQUER_PRECOMPUTE_CURVES_H
#define LACQUER_PRECOMPUTE_CURVES_H

#include "lacquer.h"
#include "microfacet/panels.h"

enum { LQ_CURVES_MAX = 96 }; /* the constant included */

typedef enum lq_curve_family {
    LQ_CURVES_CONDUCTOR, /* exact, index n + i kappa */
    LQ_CURVES_SCHLICK    /* one curve, 1 - (1 - c)^5 (Schlick 1994) */
} lq_curve_family;

typedef struct lq_curves {
    lq_curve_family family;
    int count;                   /* curves, the constant included */
    double n[LQ_CURVES_MAX];     /* of curve k: its index; entry 0 unused */
    double kappa[LQ_CURVES_MAX]; /* likewise */
    lq_panels panels;            /* break points in the angle of incidence that resolve every curve */
} lq_curves;

/* Only the constant: for directional albedos. */
void lq_curves_none(lq_curves *curves);
/* The constant and Schlick's curve. */
void lq_curves_schlick(lq_curves *curves);
/* The constant and one conductor. */
void lq_curves_conductor(lq_curves *curves, double n, double kappa);

/* A basis for `count` conductors, chosen among them: adaptive cross approximation with full pivoting
 * (Bebendorf 2000), until no absorptance anywhere is missed by more than `accuracy`. `coefficients` gets
 * c_k for material m at [m * LQ_CURVES_MAX + k], k >= 1 (entry 0 is set to 0). *missed gets the largest
 * remaining difference, which exceeds `accuracy` only when LQ_CURVES_MAX was not enough. */
lq_status lq_curves_basis(lq_curves *curves, const double *n, const double *kappa, size_t count,
                          double accuracy, double *coefficients, double *missed, lq_error *error);

/* The `count` curves at one angle of incidence d with cosine cos_d. */
void lq_curves_at(const lq_curves *curves, double cos_d, double *values);

/* Panels of the angle between ray and facet that suit the reflectances of `count` materials, LQ_CURVES_MAX at
 * most. */
void lq_fresnel_panels(lq_panels *panels, const double *n, const double *kappa, int count);

#endif
