/* unfold.h - a table, sampled at the texels of a plane (rows) and of the axes separated from it (columns). */
#ifndef LACQUER_PCA_UNFOLD_H
#define LACQUER_PCA_UNFOLD_H

#include "lacquer.h"

/* Which axes form the plane, which are separated, and where the texels are. Every axis of the table is in one
 * of the two; `fixed` has the value of an axis of one node, which is in neither. */
typedef struct lq_grid {
    int plane_count, rest_count;
    lq_texture_axis plane[2], rest[LQ_MAX_AXES];
    double fixed[LQ_MAX_AXES];
} lq_grid;

size_t lq_grid_rows(const lq_grid *grid);
size_t lq_grid_columns(const lq_grid *grid);
void lq_grid_free(lq_grid *grid);

/* The table's point at a texel of the plane (row) and of the rest (column), first axis fastest in each. */
void lq_grid_point(const lq_grid *grid, size_t row, size_t column, double *x);

/* values[row * columns + column]: the table at its nodes, and the cubic through four of them between. */
lq_status lq_unfold(const lq_table *table, int channel, const lq_grid *grid, float **values, lq_error *error);

#endif
