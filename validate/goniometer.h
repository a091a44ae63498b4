/* goniometer.h - a virtual goniophotometer (Ba19 sec. 4.1): rays through a stack, counted in the cells of
 * slices where they leave.
 *
 * Light is kept apart by the side it leaves on, by how often it met the first interface (as `paths` of
 * lq_stack_solve: once is what that interface reflects or lets through at once) and by colour. Colours share
 * rays where these take the same ways (lq_walk_pile_shared).
 *
 * Sums are whole numbers, so that they do not depend on the order in which threads add to them.
 */
#ifndef LACQUER_VALIDATE_GONIOMETER_H
#define LACQUER_VALIDATE_GONIOMETER_H

#include "lacquer.h"
#include "validate/slice_cells.h"

#include <stdint.h>

enum { LQ_GONIO_ORDERS = 3, LQ_GONIO_SIDES = 2 }; /* met once, twice, more often; reflected, transmitted */
#define LQ_GONIO_MAX_SAMPLES 4000000000u          /* what the sums hold */

typedef struct lq_gonio {
    double mu;
    size_t samples;
    int channels, sides, layouts; /* layouts: the first of them */
    uint64_t *sums;               /* weights and their squares; lq_gonio_slice reads them */
    uint64_t lost;                /* of rays given up */
} lq_gonio;

/* In the first `layouts` of lq_slice_layout, at the first cosine of the query, whose tolerance and paths are
 * not read. LQ_BAD_INPUT: what lq_stack_walk refuses. Free it whatever comes back. */
lq_status lq_gonio_measure(lq_gonio *gonio, const lq_stack *stack, const lq_stack_query *query, int layouts,
                           size_t samples, uint64_t seed, const lq_progress *progress, lq_error *error);
void lq_gonio_free(lq_gonio *gonio);

/* Orders `from` to `to`, added: the mean of f cos theta_o in each cell, and its standard error. Either may be
 * NULL. */
typedef struct lq_gonio_part {
    int side, from, to, channel;
} lq_gonio_part;
void lq_gonio_slice(const lq_gonio *gonio, lq_slice_layout layout, const lq_gonio_part *part,
                    const double *solid, float *value, float *noise);

/* Their energy, over all cells, and its standard error. */
double lq_gonio_energy(const lq_gonio *gonio, lq_slice_layout layout, const lq_gonio_part *part,
                       double *noise);

/* What rays that were given up carried, the brightest colour's. */
double lq_gonio_lost(const lq_gonio *gonio);

#endif
