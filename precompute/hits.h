/* Light between its hits on a microsurface: the fixed point of travel and meeting facets (dielectric.h).
 *
 * E_s(u, omega) is what a ray of side s at depth u that travels in omega is worth in the end, C_s(u, omega)
 * the same just before it meets a facet. E follows from C by travel, C from E by the rows of the facet
 * operator; the pair is iterated for eight rewards at a time.
 */
#ifndef LACQUER_PRECOMPUTE_HITS_H
#define LACQUER_PRECOMPUTE_HITS_H

#include "precompute/kernels.h"
#include "precompute/rough_level.h"

/* The facet operators of falling and rising rays: rows of 4 nodes, the directions light may be sent to: own
 * side rising, own side falling, other side rising, other side falling. A surface that lets nothing through
 * has one side, and its rows end with zeros. */
typedef struct lq_hits {
    const lq_rough_level *level;
    int sides;
    const double *fall[2], *rise[2];
} lq_hits;

/* One batch of rewards, a lane each. */
typedef struct lq_hits_values {
    lq_v8 *reward;    /* [side * nodes + j], of the rising nodes */
    lq_v8 *source;    /* NULL, or like `before`: what is added to C at every hit */
    lq_v8 *value[2];  /* E: [depth * 2 nodes + (rising, falling)] */
    lq_v8 *before[2]; /* C: likewise, one side after the other */
} lq_hits_values;

/* False without memory. */
bool lq_hits_values_make(lq_hits_values *x, const lq_rough_level *level);
void lq_hits_values_free(lq_hits_values *x);

/* E and C of the rewards in `x`. `settled`: what the passes that are not made may add up to. False where the
 * iteration does not settle: rays that graze a fine level meet hundreds of facets, and its interpolation can
 * overshoot by enough to matter then. A coarser level holds. */
bool lq_hits_solve(const lq_hits *hits, lq_hits_values *x, double settled);

/* The same where only the first `lanes` lanes hold a reward, and there is no source: few of them are solved
 * one by one, with eight depths in the place of eight rewards. */
bool lq_hits_solve_lanes(const lq_hits *hits, lq_hits_values *x, size_t lanes, double settled);

#endif
