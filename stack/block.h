/* block.h - adding and doubling on operators: B18 sec. 5.1, eq. 28-31, with matrices for numbers.
 *
 * A block is what one interface, or a pile of them, does to rewards: the value of light that arrives on side
 * s (0 above, 1 below) at each of its entries is r[s] times the reward of leaving that side at its nodes,
 * plus t[s] times that of leaving the other. Matrices are row-major.
 */
#ifndef LACQUER_STACK_BLOCK_H
#define LACQUER_STACK_BLOCK_H

#include "lacquer.h"

typedef struct lq_block {
    size_t entries[2]; /* rows: cosines at which light arrives */
    size_t nodes[2];   /* columns: cosines at which it leaves */
    double *r[2];      /* entries[s] x nodes[s] */
    double *t[2];      /* entries[s] x nodes[1 - s] */
} lq_block;

/* All zero. False without memory; free it in either case. */
bool lq_block_make(lq_block *block, size_t entries_above, size_t entries_below, size_t nodes_above,
                   size_t nodes_below);
void lq_block_free(lq_block *block);

/* Rows of both sides that are kept of a block, and whether it is turned upside down first. */
typedef struct lq_block_rows {
    bool flipped;
    size_t from[2], count[2]; /* of the sides as they lie after turning */
} lq_block_rows;

/* LQ_NO_MEMORY; free `part` in either case. */
lq_status lq_block_part(const lq_block *all, const lq_block_rows *rows, lq_block *part, lq_error *error);

/* `above` over `below`, with a medium between: `crossing` holds what a crossing leaves at each node. The
 * entries of the two that face the medium are its nodes. LQ_NO_MEMORY. */
lq_status lq_block_add(const lq_block *above, const double *crossing, const lq_block *below, lq_block *sum,
                       lq_error *error);

/* *sum = *sum over *more, which may be the same; *sum is kept as it was on failure. */
lq_status lq_block_append(lq_block *sum, const double *crossing, const lq_block *more, lq_error *error);

/* On failure `to` holds nothing. */
lq_status lq_block_copy(const lq_block *from, lq_block *to, lq_error *error);

/* `count` >= 1 times the same block, which has the medium of `crossing` below every copy but the last, by
 * doubling: log2 additions. */
lq_status lq_block_repeat(const lq_block *block, const double *crossing, size_t count, lq_block *sum,
                          lq_error *error);

/* Light between two mirrors: columns of x (size x count) are replaced by the solutions y of y = m y + x. m,
 * which gains no energy, is overwritten. LQ_NO_MEMORY; LQ_NOT_CONVERGED: there is none. */
lq_status lq_block_trapped(double *m, size_t size, double *x, size_t count, lq_error *error);

/* out = D r D, D = diag(crossing): across a medium, reflected, and back. */
void lq_block_there_and_back(const double *r, const double *crossing, size_t size, double *out);

/* c = a b; a is rows x inner, b inner x columns. */
void lq_matrix_product(const double *a, const double *b, size_t rows, size_t inner, size_t columns,
                       double *c);

#endif
