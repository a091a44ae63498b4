/* pile.h - the blocks of one chain, one mode, put together and asked what light of every path is worth. */
#ifndef LACQUER_STACK_PILE_H
#define LACQUER_STACK_PILE_H

#include "stack/block.h"
#include "stack/plan.h"

typedef struct lq_pile {
    const lq_plan_chain *chain;
    lq_block *block;                  /* of each step, in its order */
    double (*crossing)[LQ_NODES_MAX]; /* of each medium: what a crossing leaves at the nodes of its axis */
} lq_pile;

/* Blocks all empty, to be made by the caller; free it in any case. LQ_NO_MEMORY. */
lq_status lq_pile_make(lq_pile *pile, const lq_plan_chain *chain, lq_error *error);
void lq_pile_free(lq_pile *pile);

/* What light at each entry of the first step is worth, for two pairs of rewards: reward[0] and reward[1] of
 * leaving on the side it came from and beyond the last step, each two columns, [column * nodes + j], one
 * after the other. Split by the events on the first step, the last path holding the rest: values[((entry *
 * paths + path) * 2 + side) * 2 + column]. */
lq_status lq_pile_values(const lq_pile *pile, const double *reward, const double *reward_beyond, size_t paths,
                         double *values, lq_error *error);

#endif
