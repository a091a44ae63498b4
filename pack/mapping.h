/* mapping.h - the mappings of roughness and phase functions (B18) as tables of one axis. */
#ifndef LACQUER_PACK_MAPPING_H
#define LACQUER_PACK_MAPPING_H

#include "fit/curve.h"
#include "lacquer.h"

/* "f", "f-inverse", "sigma-g", described as a kind of table is; NULL and what there is otherwise. */
const lq_kind *lq_mapping_find(const char *id, lq_error *error);
/* Whether a kind is one of these, which lq_precompute does not know. Their errors are relative. */
bool lq_is_mapping(const lq_kind *kind);

/* One value, from the curve of the NDF. */
double lq_mapping_value(const lq_kind *kind, const lq_curve *curve, double x);

/* Its values at the nodes of the axis. */
lq_status lq_mapping_table(const lq_kind *kind, const lq_settings *settings, const lq_axis *axis,
                           lq_table **table, lq_error *error);

/* The same at `points` nodes that are spread like those of the axis and, but for its ends, lie between them.
 */
lq_status lq_mapping_exact(const lq_kind *kind, const lq_settings *settings, const lq_axis *axis,
                           size_t points, lq_table **table, lq_error *error);
/* Its axis. Free it. */
lq_status lq_mapping_exact_axis(const lq_axis *axis, size_t points, lq_axis *finer, lq_error *error);

#endif
