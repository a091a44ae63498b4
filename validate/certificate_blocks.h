/* Points anywhere between the nodes, in blocks that share the work of the exact solver.
 *
 * One solve at one roughness (and, for a dielectric, one index) answers every value of the other axes. A
 * block is such a solve with a few values along each other axis: their product. Every point is uniform over
 * the domain; the points of a block are not independent of each other, blocks are, but for strata: along an
 * axis that costs a solve, each of N blocks has its own N-th of the domain (a Latin hypercube, McKay et al.
 * 1979).
 */
#ifndef LACQUER_VALIDATE_CERTIFICATE_BLOCKS_H
#define LACQUER_VALIDATE_CERTIFICATE_BLOCKS_H

#include "fit/curve.h"
#include "lacquer.h"

#include <stdint.h>

enum { LQ_BLOCK_AXIS_MAX = 2048 };

/* A part of the space of a table: both ends included. */
typedef struct lq_domain {
    double min[LQ_MAX_AXES], max[LQ_MAX_AXES];
} lq_domain;

typedef struct lq_block_plan {
    const lq_kind *kind;
    lq_domain domain;
    uint64_t seed;
    bool solves[LQ_MAX_AXES]; /* every value along this axis costs a solve */
    int sweep_axis;           /* where thousands of values cost a dozen solves, but few one each; -1: none */
    size_t size[LQ_MAX_AXES]; /* of a block; 1 where a value costs a solve */
    size_t count, per_block;  /* blocks, points of each */
    size_t *stratum[LQ_MAX_AXES]; /* of block b along an axis that costs a solve */
} lq_block_plan;

/* At least `points` in all. */
lq_status lq_block_plan_make(lq_block_plan *plan, const lq_kind *kind, const lq_domain *domain, size_t points,
                             uint64_t seed, lq_error *error);
void lq_block_plan_free(lq_block_plan *plan);

/* Coordinates along each axis, ascending. The points of a block are their product, first axis fastest. */
typedef struct lq_block {
    size_t size[LQ_MAX_AXES];
    double nodes[LQ_MAX_AXES][LQ_BLOCK_AXIS_MAX];
} lq_block;

void lq_block_draw(const lq_block_plan *plan, size_t index, lq_block *block);
size_t lq_block_points(const lq_block *block, int axis_count);
void lq_block_point(const lq_block *block, int axis_count, size_t i, double *point);

/* values[channel * points + i]. The slice axis of the kind must have one value. A tolerance that is not
 * reached shows in *estimate only. `curve`: of a mapping. */
lq_status lq_block_exact(const lq_kind *kind, const lq_settings *settings, const lq_curve *curve,
                         const lq_block *block, double *values, double *estimate, lq_error *error);

/* The same at one point. */
lq_status lq_point_exact(const lq_kind *kind, const lq_settings *settings, const lq_curve *curve,
                         const double *point, double *values, double *estimate, lq_error *error);

/* The axis along which one value costs a solve; -1: none does. */
int lq_block_slice_axis(const lq_kind *kind);

#endif
