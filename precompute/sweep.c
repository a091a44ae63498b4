/* sweep.c - the solves of a table, on all cores, at values of the sweep's own, and lq_precompute. */
#include "precompute/sweep_state.h"

#include "microfacet/cpu.h"
#include "system/draft.h"
#include "system/number.h"
#include "system/parallel.h"
#include "system/status.h"
#include "tables/facts.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* What interpolation may leave out at least. A level of a solver is some three times as good as the one
 * before, so that solves should have most of the tolerance; a point more halves what is left out. */
static const double INTERPOLATION = 0.2;

static size_t channels_of(const lq_sweep *s) {
    return (size_t)s->job.kind->channel_count;
}

/* ======================================================================================
 *                                        Solves
 * ====================================================================================== */

/* Those of `along` from `first` on that repeat none. */
static size_t list_turns(const lq_sweep *s, size_t first, size_t *turns) {
    size_t count = 0;
    for (size_t v = first; v < s->along.count; v++)
        if (s->along.same[v] == v) turns[count++] = v;
    return count;
}

static lq_status read_estimates(lq_sweep *s, size_t first, lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t v = first; status == LQ_OK && v < s->along.count; v++)
        status = lq_parts_read(s->parts, s->along.same[v], 0, sizeof(double), &s->estimates[v], error);
    return status;
}

/* Solve what `along` has and is not solved yet. Small roughness costs more than large, and comes first. */
static lq_status solve_turns(lq_sweep *s, const lq_progress *progress, lq_error *error) {
    const size_t first = s->done;
    size_t *turns = malloc((s->along.count - first + 1) * sizeof *turns);
    s->done = s->along.count;
    s->job.size[s->evaluator->slice_axis] = s->along.count;
    if (!turns) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu solves", s->done - first);
    const size_t count = list_turns(s, first, turns);
    lq_status status = count == 0 ? LQ_OK
                                  : lq_parts_make(s->parts, turns, count, s->threads, lq_sweep_make_part, s,
                                                  progress, error);
    if (status == LQ_OK) status = read_estimates(s, first, error);
    free(turns);
    return status;
}

/* ======================================================================================
 *                                    Interpolation
 * ====================================================================================== */

/* Positions of a slice whose last coefficients are looked at together. */
enum { AT_ONCE = 1 << 14 };

typedef struct looking {
    const lq_sweep *sweep;
    const lq_along_panel *panel;
    size_t runs;          /* of one channel */
    lq_series_tail *tail; /* of each run */
} looking;

static lq_status look_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    const looking *l = user;
    const lq_sweep *s = l->sweep;
    const size_t channel = turn / l->runs, from = turn % l->runs * AT_ONCE;
    const size_t to = s->entries - from < AT_ONCE ? s->entries : from + AT_ONCE;
    const size_t nodes = l->panel->series.nodes;
    const double *at_node[LQ_SERIES_MAX];
    double *values = malloc(nodes * AT_ONCE * sizeof *values);
    lq_status status = values ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", nodes);
    for (size_t k = 0; status == LQ_OK && k < nodes; k++) {
        at_node[k] = values + k * AT_ONCE;
        status = lq_sweep_read(s, l->panel->first + k, channel, from, to, values + k * AT_ONCE, error);
    }
    if (status == LQ_OK) lq_series_tail_add(&l->tail[turn], &l->panel->series, at_node, to - from);
    free(values);
    return status;
}

/* What interpolation in a panel leaves out. */
static lq_status find_missing(const lq_sweep *s, const lq_along_panel *panel, double *missing,
                              lq_error *error) {
    const size_t runs = (s->entries + AT_ONCE - 1) / AT_ONCE, turns = channels_of(s) * runs;
    looking l = {s, panel, runs, calloc(turns, sizeof *l.tail)};
    lq_status status = l.tail ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", turns);
    if (status == LQ_OK) status = lq_parallel(turns, s->threads, look_turn, &l, NULL, error);
    lq_series_tail all = {0.0, 0.0};
    for (size_t i = 0; status == LQ_OK && i < turns; i++) {
        all.older = fmax(all.older, l.tail[i].older);
        all.newer = fmax(all.newer, l.tail[i].newer);
    }
    *missing = lq_series_tail_missing(&all);
    free(l.tail);
    return status;
}

/* The same by the first of a crew. */
static lq_status agree_on_missing(const lq_sweep *s, const lq_along_panel *panel, double *missing,
                                  lq_error *error) {
    lq_status status = LQ_OK;
    *missing = 0.0;
    if (!s->crew || s->crew->rank == 0) status = find_missing(s, panel, missing, error);
    if (s->crew) status = s->crew->meet(s->crew->user, status, error);
    if (s->crew && status == LQ_OK) s->crew->share(s->crew->user, missing, sizeof *missing);
    return status;
}

static double estimate_between(const lq_sweep *s, size_t first, size_t count) {
    double most = 0.0;
    for (size_t v = first; v < first + count; v++) most = fmax(most, s->estimates[v]);
    return most;
}

/* A panel that leaves out more than its solves leave of the tolerance is refined. *settled: none was;
 * then *estimate is of the largest error of the table. */
static lq_status settle_panels(lq_sweep *s, bool *settled, double *estimate, lq_error *error) {
    lq_status status = LQ_OK;
    *settled = true;
    *estimate = 0.0;
    for (size_t v = 0; v < s->done; v++)
        if (lq_sweep_is_node(s, v)) *estimate = fmax(*estimate, s->estimates[v]);
    for (int p = 0; status == LQ_OK && p < LQ_ALONG_PANELS; p++) {
        const lq_along_panel *panel = &s->along.panel[p];
        double missing;
        if (!panel->used) continue;
        const double solves = estimate_between(s, panel->first, panel->series.nodes);
        status = agree_on_missing(s, panel, &missing, error);
        *estimate = fmax(*estimate, solves + missing);
        if (missing <= fmax(INTERPOLATION * s->tolerance, s->tolerance - solves)) continue;
        lq_along_refine(&s->along, p);
        *settled = false;
    }
    return status;
}

/* Rounds of solves, until every panel holds or is given up. */
static lq_status solve(lq_sweep *s, const lq_progress *progress, double *estimate, lq_error *error) {
    lq_status status = LQ_OK;
    bool settled = false;
    while (status == LQ_OK && !settled) {
        status = solve_turns(s, progress, error);
        if (status == LQ_OK) status = settle_panels(s, &settled, estimate, error);
    }
    return status;
}

/* ======================================================================================
 *                                    What is asked
 * ====================================================================================== */

static lq_status set_facts(lq_table *table, const lq_job *job, double tolerance, double estimate,
                           lq_error *error) {
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
    if (status == LQ_OK) status = lq_table_set_number(table, "tolerance", tolerance, error);
    if (status == LQ_OK) status = lq_table_set_bound(table, "error", estimate, error);
    if (status == LQ_OK) status = lq_table_set_bound(table, "rounding", LQ_STORAGE_ROUNDING, error);
    return status;
}

/* A number that comes back bit for bit, in as few digits as that takes. */
static void print_exact(FILE *out, double value) {
    char text[32];
    lq_print(text, sizeof text, "%.15g", value);
    if (lq_strtod(text, NULL) != value) lq_print(text, sizeof text, "%.17g", value);
    fprintf(out, " %s", text);
}

/* Lines of all that decides what the parts are; kernels of another width round differently. NULL: no memory.
 */
static char *write_key(const lq_sweep *s, const char *build) {
    const char *kernels = lq_cpu_has_avx512() ? "avx512" : lq_cpu_has_avx2() ? "avx2" : "base";
    lq_draft draft = {.text = NULL};
    FILE *out = lq_draft_open(&draft);
    if (!out) return NULL;
    fprintf(out, "table %s\nndf %s\nscattering %d\nmasking %d\ntolerance", s->job.kind->id, s->job.ndf->id,
            (int)s->job.scattering, (int)s->job.masking);
    print_exact(out, s->tolerance);
    for (int a = 0; a < s->shape->axis_count; a++) {
        const lq_axis *axis = &s->shape->axes[a];
        fprintf(out, "\naxis %s of %zu", axis->name, axis->size);
        for (size_t i = 0; i < axis->size; i++) print_exact(out, axis->nodes[i]);
    }
    fprintf(out, "processor %s\nprogram " LQ_VERSION " %s\n", kernels, build);
    return lq_draft_close(&draft, out) ? draft.text : NULL;
}

static lq_status check_axes(const lq_kind *kind, const lq_axis *axes, lq_error *error) {
    for (int a = 0; a < kind->axis_count; a++)
        if (strcmp(axes[a].name, kind->axes[a].name) != 0)
            return lq_fail(error, LQ_BAD_INPUT, "axis %d of %s is '%s', not '%s'", a + 1, kind->id,
                           kind->axes[a].name, axes[a].name);
    return LQ_OK;
}

/* ======================================================================================
 *                                       The sweep
 * ====================================================================================== */

/* Where it is solved, and room for that. */
static lq_status plan(lq_sweep *s, lq_error *error) {
    const int axis = s->evaluator->slice_axis;
    lq_job *job = &s->job;
    const bool planned = job->ndf->pieces
                             ? lq_along_make(&s->along, job->nodes[axis], job->size[axis], false)
                             : lq_along_plan(&s->along, job->nodes[axis], job->size[axis],
                                             INTERPOLATION * job->tolerance / s->evaluator->series_scale);
    s->entries = lq_slice_entries(job, s->evaluator);
    s->inner = 1;
    for (int a = 0; a < axis; a++) s->inner *= job->size[a];
    if (planned) s->estimates = calloc(s->along.most, sizeof *s->estimates);
    if (!s->estimates) return lq_fail(error, LQ_NO_MEMORY, "no memory for a table");
    job->nodes[axis] = s->along.value;
    job->size[axis] = s->along.count;
    if (s->along.panel[0].used) job->tolerance *= 1.0 - INTERPOLATION;
    return LQ_OK;
}

static lq_status open_parts(lq_sweep *s, const lq_parts_place *place, const char *build, lq_error *error) {
    lq_parts_place keyed = *place;
    char *key = place->folder ? write_key(s, build) : NULL;
    keyed.key = key;
    const lq_status status = place->folder && !key ? lq_fail(error, LQ_NO_MEMORY, "no memory for a key")
                                                   : lq_parts_open(&s->parts, &keyed, error);
    free(key);
    return status;
}

static lq_status begin(lq_sweep *s, const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                       lq_error *error) {
    size_t size[LQ_MAX_AXES];
    const double *nodes[LQ_MAX_AXES];
    lq_status status =
        lq_table_describe(&s->shape, axes, kind->axis_count, kind->channels, kind->channel_count, error);
    for (int a = 0; status == LQ_OK && a < kind->axis_count; a++) {
        size[a] = s->shape->axes[a].size;
        nodes[a] = s->shape->axes[a].nodes;
    }
    if (status == LQ_OK) status = lq_job_make(&s->job, kind, settings, size, nodes, error);
    if (status != LQ_OK) return status;
    s->threads = settings->threads > 0 ? settings->threads : omp_get_num_procs();
    s->tolerance = s->job.tolerance;
    s->evaluator = lq_evaluator_find(kind->id);
    return LQ_OK;
}

static lq_status run(lq_sweep *s, const lq_progress *progress, lq_error *error) {
    double estimate = 0.0;
    lq_status status = plan(s, error);
    if (status == LQ_OK && s->evaluator->prepare) status = s->evaluator->prepare(&s->job, &s->state, error);
    if (status == LQ_OK) status = solve(s, progress, &estimate, error);
    if (s->evaluator->release) s->evaluator->release(s->state);
    s->state = NULL;
    if (status == LQ_OK) status = set_facts(s->shape, &s->job, s->tolerance, estimate, error);
    if (status == LQ_OK && estimate > s->tolerance)
        status = lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance %.2g", estimate,
                         s->tolerance);
    return status;
}

lq_status lq_sweep_solve(lq_sweep **sweep, const lq_kind *kind, const lq_settings *settings,
                         const lq_axis *axes, const lq_parts_place *place, const char *build,
                         const lq_progress *progress, lq_error *error) {
    *sweep = NULL;
    lq_status status = check_axes(kind, axes, error);
    if (status != LQ_OK) return status;
    lq_sweep *s = calloc(1, sizeof *s);
    if (!s) return lq_fail(error, LQ_NO_MEMORY, "no memory for a table");
    s->crew = place->folder ? place->crew : NULL;
    status = begin(s, kind, settings, axes, error);
    if (status == LQ_OK) status = open_parts(s, place, build, error);
    if (status == LQ_OK) status = run(s, progress, error);
    /* A table that missed its tolerance is still a table, and says by how much. */
    if (status == LQ_OK || status == LQ_NOT_CONVERGED) *sweep = s;
    else lq_sweep_free(s, false);
    return status;
}

void lq_sweep_free(lq_sweep *s, bool whole) {
    if (!s) return;
    lq_parts_close(s->parts, whole);
    lq_along_free(&s->along);
    free(s->estimates);
    if (s->evaluator) lq_job_free(&s->job);
    lq_table_free(s->shape);
    free(s);
}

lq_table *lq_sweep_shape(lq_sweep *s) {
    return s->shape;
}

lq_rows lq_sweep_rows(lq_sweep *s) {
    return (lq_rows){s->shape, lq_sweep_read_rows, s};
}

size_t lq_sweep_found(const lq_sweep *s) {
    return lq_parts_found(s->parts);
}

/* ======================================================================================
 *                                     In memory
 * ====================================================================================== */

lq_status lq_sweep_hold(lq_sweep *s, lq_table *table, lq_error *error) {
    const lq_rows rows = lq_sweep_rows(s);
    lq_status status = lq_rows_hold(&rows, s->threads, table, error);
    for (size_t i = 0; status == LQ_OK && i < s->shape->fact_count; i++)
        status = lq_table_set_fact(table, s->shape->facts[i].key, s->shape->facts[i].value, error);
    return status;
}

lq_status lq_precompute(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                        const lq_progress *progress, lq_table **table, lq_error *error) {
    const lq_parts_place memory = {.folder = NULL};
    lq_sweep *sweep = NULL;
    *table = NULL;
    lq_status status = check_axes(kind, axes, error);
    if (status == LQ_OK)
        status = lq_table_create(table, axes, kind->axis_count, kind->channels, kind->channel_count, error);
    if (status == LQ_OK) status = lq_sweep_solve(&sweep, kind, settings, axes, &memory, "", progress, error);
    const lq_status held = sweep ? lq_sweep_hold(sweep, *table, error) : LQ_OK;
    if (held != LQ_OK) status = held;
    lq_sweep_free(sweep, true);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) {
        lq_table_free(*table);
        *table = NULL;
    }
    return status;
}
