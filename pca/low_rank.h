/* low_rank.h - matrices as products of two thin ones, through LAPACKE and BLAS. Results do not depend on the
 * number of threads: work is cut into pieces of fixed size, and every sum has one order. */
#ifndef LACQUER_PCA_LOW_RANK_H
#define LACQUER_PCA_LOW_RANK_H

#include "lacquer.h"

/* m (rows x columns, row-major) ~ left (rows x rank) right^T (columns x rank): the best in the rms sense up
 * to what the power iteration leaves. Columns of `right` are orthonormal, in order of falling singular value,
 * the entry of largest size positive; what of the rank the matrix does not have is zero. */
lq_status lq_low_rank(const float *m, size_t rows, size_t columns, size_t rank, double *left, double *right,
                      lq_error *error);

/* Turn left (rows x rank) right^T (columns x rank) into that form without changing the product: terms that
 * cancel each other would each be rounded to half. */
lq_status lq_canonical(double *left, size_t rows, double *right, size_t columns, size_t rank,
                       lq_error *error);

#endif
