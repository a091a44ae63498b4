/* lq_eval and lq_precompute: an evaluator over one point, or over a grid on all cores. */
#include "precompute/evaluator.h"

#include "precompute/along.h"
#include "system/parallel.h"
#include "system/status.h"
#include "tables/facts.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

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
    lq_job job;       /* at the values of `along`, to the share of the tolerance that solves have */
    double tolerance; /* of the table */
    const lq_evaluator *evaluator;
    const void *state;
    lq_table *table;
    lq_along along;
    size_t entries;     /* of a slice */
    size_t first, done; /* values of `along` that a loop is at, and that are solved */
    double **solved;    /* of each point of a panel: [channel * entries + i] */
    double *estimates;  /* of each value of `along` */
} sweep;

/* What interpolation may leave out at least. A level of a solver is some three times as good as the one
 * before, so that solves should have most of the tolerance; a point more halves what is left out. */
static const double INTERPOLATION = 0.2;

static size_t channels_of(const sweep *s) {
    return (size_t)s->job.kind->channel_count;
}

/* Slice values to their places in the table: `inner` entries run below the slice axis, `outer` above. */
static void scatter_slice(const sweep *s, size_t node, const double *values) {
    const int axis = s->evaluator->slice_axis;
    size_t inner = 1;
    for (int a = 0; a < axis; a++) inner *= s->job.size[a];
    for (size_t c = 0; c < channels_of(s); c++)
        for (size_t o = 0; o < s->entries / inner; o++) {
            float *to = s->table->channels[c] + (o * s->along.size + node) * inner;
            const double *from = values + c * s->entries + o * inner;
            for (size_t i = 0; i < inner; i++) to[i] = (float)from[i];
        }
}

static lq_status solve_slice(const sweep *s, size_t value, double *block, lq_error *error) {
    double *values[LQ_MAX_CHANNELS];
    for (size_t c = 0; c < channels_of(s); c++) values[c] = block + c * s->entries;
    const lq_status status = lq_job_prepare(&s->job, s->evaluator, value, error);
    if (status != LQ_OK) return status;
    return s->evaluator->slice(&s->job, s->state, value, values, &s->estimates[value], error);
}

/* A slice. Small roughness costs more than large, and comes first. */
static lq_status solve_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    sweep *s = user;
    const size_t value = s->first + turn, node = s->along.node[value];
    if (s->along.same[value] != value) return LQ_OK;
    double *block = malloc(channels_of(s) * s->entries * sizeof *block);
    if (!block) return lq_fail(error, LQ_NO_MEMORY, "no memory for a slice of %zu entries", s->entries);
    const lq_status status = solve_slice(s, value, block, error);
    if (status == LQ_OK && node < s->along.size) scatter_slice(s, node, block);
    if (status == LQ_OK && node == s->along.size) s->solved[value] = block;
    else free(block);
    return status;
}

/* Solve what `along` has and is not solved yet. */
static lq_status solve_turns(sweep *s, int threads, const lq_progress *progress, lq_error *error) {
    s->first = s->done;
    s->done = s->along.count;
    s->job.size[s->evaluator->slice_axis] = s->along.count;
    if (s->first == s->done) return LQ_OK;
    const lq_status status = lq_parallel(s->done - s->first, threads, solve_turn, s, progress, error);
    for (size_t v = s->first; v < s->done; v++) {
        s->solved[v] = s->solved[s->along.same[v]];
        s->estimates[v] = s->estimates[s->along.same[v]];
    }
    return status;
}

/* ------------------------------------------------------------------------- interpolation */

static double estimate_between(const sweep *s, size_t first, size_t count) {
    double most = 0.0;
    for (size_t v = first; v < first + count; v++) most = fmax(most, s->estimates[v]);
    return most;
}

/* A panel that leaves out more than its solves leave of the tolerance is refined. False where one was;
 * otherwise *estimate is of the largest error of the table. */
static bool settle_panels(sweep *s, double *estimate) {
    bool settled = true;
    *estimate = 0.0;
    for (size_t v = 0; v < s->done; v++)
        if (s->along.node[v] < s->along.size) *estimate = fmax(*estimate, s->estimates[v]);
    for (int p = 0; p < LQ_ALONG_PANELS; p++) {
        const lq_along_panel *panel = &s->along.panel[p];
        if (!panel->used) continue;
        const double solves = estimate_between(s, panel->first, panel->series.nodes);
        const double missing = lq_series_missing(
            &panel->series, (const double *const *)&s->solved[panel->first], channels_of(s) * s->entries);
        *estimate = fmax(*estimate, solves + missing);
        if (missing <= fmax(INTERPOLATION * s->tolerance, s->tolerance - solves)) continue;
        lq_along_refine(&s->along, p);
        settled = false;
    }
    return settled;
}

/* A node that a panel has. */
static lq_status interpolate_turn(void *user, size_t node, int thread, lq_error *error) {
    (void)thread;
    const sweep *s = user;
    const size_t count = channels_of(s) * s->entries;
    double weight[LQ_ALONG_POINTS];
    size_t first;
    const size_t points = lq_along_weights(&s->along, node, &first, weight);
    if (s->along.node[first] == node) return LQ_OK;
    double *values = calloc(count, sizeof *values);
    if (!values) return lq_fail(error, LQ_NO_MEMORY, "no memory for a slice of %zu entries", s->entries);
    for (size_t k = 0; k < points; k++)
        for (size_t i = 0; i < count; i++) values[i] += weight[k] * s->solved[first + k][i];
    for (size_t i = 0; i < count; i++)
        values[i] = fmin(fmax(values[i], s->job.kind->value_min), s->job.kind->value_max);
    scatter_slice(s, node, values);
    free(values);
    return LQ_OK;
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

/* Rounds of solves, until every panel holds or is given up; then the nodes between. */
static lq_status fill_table(sweep *s, int threads, const lq_progress *progress, double *estimate,
                            lq_error *error) {
    lq_status status = LQ_OK;
    bool settled = false;
    while (status == LQ_OK && !settled) {
        status = solve_turns(s, threads, progress, error);
        if (status == LQ_OK) settled = settle_panels(s, estimate);
    }
    if (status == LQ_OK) status = lq_parallel(s->along.size, threads, interpolate_turn, s, NULL, error);
    return status;
}

static bool allocate(sweep *s, const lq_job *job) {
    const int axis = s->evaluator->slice_axis;
    const bool planned = job->ndf->pieces
                             ? lq_along_make(&s->along, job->nodes[axis], job->size[axis], false)
                             : lq_along_plan(&s->along, job->nodes[axis], job->size[axis],
                                             INTERPOLATION * job->tolerance / s->evaluator->series_scale);
    if (!planned) return false;
    s->entries = lq_slice_entries(job, s->evaluator);
    s->job.nodes[axis] = s->along.value;
    s->job.size[axis] = s->along.count;
    if (s->along.panel[0].used) s->job.tolerance *= 1.0 - INTERPOLATION;
    s->solved = calloc(s->along.most, sizeof *s->solved);
    s->estimates = calloc(s->along.most, sizeof *s->estimates);
    return s->solved && s->estimates;
}

static void sweep_free(sweep *s) {
    for (size_t v = 0; s->solved && v < s->done; v++)
        if (s->along.same[v] == v) free(s->solved[v]);
    free(s->solved);
    free(s->estimates);
    lq_along_free(&s->along);
}

static lq_status fill(const lq_job *job, lq_table *table, int threads, const lq_progress *progress,
                      lq_error *error) {
    sweep s = {.job = *job,
               .tolerance = job->tolerance,
               .evaluator = lq_evaluator_find(job->kind->id),
               .table = table};
    void *state = NULL;
    double estimate = 0.0;
    lq_status status = allocate(&s, job) ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for a table");
    if (status == LQ_OK && s.evaluator->prepare) status = s.evaluator->prepare(&s.job, &state, error);
    s.state = state;
    if (status == LQ_OK) status = fill_table(&s, threads, progress, &estimate, error);
    if (s.evaluator->release) s.evaluator->release(state);
    sweep_free(&s);
    if (status == LQ_OK) status = set_facts(table, job, estimate, error);
    if (status == LQ_OK && estimate > job->tolerance)
        status = lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance %.2g", estimate,
                         job->tolerance);
    return status;
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
    status =
        fill(&job, *table, settings->threads > 0 ? settings->threads : omp_get_num_procs(), progress, error);
    lq_job_free(&job);
    /* A table that missed its tolerance is still a table, and says by how much. */
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) {
        lq_table_free(*table);
        *table = NULL;
    }
    return status;
}
