/* measure.c - errors of a texture at points off its grid. */
#include "pack/measure.h"

#include "pca/measure.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 64 };

#define POINT_AXIS "point"

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
            failed = lq_fail(error, LQ_CANCELLED, "cancelled");
    }
    return failed;
}

lq_status lq_measure_axis(size_t count, lq_axis *axis, lq_error *error) {
    return lq_axis_make(axis, POINT_AXIS, 0.0, (double)(count - 1), count, LQ_MAP_LINEAR, 0.0, error);
}

lq_status lq_measure_exact(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                           size_t count, const lq_progress *progress, lq_table **exact, lq_error *error) {
    lq_axis axis;
    lq_settings opened = *settings;
    lq_status status = lq_measure_axis(count, &axis, error);
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

lq_status lq_measure_grid_axes(const lq_axis *axes, int axis_count, size_t points, size_t seed,
                               lq_axis *nodes, lq_error *error) {
    double min[LQ_MAX_AXES], max[LQ_MAX_AXES];
    /* Its cube is what three axes of so many nodes have. */
    const size_t each = (size_t)fmin(fmax(ceil(cbrt((double)points)), 4.0), 64.0);
    for (int a = 0; a < axis_count; a++) {
        nodes[a] = (lq_axis){.size = 0};
        min[a] = lowest_of(&axes[a]);
        max[a] = axes[a].max;
    }
    return lq_random_axes(axes, axis_count, min, max, each, seed, nodes, error);
}

lq_status lq_measure_exact_grid(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                                size_t points, size_t seed, const lq_progress *progress, lq_table **exact,
                                lq_error *error) {
    lq_axis nodes[LQ_MAX_AXES] = {0};
    lq_status status = lq_measure_grid_axes(axes, kind->axis_count, points, seed, nodes, error);
    if (status == LQ_OK) status = lq_precompute(kind, settings, nodes, progress, exact, error);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&nodes[a]);
    return status;
}

/* What is measured: values of so many channels at a point, against those of the exact table from `first` on.
 */
typedef struct subject {
    void (*sample)(const void *of, const double *point, double *values);
    const void *of;
    int channels, first;
    const lq_axis *axes; /* of the table */
    int axis_count;
    const lq_table *exact;
    bool relative;
} subject;

static void point_of(const subject *s, size_t i, double *point) {
    const lq_axis *axes = s->exact->axes;
    if (s->exact->axis_count == 1 && strcmp(axes[0].name, POINT_AXIS) == 0)
        lq_measure_point(s->axes, s->axis_count, i, point);
    else lq_node_point(s->exact, i, point);
}

static lq_status measure(const subject *s, lq_measure *measured, lq_error *error) {
    const size_t count = lq_table_entries(s->exact), all = count * (size_t)s->channels;
    double *errors = malloc(all * sizeof *errors), squares = 0.0;
    size_t worst = 0;
    if (!errors) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu errors", all);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < count; i++) {
        double point[LQ_MAX_AXES], values[4];
        point_of(s, i, point);
        s->sample(s->of, point, values);
        for (int c = 0; c < s->channels; c++) {
            const double exact = (double)s->exact->channels[s->first + c][i];
            errors[i * (size_t)s->channels + (size_t)c] =
                fabs(values[c] - exact) / (s->relative ? fabs(exact) : 1.0);
        }
    }
    for (size_t i = 0; i < all; i++) {
        squares += errors[i] * errors[i];
        if (errors[i] > errors[worst]) worst = i;
    }
    *measured = (lq_measure){.points = count, .relative = s->relative, .max = errors[worst]};
    point_of(s, worst / (size_t)s->channels, measured->worst);
    qsort(errors, all, sizeof *errors, ascending);
    measured->rms = sqrt(squares / (double)all);
    measured->p99 = errors[(size_t)ceil(0.99 * (double)all) - 1];
    free(errors);
    return LQ_OK;
}

static void sample_texture(const void *of, const double *point, double *values) {
    lq_texture_sample(of, point, LQ_FILTER_BITS, values);
}

static void sample_factors(const void *of, const double *point, double *values) {
    values[0] = lq_factored_lookup_gpu(of, point);
}

lq_status lq_measure_texture(const lq_texture *texture, const lq_axis *axes, int axis_count,
                             const lq_table *exact, bool relative, lq_measure *measured, lq_error *error) {
    const subject s = {sample_texture, texture, texture->channel_count, 0, axes, axis_count, exact, relative};
    return measure(&s, measured, error);
}

lq_status lq_measure_factored(const lq_factored *factored, int channel, const lq_table *exact, bool relative,
                              lq_measure *measured, lq_error *error) {
    const subject s = {sample_factors, factored, 1, channel, exact->axes, exact->axis_count, exact, relative};
    return measure(&s, measured, error);
}
