/* sequential.c - iterated PCA (D22 sec. 4): the table is unfolded along the first axis to be separated and
 * cut to its leading singular vectors; each of their coefficients, a table of one axis less, is treated the
 * same way, until the plane is left. Nothing is subtracted first: a mean would be one more base.
 */
#include "pca/sequential.h"

#include <stdlib.h>
#include <string.h>

#include "pca/low_rank.h"
#include "system/status.h"

void lq_chain_free(lq_chain *chain) {
    for (size_t i = 0; i <= chain->levels; i++) free(chain->data[i]);
    memset(chain, 0, sizeof *chain);
}

static lq_status make_chain(const lq_grid *grid, const lq_pca_options *options, lq_chain *chain,
                            lq_error *error) {
    size_t bases = 1, axis = 0;
    *chain = (lq_chain){.levels = (size_t)options->separation_count};
    for (size_t i = 0; i <= chain->levels; i++) {
        chain->texels[i] = i < chain->levels ? 1 : lq_grid_rows(grid);
        if (i < chain->levels) {
            for (int a = 0; a < options->separations[i].axis_count; a++)
                chain->texels[i] *= grid->rest[axis++].texels.size;
            bases *= options->separations[i].bases;
        }
        chain->bases[i] = bases;
        chain->data[i] = calloc(bases * chain->texels[i], sizeof *chain->data[i]);
        if (!chain->data[i]) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu bases", bases);
    }
    return LQ_OK;
}

/* Level `level` of the branch whose base there is `branch`: samples is rows x (what is left to separate),
 * the axis of this level fastest, so that its unfolding is the samples as they lie. */
static lq_status separate(lq_chain *chain, size_t level, size_t branch, const float *samples, size_t rows,
                          size_t columns, lq_error *error) {
    if (level == chain->levels) {
        for (size_t i = 0; i < rows; i++) chain->data[level][branch * rows + i] = (double)samples[i];
        return LQ_OK;
    }
    const size_t size = chain->texels[level], later = columns / size;
    const size_t count = chain->bases[level] / (level > 0 ? chain->bases[level - 1] : 1);
    double *left = malloc(rows * later * count * sizeof *left), *right = malloc(size * count * sizeof *right);
    float *next = malloc(rows * later * sizeof *next);
    lq_status status = left && right && next
                           ? LQ_OK
                           : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu samples", rows * columns);
    if (status == LQ_OK) status = lq_low_rank(samples, rows * later, size, count, left, right, error);
    for (size_t k = 0; status == LQ_OK && k < count; k++) {
        const size_t base = branch * count + k;
        for (size_t i = 0; i < size; i++) chain->data[level][base * size + i] = right[i * count + k];
        for (size_t i = 0; i < rows * later; i++) next[i] = (float)left[i * count + k];
        status = separate(chain, level + 1, base, next, rows, later, error);
    }
    free(left);
    free(right);
    free(next);
    return status;
}

lq_status lq_sequential(const float *samples, const lq_grid *grid, const lq_pca_options *options,
                        lq_chain *chain, lq_error *error) {
    lq_status status = make_chain(grid, options, chain, error);
    if (status == LQ_OK)
        status = separate(chain, 0, 0, samples, lq_grid_rows(grid), lq_grid_columns(grid), error);
    if (status != LQ_OK) lq_chain_free(chain);
    return status;
}
