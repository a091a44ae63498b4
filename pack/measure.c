/* measure.c - errors of a texture at points off its grid. */
#include "pack/measure.h"

#include "pca/measure.h"
#include "tables/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 64 };

/* An additive recurrence: multiples of powers of 1/g, g the root of x^(d+1) = x + 1, modulo 1, are spread
 * evenly in d dimensions (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"). */
static double golden(int dimensions) {
    double g = 1.5;
    for (int i = 0; i < 64; i++) g = pow(1.0 + g, 1.0 / (dimensions + 1));
    return g;
}

/* Where the axis is measured from. */
static double lowest_of(const lq_axis *axis) {
    const char *name = axis->name;
    const bool bounded = strcmp(name, "mu") == 0 || strcmp(name, "alpha") == 0 || strcmp(name, "tau") == 0;
    return bounded ? fmin(fmax(axis->min, LQ_MEASURE_FROM), axis->max) : axis->min;
}

void lq_measure_point(const lq_axis *axes, int axis_count, size_t i, double *point) {
    const double g = golden(axis_count);
    for (int a = 0; a < axis_count; a++) {
        const double lowest = lowest_of(&axes[a]);
        const double u = fmod(0.5 + (double)(i + 1) * pow(g, -(a + 1)), 1.0);
        point[a] = lowest + (axes[a].max - lowest) * u;
    }
}

typedef struct job {
    const lq_kind *kind;
    const lq_settings *settings;
    const lq_axis *axes;
    lq_table *table;
} job;

static lq_status evaluate(const job *j, size_t i, lq_error *error) {
    double point[LQ_MAX_AXES], values[LQ_MAX_CHANNELS], estimate;
    lq_measure_point(j->axes, j->kind->axis_count, i, point);
    lq_status status = lq_eval(j->kind, j->settings, point, values, &estimate, error);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
    for (int c = 0; c < j->kind->channel_count; c++) j->table->channels[c][i] = (float)values[c];
    return LQ_OK;
}

static lq_status evaluate_all(const job *j, size_t count, const lq_progress *progress, lq_error *error) {
    lq_status failed = LQ_OK;
    for (size_t first = 0; first < count && failed == LQ_OK; first += BATCH) {
        const size_t end = first + BATCH < count ? first + BATCH : count;
#pragma omp parallel for schedule(dynamic, 1)
        for (size_t i = first; i < end; i++) {
            lq_error why = {""};
            const lq_status status = evaluate(j, i, &why);
            if (status == LQ_OK) continue;
#pragma omp critical(lq_measure)
            failed = lq_fail(error, status, "%s", why.text);
        }
        if (failed == LQ_OK && progress && !progress->report(progress->user, (double)end / (double)count))
            failed = LQ_CANCELLED;
    }
    return failed;
}

lq_status lq_measure_exact(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                           size_t count, const lq_progress *progress, lq_table **exact, lq_error *error) {
    lq_axis axis;
    lq_settings opened = *settings;
    lq_status status =
        lq_axis_make(&axis, "point", 0.0, (double)(count - 1), count, LQ_MAP_LINEAR, 0.0, error);
    if (status != LQ_OK) return status;
    status = lq_table_create(exact, &axis, 1, kind->channels, kind->channel_count, error);
    lq_axis_free(&axis);
    if (status != LQ_OK) return status;
    status = lq_ndf_open(&opened.opened, settings->ndf, error);
    const job j = {kind, &opened, axes, *exact};
    if (status == LQ_OK) status = evaluate_all(&j, count, progress, error);
    lq_ndf_close(opened.opened);
    if (status != LQ_OK) lq_table_free(*exact), *exact = NULL;
    return status;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

lq_status lq_measure_texture(const lq_texture *texture, const lq_axis *axes, int axis_count,
                             const lq_table *exact, lq_measure *measure, lq_error *error) {
    const size_t count = lq_table_entries(exact);
    const int channels = texture->channel_count;
    double *errors = malloc(count * (size_t)channels * sizeof *errors), squares = 0.0;
    if (!errors) return lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", texture->name);
    *measure = (lq_measure){.points = count, .max = -1.0};
    for (size_t i = 0; i < count; i++) {
        double point[LQ_MAX_AXES], values[4];
        lq_measure_point(axes, axis_count, i, point);
        lq_texture_sample(texture, point, LQ_FILTER_BITS, values);
        for (int c = 0; c < channels; c++) {
            const double off = fabs(values[c] - (double)exact->channels[c][i]);
            errors[i * (size_t)channels + (size_t)c] = off;
            squares += off * off;
            if (off <= measure->max) continue;
            measure->max = off;
            memcpy(measure->worst, point, sizeof point);
        }
    }
    const size_t all = count * (size_t)channels;
    qsort(errors, all, sizeof *errors, ascending);
    measure->rms = sqrt(squares / (double)all);
    measure->p99 = errors[(size_t)ceil(0.99 * (double)all) - 1];
    free(errors);
    return LQ_OK;
}

lq_status lq_measure_exact_grid(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                                size_t points, size_t seed, const lq_progress *progress, lq_table **exact,
                                lq_error *error) {
    lq_axis nodes[LQ_MAX_AXES] = {0};
    double min[LQ_MAX_AXES], max[LQ_MAX_AXES];
    /* Its cube is what three axes of so many nodes have. */
    const size_t each = (size_t)fmin(fmax(ceil(cbrt((double)points)), 4.0), 64.0);
    for (int a = 0; a < kind->axis_count; a++) {
        min[a] = lowest_of(&axes[a]);
        max[a] = axes[a].max;
    }
    lq_status status = lq_random_axes(axes, kind->axis_count, min, max, each, seed, nodes, error);
    if (status == LQ_OK) status = lq_precompute(kind, settings, nodes, progress, exact, error);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&nodes[a]);
    return status;
}

lq_status lq_measure_factored(const lq_factored *factored, int channel, const lq_table *exact,
                              lq_measure *measure, lq_error *error) {
    lq_pca_errors errors;
    const lq_status status = lq_factored_errors(factored, exact, channel, &errors, error);
    if (status != LQ_OK) return status;
    *measure = (lq_measure){errors.points, errors.rms, errors.p99, errors.max, {0}};
    memcpy(measure->worst, errors.worst, sizeof measure->worst);
    return LQ_OK;
}
