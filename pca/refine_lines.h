/* refine_lines.h - the separated side of a stream: free columns, or sums of products of two lines. */
#ifndef LACQUER_PCA_REFINE_LINES_H
#define LACQUER_PCA_REFINE_LINES_H

#include "pca/stream.h"

/* Move q (or its lines) by the solution of its normal equations, of which each column has one. `right` is
 * changed. */
lq_status lq_columns_step(lq_stream *stream, const float *matrices, float *right, lq_error *error);

/* The lines nearest to what q is, and q from them. */
lq_status lq_lines_start(lq_stream *stream, lq_error *error);
void lq_lines_multiply(lq_stream *stream);

#endif
