/* measure.c - errors of a factored table, as a GPU evaluates it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "pca/measure.h"
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

lq_status lq_nodes_within(const lq_table *table, const double *min, const double *max, lq_table **values,
                          lq_error *error) {
    lq_axis axes[LQ_MAX_AXES] = {0};
    const char *names[LQ_MAX_CHANNELS];
    lq_status status = LQ_OK;
    for (int a = 0; a < table->axis_count && status == LQ_OK; a++) {
        size_t first = 0, count = 0;
        for (size_t i = 0; i < table->axes[a].size; i++)
            if (table->axes[a].nodes[i] >= min[a] && table->axes[a].nodes[i] <= max[a] && count++ == 0)
                first = i;
        status = count > 0 ? lq_axis_make_custom(&axes[a], table->axes[a].name, table->axes[a].nodes + first,
                                                 count, error)
                           : lq_fail(error, LQ_BAD_INPUT, "no node of %s in [%g, %g]", table->axes[a].name,
                                     min[a], max[a]);
    }
    for (int c = 0; c < table->channel_count; c++) names[c] = table->channel_names[c];
    if (status == LQ_OK)
        status = lq_table_create(values, axes, table->axis_count, names, table->channel_count, error);
    const size_t entries = status == LQ_OK ? lq_table_entries(*values) : 0;
    for (size_t i = 0; i < entries; i++) {
        double x[LQ_MAX_AXES];
        for (size_t a = 0, rest = i; a < (size_t)table->axis_count; rest /= axes[a].size, a++)
            x[a] = axes[a].nodes[rest % axes[a].size];
        for (int c = 0; c < table->channel_count; c++)
            (*values)->channels[c][i] = (float)lq_table_lookup(table, c, x);
    }
    for (int a = 0; a < table->axis_count; a++) lq_axis_free(&axes[a]);
    return status;
}
