/* piece.h - one box of a table into factors. */
#ifndef LQ_PCA_PIECE_H
#define LQ_PCA_PIECE_H

#include "pca/unfold.h"

/* The texels of a piece whose box is set: plane and rest of `options`. */
lq_status lq_piece_grid(const lq_table *table, const lq_pca_options *options, const lq_piece *piece,
                        lq_grid *grid, lq_error *error);

/* Factors of samples on that grid into the piece. */
lq_status lq_piece_fit(const float *samples, const lq_grid *grid, const lq_pca_options *options,
                       const lq_progress *progress, lq_piece *piece, lq_error *error);

/* What can be asked of a table. */
lq_status lq_pca_check(const lq_table *table, int channel, const lq_pca_options *options, lq_error *error);

/* An empty factored table over the table's axes, with its facts. */
lq_status lq_factored_start(const lq_table *table, int channel, lq_factored **factored, lq_error *error);

#endif
