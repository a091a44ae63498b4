/* piece.h - one box of a table into factors. */
#ifndef LACQUER_PCA_PIECE_H
#define LACQUER_PCA_PIECE_H

#include "pca/unfold.h"

/* The box of piece p of those that `options` cuts a table into. */
void lq_piece_box(const lq_table *table, const lq_pca_options *options, int p, lq_piece *piece);

/* The texels of a piece whose box is set: plane and rest of `options`. */
lq_status lq_piece_grid(const lq_table *table, const lq_pca_options *options, const lq_piece *piece,
                        lq_grid *grid, lq_error *error);

/* Fit the factors of a piece whose box is set. */
lq_status lq_piece_make(const lq_table *table, int channel, const lq_pca_options *options,
                        const lq_progress *progress, lq_piece *piece, lq_error *error);

/* Whether a table of these axes can be factored so: its values are not looked at. Of a search: its splits. */
lq_status lq_pca_check_options(const lq_table *table, const lq_pca_options *options, lq_error *error);
lq_status lq_pca_check_splits(const lq_table *table, const lq_pca_options *options, lq_error *error);

/* The channel and its values. */
lq_status lq_pca_check_table(const lq_table *table, int channel, lq_error *error);

/* `given`, of this version of the header or an older one, as options of this one. */
lq_status lq_pca_options_read(lq_pca_options *options, const lq_pca_options *given, lq_error *error);

/* The number of the first bases of the joint scheme that `options` asks for. */
size_t lq_separated_bases(const lq_pca_options *options);

/* An empty factored table over the table's axes, with its facts. */
lq_status lq_factored_start(const lq_table *table, int channel, lq_factored **factored, lq_error *error);

#endif
