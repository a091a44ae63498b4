/* measure.h - what errors are measured against where nothing computes exact values. */
#ifndef LACQUER_PCA_MEASURE_H
#define LACQUER_PCA_MEASURE_H

#include "lacquer.h"

/* The coordinates of an entry of a table. */
void lq_node_point(const lq_table *table, size_t entry, double *x);

/* The nodes of a table inside a box, as a table. */
lq_status lq_nodes_within(const lq_table *table, const double *min, const double *max, lq_table **values,
                          lq_error *error);

/* Random nodes of every axis inside a box, denser where those of the axis are: `nodes` of alpha and eta,
 * twice as many of others; one of an axis that has one, or where the box is flat. At most 256 an axis. Free
 * each of `made`, zeroed before, in any case. */
lq_status lq_random_axes(const lq_axis *axes, int axis_count, const double *min, const double *max,
                         size_t nodes, size_t seed, lq_axis *made, lq_error *error);

#endif
