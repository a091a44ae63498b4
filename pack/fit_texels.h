/* fit_texels.h - texels whose linear interpolation is nearest to a function, between the nodes as well.
 *
 * A texel that holds the value of its node makes a filtered texture err to one side wherever the function
 * bends. The best texels share the error between nodes and the middle of cells.
 */
#ifndef LACQUER_PACK_FIT_TEXELS_H
#define LACQUER_PACK_FIT_TEXELS_H

#include "lacquer.h"

/* Axes on which a table is to be sampled for a fit: three parts of every cell, the ends included. Free each.
 */
lq_status lq_fit_axes(const lq_axis *axes, int axis_count, lq_axis *finer, lq_error *error);

/* Replace the values of `table`, at its nodes, by the least-squares fit to `samples`, the exact values on
 * lq_fit_axes of its axes. Where mu or alpha is below `from`, no error is promised and a sample weighs a
 * hundredth. `moved` gets the largest change of a value. */
lq_status lq_fit_texels(lq_table *table, const lq_table *samples, double from, double *moved,
                        lq_error *error);

#endif
