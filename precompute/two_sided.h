/* What the tables of rough dielectrics ask of the two-sided solver (dielectric.h): energies of every cosine
 * and transmittance, and their cosine-weighted means, refined until they hold to a tolerance.
 *
 * Diffuse quantities are cosine-weighted means over incidence. What leaves a coating that is denser than the
 * medium above comes from the outside view by reciprocity, mu0 t01(mu0 -> mu) = mu t10(mu -> mu0) / eta^2 in
 * flux, which has no critical angle in it: T10mean(tau) = T01mean(tau) / eta^2.
 */
#ifndef LACQUER_PRECOMPUTE_TWO_SIDED_H
#define LACQUER_PRECOMPUTE_TWO_SIDED_H

#include "precompute/dielectric.h"

/* Values of one interface at one level of resolution. */
typedef lq_status lq_level_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                                  lq_error *error);

/* Raise the level until two in a row agree: the estimate is a multiple of their largest difference over
 * `count` values, and never below a tenth of the tolerance. `values` gets the finer ones. A level that does
 * not settle is left out. */
lq_status lq_refine(lq_rough *rough, double eta, double tolerance, lq_level_values *evaluate,
                    const void *asked, size_t count, double *values, double *estimate, lq_error *error);

/* The same of cosine-weighted means: those of matched media (dielectric.h) are the smooth interface's. */
lq_status lq_mean_solve(lq_rough *rough, double eta, double tolerance, lq_level_values *evaluate,
                        const void *asked, size_t count, double *values, double *estimate, lq_error *error);

/* Cosines and transmittances of a table, and what is asked of each. */
typedef struct lq_directional {
    lq_scattering scattering;
    int reward_side;
    const double *mu;
    size_t mu_count;
    const double *tau;
    size_t tau_count;
} lq_directional;

/* One interface: values[t * mu_count + m] and their estimate. */
lq_status lq_directional_solve(lq_rough *rough, double eta, double tolerance, const lq_directional *asked,
                               double *values, double *estimate, lq_error *error);

enum { LQ_MEAN_MAX = 512 };

/* A quadrature of 2 mu dmu on [0,1]: energies turn over cosines of alpha at grazing, and at the critical
 * cosine of light that comes from the denser side. */
typedef struct lq_mean_rule {
    size_t count;
    double mu[LQ_MEAN_MAX], weight[LQ_MEAN_MAX];
} lq_mean_rule;

void lq_mean_make(lq_mean_rule *mean, double alpha, double index, int level);

/* What the means of one interface are asked for: T10mean of every tau, R10mean, or both in this order. */
typedef struct lq_diffuse {
    const double *tau;
    size_t tau_count;
    bool transmitted, reflected;
} lq_diffuse;

/* An lq_level_values of an lq_diffuse. */
lq_status lq_diffuse_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                            lq_error *error);

/* Energies are asked for at every tau of a table, or, where these are many, at Chebyshev points of sqrt(tau),
 * both ends included, and interpolated: they are Laplace transforms in -ln tau, smooth in between. */
enum { LQ_TAUS_MAX = 32 };

typedef struct lq_tau_nodes {
    size_t count;
    bool direct; /* they are the table's own */
    double tau[LQ_TAUS_MAX + 1];
} lq_tau_nodes;

lq_tau_nodes lq_tau_nodes_choose(const double *tau, size_t count, int level);

/* Barycentric weights of the interpolation to tau, number `index` of the table: sum_k weight[k] value_k. */
void lq_tau_weights(const lq_tau_nodes *nodes, size_t index, double tau, double *weight);

#endif
