/* along.h - a roughness axis solved at fewer values than it has nodes.
 *
 * Energies are smooth functions of x = ln alpha: masking, lobes and critical angles turn over cosines and
 * angles of alpha, so that their nearest singularities, at alpha = i tan, lie pi / 2 off the real x axis. A
 * panel is a run of nodes that is interpolated between Chebyshev points of x; the series says whether these
 * suffice.
 */
#ifndef LACQUER_PRECOMPUTE_ALONG_H
#define LACQUER_PRECOMPUTE_ALONG_H

#include "precompute/series.h"

#include <stdbool.h>

enum { LQ_ALONG_PANELS = 3, LQ_ALONG_POINTS = LQ_SERIES_MAX };

typedef struct lq_along_panel {
    bool used;
    size_t begin, end; /* the nodes it covers */
    lq_series series;  /* over ln alpha */
    size_t first;      /* of its points in `value` */
} lq_along_panel;

typedef struct lq_along {
    const double *nodes; /* of the table's axis */
    size_t size;
    size_t count;  /* values that are solved; never more than `most` */
    size_t most;   /* however often panels are refined and dropped */
    double *value; /* they themselves: first those of the panels, then nodes solved as they are */
    size_t *same;  /* of each value: the one before it that it repeats, or its own place */
    size_t *node;  /* of each value: the node that it is, or `size` where it is a point of a panel */
    lq_along_panel panel[LQ_ALONG_PANELS];
    size_t *direct; /* of each node: its place in `value`, where no panel has it */
} lq_along;

/* Nodes in (1/64, 1/16], (1/16, 1/4] and (1/4, 1] between 8, 10 and 11 points of each, where these are fewer;
 * `interpolate` false: every node is solved. False without memory; free it in either case. */
bool lq_along_make(lq_along *along, const double *nodes, size_t size, bool interpolate);

/* The nodes from some first one on, which makes the values fewest, between as many points as ought to leave
 * out no more than `accuracy`. */
bool lq_along_plan(lq_along *along, const double *nodes, size_t size, double accuracy);

void lq_along_free(lq_along *along);

/* A panel did not do. Give it twice as many points, half of which repeat what is solved, or where that does
 * not pay solve its nodes one by one. New values are appended. */
void lq_along_refine(lq_along *along, int panel);
void lq_along_drop(lq_along *along, int panel);

/* Of one node: how many solved values it is made of, the first of them, and their weights. */
size_t lq_along_weights(const lq_along *along, size_t node, size_t *first, double weight[LQ_ALONG_POINTS]);

#endif
