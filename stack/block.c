/* block.c - star products of blocks. */
#include "stack/block.h"

#include <lapacke.h>
#include <stdlib.h>
#include <string.h>

#include "system/status.h"

static lq_status no_memory(lq_error *error) {
    return lq_fail(error, LQ_NO_MEMORY, "no memory to put layers together");
}

bool lq_block_make(lq_block *b, size_t entries_above, size_t entries_below, size_t nodes_above,
                   size_t nodes_below) {
    *b = (lq_block){{entries_above, entries_below}, {nodes_above, nodes_below}, {NULL, NULL}, {NULL, NULL}};
    bool ok = true;
    for (int s = 0; s < 2; s++) {
        ok &= (b->r[s] = calloc(b->entries[s] * b->nodes[s] + 1, sizeof(double))) != NULL;
        ok &= (b->t[s] = calloc(b->entries[s] * b->nodes[1 - s] + 1, sizeof(double))) != NULL;
    }
    return ok;
}

void lq_block_free(lq_block *b) {
    for (int s = 0; s < 2; s++) {
        free(b->r[s]);
        free(b->t[s]);
        b->r[s] = b->t[s] = NULL;
    }
}

lq_status lq_block_part(const lq_block *all, const lq_block_rows *rows, lq_block *part, lq_error *error) {
    const int top = rows->flipped ? 1 : 0;
    if (!lq_block_make(part, rows->count[0], rows->count[1], all->nodes[top], all->nodes[1 - top]))
        return no_memory(error);
    for (int s = 0; s < 2; s++) {
        const int side = s == 0 ? top : 1 - top;
        const size_t own = all->nodes[side], other = all->nodes[1 - side];
        memcpy(part->r[s], all->r[side] + rows->from[s] * own, rows->count[s] * own * sizeof(double));
        memcpy(part->t[s], all->t[side] + rows->from[s] * other, rows->count[s] * other * sizeof(double));
    }
    return LQ_OK;
}

void lq_matrix_product(const double *a, const double *b, size_t rows, size_t inner, size_t columns,
                       double *c) {
    memset(c, 0, rows * columns * sizeof *c);
    for (size_t i = 0; i < rows; i++)
        for (size_t k = 0; k < inner; k++) {
            const double factor = a[i * inner + k];
            const double *from = b + k * columns;
            double *to = c + i * columns;
            for (size_t j = 0; j < columns; j++) to[j] += factor * from[j];
        }
}

/* Light that total reflection traps between lossless smooth interfaces stays for ever, and nothing lets it
 * in: its equation is 0 x = 0. So little loss at a bounce makes that 0. */
static const double TRAP_LOSS = 1e-15;

lq_status lq_block_trapped(double *m, size_t size, double *x, size_t count, lq_error *error) {
    lapack_int *pivots = malloc((size + 1) * sizeof *pivots);
    if (!pivots) return no_memory(error);
    for (size_t i = 0; i < size * size; i++) m[i] *= TRAP_LOSS - 1.0;
    for (size_t i = 0; i < size; i++) m[i * size + i] += 1.0;
    const lapack_int n = (lapack_int)size, columns = (lapack_int)count;
    const lapack_int info =
        LAPACKE_dgesv(LAPACK_ROW_MAJOR, n, columns, m, n > 0 ? n : 1, pivots, x, columns > 0 ? columns : 1);
    free(pivots);
    if (info < 0) return no_memory(error);
    return info > 0 ? lq_fail(error, LQ_NOT_CONVERGED, "light between two layers does not come to rest")
                    : LQ_OK;
}

void lq_block_there_and_back(const double *r, const double *crossing, size_t size, double *out) {
    for (size_t i = 0; i < size; i++)
        for (size_t j = 0; j < size; j++) out[i * size + j] = crossing[i] * r[i * size + j] * crossing[j];
}

/* What light at the nodes of the medium is worth that sets out towards block `to` (and then meets `from` and
 * `to` in turn): columns are the nodes of the side of `from` beyond, then those of `to` beyond. Both face the
 * medium with sides f and 1 - f. */
static lq_status held(const lq_block *from, int f, const lq_block *to, const double *crossing, double **value,
                      lq_error *error) {
    const size_t n = from->nodes[f], back = from->nodes[1 - f], on = to->nodes[f], wide = back + on;
    double *memory = malloc((2 * n * n + n * back + n * wide + 1) * sizeof *memory);
    *value = NULL;
    if (!memory) return no_memory(error);
    double *there = memory, *m = there + n * n, *out = m + n * n, *x = out + n * back;
    /* Down to `to`, reflected, up to `from`: what waits there, reflected again or let through. */
    lq_block_there_and_back(to->r[1 - f], crossing, n, there);
    lq_matrix_product(there, from->r[f], n, n, n, m);
    lq_matrix_product(there, from->t[f], n, n, back, out);
    for (size_t i = 0; i < n; i++) {
        memcpy(x + i * wide, out + i * back, back * sizeof *x);
        for (size_t j = 0; j < on; j++) x[i * wide + back + j] = crossing[i] * to->t[1 - f][i * on + j];
    }
    const lq_status status = lq_block_trapped(m, n, x, wide, error);
    if (status == LQ_OK) memmove(memory, x, n * wide * sizeof *x);
    if (status == LQ_OK) *value = memory;
    else free(memory);
    return status;
}

/* The half of the sum that light on side s of it enters by. */
static lq_status add_half(const lq_block *near, int s, const lq_block *far, const double *crossing,
                          lq_block *sum, lq_error *error) {
    const size_t rows = near->entries[s], n = near->nodes[1 - s], back = near->nodes[s],
                 on = far->nodes[1 - s];
    double *value = NULL;
    if (rows == 0) return LQ_OK;
    const lq_status status = held(near, 1 - s, far, crossing, &value, error);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < rows; i++) {
        memcpy(sum->r[s] + i * back, near->r[s] + i * back, back * sizeof(double));
        for (size_t k = 0; k < n; k++) {
            const double enters = near->t[s][i * n + k], *row = value + k * (back + on);
            for (size_t j = 0; j < back; j++) sum->r[s][i * back + j] += enters * row[j];
            for (size_t j = 0; j < on; j++) sum->t[s][i * on + j] += enters * row[back + j];
        }
    }
    free(value);
    return LQ_OK;
}

lq_status lq_block_add(const lq_block *above, const double *crossing, const lq_block *below, lq_block *sum,
                       lq_error *error) {
    lq_status status =
        lq_block_make(sum, above->entries[0], below->entries[1], above->nodes[0], below->nodes[1])
            ? add_half(above, 0, below, crossing, sum, error)
            : no_memory(error);
    if (status == LQ_OK) status = add_half(below, 1, above, crossing, sum, error);
    if (status != LQ_OK) lq_block_free(sum);
    return status;
}

lq_status lq_block_copy(const lq_block *from, lq_block *to, lq_error *error) {
    const lq_block_rows all = {.count = {from->entries[0], from->entries[1]}};
    const lq_status status = lq_block_part(from, &all, to, error);
    if (status != LQ_OK) lq_block_free(to);
    return status;
}

lq_status lq_block_append(lq_block *sum, const double *crossing, const lq_block *more, lq_error *error) {
    lq_block added;
    const lq_status status = lq_block_add(sum, crossing, more, &added, error);
    if (status != LQ_OK) return status;
    lq_block_free(sum);
    *sum = added;
    return LQ_OK;
}

lq_status lq_block_repeat(const lq_block *block, const double *crossing, size_t count, lq_block *sum,
                          lq_error *error) {
    lq_block power;
    bool started = count & 1;
    lq_status status = lq_block_copy(block, &power, error);
    if (status != LQ_OK) return status;
    if (started) status = lq_block_copy(block, sum, error);
    started &= status == LQ_OK;
    for (size_t left = count >> 1; left > 0 && status == LQ_OK; left >>= 1) {
        status = lq_block_append(&power, crossing, &power, error);
        if (status != LQ_OK || !(left & 1)) continue;
        if (started) status = lq_block_append(sum, crossing, &power, error);
        else status = lq_block_copy(&power, sum, error);
        started |= status == LQ_OK;
    }
    lq_block_free(&power);
    if (status != LQ_OK && started) lq_block_free(sum);
    return status;
}
