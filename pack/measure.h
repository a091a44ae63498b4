/* measure.h - how far a texture is from the exact integral, off its grid and as a GPU reads it. */
#ifndef LACQUER_PACK_MEASURE_H
#define LACQUER_PACK_MEASURE_H

#include "pack/texture.h"

/* Below this mu, alpha and tau no error is asked for. */
#define LQ_MEASURE_FROM 0.02

enum { LQ_FILTER_BITS = 8 }; /* fraction bits of the filter weights of GPUs */

typedef struct lq_measure {
    size_t points;
    bool relative;             /* of the errors, which otherwise are absolute */
    double rms, p99, max;      /* over points and channels */
    double worst[LQ_MAX_AXES]; /* the point of max */
} lq_measure;

/* Point i of a sequence that fills the box of the axes evenly and follows no grid: one number a table axis.
 */
void lq_measure_point(const lq_axis *axes, int axis_count, size_t i, double *point);

/* The exact values at `count` such points, as a table over axis "point". */
lq_status lq_measure_exact(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                           size_t count, const lq_progress *progress, lq_table **exact, lq_error *error);

lq_status lq_measure_texture(const lq_texture *texture, const lq_axis *axes, int axis_count,
                             const lq_table *exact, bool relative, lq_measure *measured, lq_error *error);

/* For factors and for tables whose solves are slow: the exact values at random nodes of the axes, stratified
 * and denser where theirs are, from LQ_MEASURE_FROM up: the cube root of `points` of alpha and eta, twice as
 * many of other axes, which a solve serves. */
lq_status lq_measure_exact_grid(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                                size_t points, size_t seed, const lq_progress *progress, lq_table **exact,
                                lq_error *error);

/* The axes of either table, from none of its values: how a stored one is recognised. Free each. */
lq_status lq_measure_axis(size_t count, lq_axis *axis, lq_error *error);
lq_status lq_measure_grid_axes(const lq_axis *axes, int axis_count, size_t points, size_t seed,
                               lq_axis *nodes, lq_error *error);

lq_status lq_measure_factored(const lq_factored *factored, int channel, const lq_table *exact, bool relative,
                              lq_measure *measured, lq_error *error);

#endif
