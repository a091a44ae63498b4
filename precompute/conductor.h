/* FGD-infinity of a conductor: all orders of scattering between the facets, without noise.
 *
 * With depth t = -ln C1(h) the Smith microsurface of H16 is a homogeneous half-space: a ray going down at
 * cosine mu meets facets at the rate a_d = 1 + Lambda(mu), one going up at a_u = Lambda(mu), and no
 * reflection turns a rising ray down again. Let R_ij be the flux that a ray falling at node cosine i sends
 * out along node cosine j (in the sense of the interpolation basis). Adding a thin layer on top changes
 * nothing:
 *
 *     A_d R + R A_u = S,   A_d = a_d (I - P_dd),  A_u = a_u (I - P_uu),  S = a_d P_du,
 *
 * with P the scatter operators: row i integrates over the facets seen from direction i, weight F, the
 * basis at the reflected cosine. FGD-infinity at node i is sum_j R_ij; at any other cosine
 *
 *     FGD-infinity(mu) = escaping(mu) + remaining(mu) * rho(mu),
 *
 * first bounce exact (first_bounce.h), rho the part of what hits again that leaves in the end: a smooth
 * function, interpolated from the nodes. F = 1 gives rho = 1 at every node, so the furnace is exact.
 */
#ifndef LACQUER_PRECOMPUTE_CONDUCTOR_H
#define LACQUER_PRECOMPUTE_CONDUCTOR_H

#include "lacquer.h"
#include "microfacet/ndf.h"
#include "precompute/curves.h"

/* Materials that share a basis of curves: F_m = 1 - sum_k coefficients[m * curves.count + k] (1 - F_k). */
typedef struct lq_conductors {
    lq_curves curves;
    size_t count;
    const double *n, *kappa; /* of each material */
    double *coefficients;
    double missed; /* largest error of the representation */
} lq_conductors;

/* The arrays n and kappa are kept by reference. */
lq_status lq_conductors_make(lq_conductors *materials, const double *n, const double *kappa, size_t count,
                             double accuracy, lq_error *error);
void lq_conductors_free(lq_conductors *materials);

/* Energies of every material at `mu_count` cosines, energy[material * mu_count + m], for one alpha in [0,1].
 * The resolution is raised, for the materials that need it, until two in a row agree within `tolerance`;
 * *estimate gets the largest difference left, which exceeds `tolerance` only where the finest resolution
 * did not do. */
lq_status lq_conductor_energies(const lq_ndf *ndf, double alpha, const lq_conductors *materials,
                                const double *mu, size_t mu_count, double tolerance, double *energy,
                                double *estimate, lq_error *error);

/* Energy leaving after exactly 1, 2, ..., `orders` hits, for one material at one cosine, at level `level`. */
lq_status lq_conductor_orders(const lq_ndf *ndf, double alpha, const lq_conductors *material, double mu,
                              size_t orders, double *energies, lq_error *error);

#endif
