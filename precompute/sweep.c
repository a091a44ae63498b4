/* lq_eval and lq_precompute: an evaluator over one point, or over a grid on all cores. */
#include "precompute/evaluator.h"

#include "system/status.h"
#include "tables/facts.h"

#include <math.h>
#include <omp.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

lq_settings lq_settings_default(void) {
    return (lq_settings){.struct_size = sizeof(lq_settings),
                         .ndf = "ggx",
                         .scattering = LQ_MULTIPLE,
                         .masking = LQ_CORRELATED,
                         .tolerance = 0.0,
                         .threads = 0};
}

lq_status lq_eval(const lq_kind *kind, const lq_settings *settings, const double *point, double *values,
                  double *estimate, lq_error *error) {
    const lq_evaluator *evaluator = lq_evaluator_find(kind->id);
    size_t size[LQ_MAX_AXES];
    const double *nodes[LQ_MAX_AXES];
    double *channels[LQ_MAX_CHANNELS];
    for (int a = 0; a < kind->axis_count; a++) {
        size[a] = 1;
        nodes[a] = point + a;
    }
    for (int c = 0; c < kind->channel_count; c++) channels[c] = values + c;
    lq_job job;
    lq_status status = lq_job_make(&job, kind, settings, size, nodes, error);
    if (status != LQ_OK) return status;
    void *state = NULL;
    if (evaluator->prepare) status = evaluator->prepare(&job, &state, error);
    if (status == LQ_OK) status = lq_job_prepare(&job, evaluator, 0, error);
    if (status == LQ_OK) status = evaluator->slice(&job, state, 0, channels, estimate, error);
    if (evaluator->release) evaluator->release(state);
    lq_job_free(&job);
    if (status == LQ_OK && *estimate > job.tolerance)
        return lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance %.2g", *estimate,
                       job.tolerance);
    return status;
}

/* ------------------------------------------------------------------------------ the sweep */

typedef struct sweep {
    const lq_job *job;
    const lq_evaluator *evaluator;
    const void *state;
    lq_table *table;
    const lq_progress *progress;
    atomic_size_t done;
    atomic_bool stop;
    double *estimates; /* of each slice */
    lq_status status;  /* first failure, under the critical section */
    lq_error *error;
} sweep;

/* Slice values to their places in the table: `inner` entries run below the slice axis, `outer` above. */
static void scatter_slice(const sweep *s, size_t index, double *const *values) {
    const int axis = s->evaluator->slice_axis;
    size_t inner = 1, outer = 1;
    for (int a = 0; a < s->job->kind->axis_count; a++)
        if (a != axis) *(a < axis ? &inner : &outer) *= s->job->size[a];
    for (int c = 0; c < s->job->kind->channel_count; c++)
        for (size_t o = 0; o < outer; o++) {
            float *to = s->table->channels[c] + (o * s->job->size[axis] + index) * inner;
            for (size_t i = 0; i < inner; i++) to[i] = (float)values[c][o * inner + i];
        }
}

static lq_status compute_slice(sweep *s, size_t index, lq_error *error) {
    const size_t entries = lq_slice_entries(s->job, s->evaluator);
    const size_t channels = (size_t)s->job->kind->channel_count;
    double *values[LQ_MAX_CHANNELS];
    double *block = malloc(channels * entries * sizeof *block);
    if (!block) return lq_fail(error, LQ_NO_MEMORY, "no memory for a slice of %zu entries", entries);
    for (size_t c = 0; c < channels; c++) values[c] = block + c * entries;
    lq_status status = lq_job_prepare(s->job, s->evaluator, index, error);
    if (status == LQ_OK)
        status = s->evaluator->slice(s->job, s->state, index, values, &s->estimates[index], error);
    if (status == LQ_OK) scatter_slice(s, index, values);
    free(block);
    return status;
}

static void report(sweep *s, lq_status status, const lq_error *error) {
    const size_t total = s->job->size[s->evaluator->slice_axis];
    const size_t done = atomic_fetch_add(&s->done, 1) + 1;
#pragma omp critical(lq_sweep_report)
    {
        if (status != LQ_OK && s->status == LQ_OK) {
            s->status = status;
            if (s->error && error) *s->error = *error;
            atomic_store(&s->stop, true);
        }
        if (s->progress && s->progress->report && !atomic_load(&s->stop) &&
            !s->progress->report(s->progress->user, (double)done / (double)total)) {
            s->status = lq_fail(s->error, LQ_CANCELLED, "cancelled");
            atomic_store(&s->stop, true);
        }
    }
}

static void run(sweep *s, int threads) {
    const long total = (long)s->job->size[s->evaluator->slice_axis];
    /* One slice at a time: small roughness costs more than large, and a thread must not be left with all of
     * it. Which thread takes a slice does not change its bits. */
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (long i = 0; i < total; i++) {
        if (atomic_load(&s->stop)) continue;
        lq_error error = {""};
        const lq_status status = compute_slice(s, (size_t)i, &error);
        report(s, status, &error);
    }
}

/* ---------------------------------------------------------------------------------- facts */

static lq_status set_facts(lq_table *table, const lq_job *job, double estimate, lq_error *error) {
    const struct {
        const char *key, *value;
        unsigned takes; /* 0: every kind has it */
    } facts[] = {
        {"table", job->kind->id, 0},
        {"title", job->kind->title, 0},
        {"quantity", job->kind->quantity, 0},
        {"source", job->kind->source, 0},
        {"usage", job->kind->usage, 0},
        {"interface", job->kind->interface, 0},
        {"ndf", job->ndf->id, 0},
        {"ndf-note", job->ndf->note, 0},
        {"scattering", job->scattering == LQ_MULTIPLE ? "multiple" : "single", LQ_TAKES_SCATTERING},
        {"masking", job->masking == LQ_CORRELATED ? "correlated" : "separable", LQ_TAKES_MASKING},
        {"version", LQ_VERSION, 0},
    };
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < sizeof facts / sizeof facts[0]; i++)
        if (facts[i].value && (!facts[i].takes || (facts[i].takes & job->kind->takes)))
            status = lq_table_set_fact(table, facts[i].key, facts[i].value, error);
    if (status == LQ_OK) status = lq_table_set_number(table, "tolerance", job->tolerance, error);
    if (status == LQ_OK) status = lq_table_set_bound(table, "error", estimate, error);
    if (status == LQ_OK) status = lq_table_set_bound(table, "rounding", LQ_STORAGE_ROUNDING, error);
    return status;
}

/* -------------------------------------------------------------------------------- the call */

static lq_status check_axes(const lq_kind *kind, const lq_axis *axes, lq_error *error) {
    for (int a = 0; a < kind->axis_count; a++)
        if (strcmp(axes[a].name, kind->axes[a].name) != 0)
            return lq_fail(error, LQ_BAD_INPUT, "axis %d of %s is '%s', not '%s'", a + 1, kind->id,
                           kind->axes[a].name, axes[a].name);
    return LQ_OK;
}

static lq_status fill(sweep *s, int threads, lq_error *error) {
    const size_t slices = s->job->size[s->evaluator->slice_axis];
    void *state = NULL;
    s->estimates = calloc(slices, sizeof *s->estimates);
    if (!s->estimates) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu slices", slices);
    if (s->evaluator->prepare) s->status = s->evaluator->prepare(s->job, &state, error);
    s->state = state;
    if (s->status == LQ_OK) run(s, threads);
    if (s->evaluator->release) s->evaluator->release(state);
    double estimate = 0.0;
    for (size_t i = 0; i < slices; i++) estimate = fmax(estimate, s->estimates[i]);
    free(s->estimates);
    if (s->status == LQ_OK) s->status = set_facts(s->table, s->job, estimate, error);
    if (s->status == LQ_OK && estimate > s->job->tolerance)
        s->status = lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance %.2g",
                            estimate, s->job->tolerance);
    return s->status;
}

lq_status lq_precompute(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                        const lq_progress *progress, lq_table **table, lq_error *error) {
    size_t size[LQ_MAX_AXES];
    const double *nodes[LQ_MAX_AXES];
    *table = NULL;
    lq_status status = check_axes(kind, axes, error);
    if (status != LQ_OK) return status;
    for (int a = 0; a < kind->axis_count; a++) {
        size[a] = axes[a].size;
        nodes[a] = axes[a].nodes;
    }
    lq_job job;
    status = lq_job_make(&job, kind, settings, size, nodes, error);
    if (status == LQ_OK)
        status = lq_table_create(table, axes, kind->axis_count, kind->channels, kind->channel_count, error);
    else return status;
    if (status != LQ_OK) {
        lq_job_free(&job);
        return status;
    }
    sweep s = {.job = &job, .evaluator = lq_evaluator_find(kind->id), .table = *table, .progress = progress};
    s.error = error;
    status = fill(&s, settings->threads > 0 ? settings->threads : omp_get_num_procs(), error);
    lq_job_free(&job);
    /* A table that missed its tolerance is still a table, and says by how much. */
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) {
        lq_table_free(*table);
        *table = NULL;
    }
    return status;
}
