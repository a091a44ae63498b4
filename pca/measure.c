/* measure.c - errors of a factored table, as a GPU evaluates it. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "pca/measure.h"
#include "system/status.h"

void lq_node_point(const lq_table *table, size_t entry, double *x) {
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
    lq_node_point(exact, worst, errors->worst);
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
        lq_node_point(exact, i, x);
        sizes[i] = (float)fabs(lq_factored_lookup_gpu(factored, x) - (double)exact->channels[channel][i]);
    }
    summarise(exact, sizes, errors);
    free(sizes);
    return LQ_OK;
}

/* In [0,1), the same for the same seed, axis and place: splitmix64 (Steele et al. 2014). */
static double uniform(uint64_t seed, uint64_t axis, uint64_t i) {
    uint64_t z = (seed * 64 + axis) * 0x100000001b3u + i * 0x9e3779b97f4a7c15u + 0x243f6a8885a308d3u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* Random nodes, one in each of `count` equal parts of the index of the axis inside the box: where its nodes
 * are dense there are more, as many as there is to get wrong. */
static lq_status random_axis(const lq_axis *axis, double min, double max, size_t count, uint64_t seed,
                             uint64_t a, lq_axis *made, lq_error *error) {
    double nodes[256];
    const double first = lq_axis_locate(axis, min), last = lq_axis_locate(axis, max);
    if (axis->size == 1 || !(max > min))
        return lq_axis_make(made, axis->name, min, min, 1, LQ_MAP_LINEAR, 1.0, error);
    for (size_t i = 0; i < count; i++) {
        const double index = first + (last - first) * ((double)i + uniform(seed, a, i)) / (double)count;
        const size_t below = index >= (double)(axis->size - 1) ? axis->size - 2 : (size_t)index;
        nodes[i] =
            axis->nodes[below] + (index - (double)below) * (axis->nodes[below + 1] - axis->nodes[below]);
    }
    return lq_axis_make_custom(made, axis->name, nodes, count, error);
}

/* A solve serves every cosine and every tau (every n and kappa): more of those cost little. */
static size_t nodes_of(const char *name, size_t nodes) {
    const bool solved_for = strcmp(name, "alpha") == 0 || strcmp(name, "eta") == 0;
    return solved_for ? nodes : 2 * nodes;
}

lq_status lq_random_axes(const lq_axis *axes, int axis_count, const double *min, const double *max,
                         size_t nodes, size_t seed, lq_axis *made, lq_error *error) {
    lq_status status = LQ_OK;
    for (int a = 0; a < axis_count && status == LQ_OK; a++)
        status = random_axis(&axes[a], min[a], max[a], nodes_of(axes[a].name, nodes), seed, (uint64_t)a,
                             &made[a], error);
    return status;
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
