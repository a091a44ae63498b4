/* sweep.h - a table that is solved where the sweep chooses, and then given row by row.
 *
 * A part (system/parts.h) is one value of the slice axis: the estimate of its solve, and all values of the
 * other axes. Parts that are points of a panel are kept in full, those that are nodes of the table as it has
 * them. Rows are interpolated between parts when they are asked for, so that nothing holds the table.
 */
#ifndef LACQUER_PRECOMPUTE_SWEEP_H
#define LACQUER_PRECOMPUTE_SWEEP_H

#include "lacquer.h"
#include "system/parts.h"
#include "tables/rows.h"

typedef struct lq_sweep lq_sweep;

/* All solves, kept at `place`, whose key is made here from `build`, which tells programs apart, and what is
 * asked for. LQ_NOT_CONVERGED: there is a sweep, and its facts say by how much the tolerance was missed. */
lq_status lq_sweep_solve(lq_sweep **sweep, const lq_kind *kind, const lq_settings *settings,
                         const lq_axis *axes, const lq_parts_place *place, const char *build,
                         const lq_progress *progress, lq_error *error);

/* The table without data; facts may be added. */
lq_table *lq_sweep_shape(lq_sweep *sweep);
lq_rows lq_sweep_rows(lq_sweep *sweep);

/* Rows and facts into a table of the same axes that is held. */
lq_status lq_sweep_hold(lq_sweep *sweep, lq_table *table, lq_error *error);

/* How many parts were there from a run before. */
size_t lq_sweep_found(const lq_sweep *sweep);

/* `whole`: the table is written, and its parts go. NULL is fine. */
void lq_sweep_free(lq_sweep *sweep, bool whole);

#endif
