/* measure.c - errors of a factored table, as a GPU evaluates it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "tables/status.h"

static void node_point(const lq_table *table, size_t entry, double *x) {
    for (int a = 0; a < table->axis_count; a++) {
        x[a] = table->axes[a].nodes[entry % table->axes[a].size];
        entry /= table->axes[a].size;
    }
}

static int by_size(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Sorts `sizes`. */
static void summarise(const lq_table *exact, float *sizes, lq_pca_errors *errors) {
    size_t worst = 0;
    double squares = 0.0;
    for (size_t i = 0; i < errors->points; i++) {
        squares += (double)sizes[i] * (double)sizes[i];
        if (sizes[i] > sizes[worst]) worst = i;
    }
    node_point(exact, worst, errors->worst);
    errors->max = (double)sizes[worst];
    errors->rms = sqrt(squares / (double)errors->points);
    qsort(sizes, errors->points, sizeof *sizes, by_size);
    errors->p99 = (double)sizes[(size_t)ceil(0.99 * (double)errors->points) - 1];
}

lq_status lq_factored_errors(const lq_factored *factored, const lq_table *exact, int channel,
                             lq_pca_errors *errors, lq_error *error) {
    *errors = (lq_pca_errors){.points = lq_table_entries(exact)};
    if (exact->axis_count != factored->axis_count)
        return lq_fail(error, LQ_BAD_INPUT, "factors of %d axes against a table of %d", factored->axis_count,
                       exact->axis_count);
    for (int a = 0; a < exact->axis_count; a++)
        if (strcmp(exact->axes[a].name, factored->axes[a].name) != 0)
            return lq_fail(error, LQ_BAD_INPUT, "axis %d of the factors is %s, that of the table %s", a + 1,
                           factored->axes[a].name, exact->axes[a].name);
    float *sizes = malloc(errors->points * sizeof *sizes);
    if (!sizes) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu errors", errors->points);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < errors->points; i++) {
        double x[LQ_MAX_AXES];
        node_point(exact, i, x);
        sizes[i] = (float)fabs(lq_factored_lookup_gpu(factored, x) - (double)exact->channels[channel][i]);
    }
    summarise(exact, sizes, errors);
    free(sizes);
    return LQ_OK;
}
