/* along.h - a roughness axis of a table solved at fewer values than it has nodes.
 *
 * What a stack does is smooth in the logarithm of a roughness. Nodes in (1/64, 1/16], (1/16, 1/4] and (1/4,
 * 1] are interpolated between Chebyshev points of each range, where these are fewer; the series says whether
 * they do.
 */
#ifndef LACQUER_STACK_ALONG_H
#define LACQUER_STACK_ALONG_H

#include "precompute/series.h"

#include <stdbool.h>

enum { LQ_ALONG_PANELS = 3, LQ_ALONG_POINTS = 11 /* of the largest panel */ };

typedef struct lq_along {
    const double *nodes; /* of the table's axis */
    size_t size;
    size_t count;  /* values that are solved; at most size + LQ_ALONG_PANELS * LQ_ALONG_POINTS */
    double *value; /* they themselves: first those of the panels, then nodes solved as they are */
    bool panel_used[LQ_ALONG_PANELS];
    lq_series panel[LQ_ALONG_PANELS]; /* over ln alpha */
    size_t first[LQ_ALONG_PANELS];    /* of its points in `value` */
    size_t *direct;                   /* of each node: its place in `value`, where no panel has it */
} lq_along;

/* `interpolate` false: every node is solved. False without memory; free it in either case. */
bool lq_along_make(lq_along *along, const double *nodes, size_t size, bool interpolate);
void lq_along_free(lq_along *along);

/* Solve the nodes of a panel one by one after all: they are appended to `value`. */
void lq_along_drop(lq_along *along, int panel);

/* Of one node: how many solved values it is made of, the first of them, and their weights. */
size_t lq_along_weights(const lq_along *along, size_t node, size_t *first, double weight[LQ_ALONG_POINTS]);

#endif
