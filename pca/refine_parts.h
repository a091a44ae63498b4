/* refine_parts.h - the small systems of refine.c. */
#ifndef LACQUER_PCA_REFINE_PARTS_H
#define LACQUER_PCA_REFINE_PARTS_H

#include "pca/refine.h"

/* step <- normal^-1 step for a packed symmetric n x n matrix; `full` has room for n x n. False: nothing to
 * solve, or no solution. */
bool lq_normal_solve(const float *packed, size_t n, double *full, double *step);

/* Move q (or its lines) by the solution of its normal equations, of which each column has one. `right` is
 * changed. */
lq_status lq_columns_step(lq_stream *stream, const float *matrices, float *right, lq_error *error);

/* The lines nearest to what q is, and q from them. */
lq_status lq_lines_start(lq_stream *stream, lq_error *error);
void lq_lines_multiply(lq_stream *stream);

#endif
