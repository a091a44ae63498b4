/* index_cells.h - many complex indices from solves at few.
 *
 * Energies are smooth functions of n and kappa but for Fresnel's branch points, which lie where kappa = 0 and
 * n is the sine of an angle, at most 1. The grid of a table is cut into cells that end at n = 1.2 and kappa =
 * 0.5 and grow in proportion beyond. Along each axis a cell is interpolated between as many Chebyshev points
 * as the distance of the branch points asks for, or solved at its own nodes where these are fewer, and always
 * so where n < 1.2, kappa < 0.5.
 */
#ifndef LACQUER_PRECOMPUTE_INDEX_CELLS_H
#define LACQUER_PRECOMPUTE_INDEX_CELLS_H

#include "lacquer.h"
#include "precompute/series.h"

enum { LQ_INDEX_CELLS_MAX = 25 };

/* A cell along n or along kappa. */
typedef struct lq_cell_side {
    const double *nodes; /* of the table, those inside */
    size_t count, begin; /* how many, and the place of the first on its axis */
    lq_series series;    /* series.nodes is 0 where they are solved as they are */
} lq_cell_side;

typedef struct lq_index_cell {
    lq_cell_side n, kappa;
    size_t first; /* of its materials, n fastest */
} lq_index_cell;

typedef struct lq_index_cells {
    size_t n_size; /* of the table */
    int cells;
    lq_index_cell cell[LQ_INDEX_CELLS_MAX];
    size_t nodes; /* materials to solve that are nodes of the table; they come first */
    size_t count; /* all materials to solve */
    double *n, *kappa;
} lq_index_cells;

/* Is it solved at its nodes? */
bool lq_index_cell_is_direct(const lq_index_cell *cell);

/* Cells that ought to leave out no more than `accuracy`. Free them in either case. */
lq_status lq_index_cells_make(lq_index_cells *cells, const double *n, size_t n_size, const double *kappa,
                              size_t kappa_size, double accuracy, lq_error *error);
void lq_index_cells_free(lq_index_cells *cells);

/* What interpolation in one cell leaves out, of energy[material * mu_count + m]; 0 where there is none. */
double lq_index_cell_missing(const lq_index_cell *cell, const double *energy, size_t mu_count);

/* values[(kappa * n_size + n) * mu_count + m] of the table, as far as the cell covers it. */
lq_status lq_index_cell_expand(const lq_index_cells *cells, const lq_index_cell *cell, const double *energy,
                               size_t mu_count, double *values, lq_error *error);

#endif
