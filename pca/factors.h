/* factors.h - making factored tables, and evaluating their parts; lacquer.h says what they are. */
#ifndef LACQUER_PCA_FACTORS_H
#define LACQUER_PCA_FACTORS_H

#include "lacquer.h"

/* Texels of one base. */
size_t lq_factor_texels(const lq_factor *factor);

/* The coordinate that a texture axis reads at point x of the table. */
double lq_coordinate_at(const lq_texture_axis *axis, const double *x);
const char *lq_coordinate_name(lq_coordinate coordinate);
const char *lq_value_name(lq_value value);

/* A base filtered at x: the (up to 4) texels under it and their weights. `fraction_bits` > 0 rounds the
 * position as a GPU's sampler does. */
typedef struct lq_tap {
    int count;
    size_t texel[4];
    double weight[4];
} lq_tap;
void lq_factor_tap(const lq_factor *factor, const double *x, int fraction_bits, lq_tap *tap);

/* The value transform; s has the piece's streams. */
double lq_value_apply(const lq_piece *piece, const double *s, const double *x);

/* The piece that holds x, which must lie within the axes. */
const lq_piece *lq_factored_piece(const lq_factored *factored, const double *x);

/* Take over what is in `piece` (its slots past factor_count and stream_count are ignored). */
void lq_piece_free(lq_piece *piece);

/* Zero bases over axes that are copied. */
lq_status lq_factor_create(lq_factor *factor, const lq_texture_axis *axes, int axis_count, size_t base_count,
                           lq_error *error);
lq_status lq_term_sum_create(lq_term_sum *sum, size_t term_count, const int *factors, int factor_count,
                             lq_error *error);

/* What every reader relies on: counts, indices, ranges, data exact in half and finite. */
lq_status lq_factored_check(const lq_factored *factored, lq_error *error);

#endif
