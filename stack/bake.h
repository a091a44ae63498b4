/* bake.h - materials over the ranges they leave open, from few solves.
 *
 * Along a range, Chebyshev points (in ln(alpha + 0.02) of a roughness) are halved until what the coarser ones
 * predicted at the new ones is right; the finer ones are kept, whose error is far smaller. Solves are of the
 * coarsest level of resolution: what a pack claims is measured against exact ones.
 */
#ifndef LACQUER_STACK_BAKE_H
#define LACQUER_STACK_BAKE_H

#include "precompute/series.h"
#include "stack/material.h"

typedef struct lq_baked {
    const lq_material *material;
    size_t mu_count;
    lq_series nodes[LQ_MATERIAL_RANGES]; /* over the range, or ln(alpha + 0.02); 1 node: no such range */
    double *numbers; /* [((node 1 * nodes 0 + node 0) * mu_count + m) * LQ_MATERIAL_NUMBERS + k] */
    double error;    /* the largest that a coarser set of nodes made at those added last */
} lq_baked;

/* All at the same cosines; to a tenth of `tolerance` as a rule. LQ_NOT_CONVERGED: some `error` is above it,
 * and all are there. Free each of them in any case. */
lq_status lq_bake(const lq_material *const *materials, size_t count, const double *mu, size_t mu_count,
                  double tolerance, int threads, const lq_progress *progress, lq_baked *baked,
                  lq_error *error);
void lq_baked_free(lq_baked *baked);

/* numbers[m * LQ_MATERIAL_NUMBERS + k] at one set of values within the ranges. */
void lq_baked_at(const lq_baked *baked, const double *values, double *numbers);

#endif
