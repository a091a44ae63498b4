/* measure.c - computes the points of `lacquer validate` and the lists of differences. */
#include "program/validate/validate.h"

#include "system/parallel.h"
#include "system/status.h"
#include "validate/certificate_checks.h"
#include "validate/certificate_suspects.h"
#include "validate/walk_kind.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct {
    const char *key, *title;
    bool between, walk, judged;
} kinds_of_list[VALIDATE_LISTS] = {
    [STORED_EXACT] = {"stored_exact", "stored - exact", false, false, true},
    [BETWEEN_EXACT] = {"interpolated_exact", "interpolated - exact", true, false, false},
    [STORED_WALK] = {"stored_walk", "stored - walk", false, true, true},
    [BETWEEN_WALK] = {"exact_walk", "exact - walk", true, true, true},
};

static lq_status prepare(validate_job *job, lq_error *error) {
    job->stored = job->request.points / 2;
    job->between = job->request.points - job->stored;
    job->channels = (size_t)job->origin.kind->channel_count;
    job->at = calloc(job->request.points, sizeof *job->at);
    bool short_of_memory = !job->at;
    for (int k = 0; k < VALIDATE_LISTS && !short_of_memory; k++) {
        const bool between = kinds_of_list[k].between;
        validate_list *list = &job->lists[k];
        *list = (validate_list){.key = kinds_of_list[k].key,
                                .title = kinds_of_list[k].title,
                                .at = between ? job->at + job->stored : job->at,
                                .count = (between ? job->between : job->stored) * job->channels,
                                .used = job->request.walk || !kinds_of_list[k].walk,
                                .judged = kinds_of_list[k].judged};
        list->compared = calloc(list->count, sizeof *list->compared);
        short_of_memory = !list->compared;
    }
    if (!short_of_memory) return LQ_OK;
    return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu points", job->request.points);
}

/* What is known at one point, each per channel. */
typedef struct values {
    double table[LQ_MAX_CHANNELS]; /* stored, or interpolated */
    double exact[LQ_MAX_CHANNELS];
    double estimate; /* error of `exact` */
    lq_walk_mean walk[LQ_MAX_CHANNELS];
} values;

/* The solver is asked for a tenth of the tolerance, so that it can judge values of that tolerance. */
static lq_status solve(const validate_job *job, const double *at, values *v, lq_error *error) {
    const lq_kind *kind = job->origin.kind;
    lq_settings settings = job->origin.settings;
    settings.tolerance = fmax(0.1 * settings.tolerance, kind->finest_tolerance);
    const lq_status status = lq_eval(kind, &settings, at, v->exact, &v->estimate, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status; /* its estimate says so */
}

static lq_status compute(const validate_job *job, const lq_drawn *drawn, size_t number, values *v,
                         lq_error *error) {
    const lq_status status = solve(job, drawn->at, v, error);
    if (status != LQ_OK || !job->request.walk) return status;
    const lq_walk_run walk = {.samples = job->request.samples,
                              .seed = job->request.seed,
                              .purpose = number,
                              .threads = job->walk_threads};
    return lq_walk_kind(job->origin.kind, &job->origin.settings, drawn->at, &walk, v->walk, error);
}

/* Half a unit in the last place of a stored value in [0.5, 1]. */
static const double rounding = 3e-8;

static void record(validate_job *job, const values *v, bool between, size_t i) {
    const double tolerance = job->origin.settings.tolerance;
    for (size_t c = 0; c < job->channels; c++) {
        const size_t at = i * job->channels + c;
        const double noise = job->request.walk ? lq_walk_noise(v->walk[c], job->request.samples) : 0.0;
        const double walk = v->walk[c].mean;
        if (between) {
            job->lists[BETWEEN_EXACT].compared[at] = (lq_compared){v->table[c], v->exact[c], INFINITY, 0.0};
            job->lists[BETWEEN_WALK].compared[at] = (lq_compared){v->exact[c], walk, v->estimate, noise};
        } else {
            job->lists[STORED_EXACT].compared[at] =
                (lq_compared){v->table[c], v->exact[c], tolerance + v->estimate + rounding, 0.0};
            job->lists[STORED_WALK].compared[at] =
                (lq_compared){v->table[c], walk, tolerance + rounding, noise};
        }
    }
}

static lq_status measure_point(validate_job *job, size_t i, lq_error *error) {
    const lq_table *table = job->table;
    const bool between = i >= job->stored;
    const size_t number = between ? i - job->stored : i;
    job->at[i] = between ? lq_draw_between(table->axes, table->axis_count, job->request.seed, number)
                         : lq_draw_entry(table->axes, table->axis_count, job->request.seed, number);
    values v = {.estimate = 0.0};
    for (int c = 0; c < table->channel_count; c++)
        v.table[c] =
            between ? lq_table_lookup(table, c, job->at[i].at) : (double)table->channels[c][job->at[i].entry];
    const lq_status status = compute(job, &job->at[i], i, &v, error);
    if (status == LQ_OK) record(job, &v, between, number);
    return status;
}

/* The entry of a complaint: its axes and its value. */
static void name_fault(validate_job *job, size_t index, int channel, double exact) {
    const lq_table *table = job->table;
    double at[LQ_MAX_AXES];
    char point[160];
    lq_entry_point(table, index, at);
    lq_point_text(job->origin.kind, at, point, sizeof point);
    snprintf(job->fault, sizeof job->fault, "entry %s of %s is %g, where %.6g is right", point,
             table->channel_names[channel], (double)table->channels[channel][index], exact);
}

/* All entries: range, and whether those that stick out of their neighbours are right to. */
static lq_status look_at_entries(validate_job *job, lq_error *error) {
    lq_suspect list[LQ_SUSPECTS];
    const lq_table *table = job->table;
    const double tolerance = job->origin.settings.tolerance;
    double worst = 0.0;
    job->entries = lq_entries_look(table, job->origin.kind);
    lq_suspects_find(table, tolerance, list);
    lq_status status = LQ_OK;
    for (int i = 0; status == LQ_OK && i < LQ_SUSPECTS; i++) {
        if (!(list[i].score > 0.0)) continue;
        lq_drawn drawn = {.entry = list[i].index};
        values v = {.estimate = 0.0};
        lq_entry_point(table, list[i].index, drawn.at);
        status = solve(job, drawn.at, &v, error);
        const double stored = (double)table->channels[list[i].channel][list[i].index];
        const double exact = v.exact[list[i].channel], off = fabs(stored - exact);
        job->suspects++;
        if (status != LQ_OK || !(off > tolerance + v.estimate + rounding) || !(off > worst)) continue;
        worst = off;
        name_fault(job, list[i].index, list[i].channel, exact);
    }
    if (status != LQ_OK || job->entries.faults == 0) return status;
    values v = {.estimate = 0.0};
    status = solve(job, job->entries.at, &v, error);
    if (status == LQ_OK)
        name_fault(job, job->entries.index, job->entries.channel, v.exact[job->entries.channel]);
    return status;
}

static lq_status reduce(validate_job *job, lq_error *error) {
    size_t judged = 0;
    for (int k = 0; k < VALIDATE_LISTS; k++)
        if (job->lists[k].used && job->lists[k].judged) judged += job->lists[k].count + 1;
    for (int k = 0; k < VALIDATE_LISTS; k++) {
        validate_list *list = &job->lists[k];
        if (!list->used) continue;
        const lq_status status = lq_compare(list->compared, list->count, judged, &list->result, error);
        if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

static lq_status turn(void *user, size_t i, int thread, lq_error *error) {
    (void)thread;
    return measure_point(user, i, error);
}

/* The points run side by side; where there are fewer than threads, the walks of one do instead. */
lq_status validate_measure(validate_job *job, const lq_progress *progress, lq_error *error) {
    lq_status status = prepare(job, error);
    if (status != LQ_OK) return status;
    const size_t points = job->request.points;
    const int threads = lq_parallel_threads(SIZE_MAX, (int)job->request.threads);
    const bool side_by_side = points >= (size_t)threads;
    job->walk_threads = side_by_side ? 1 : threads;
    status = lq_parallel(points, side_by_side ? threads : 1, turn, job, progress, error);
    if (status == LQ_OK) status = look_at_entries(job, error);
    return status == LQ_OK ? reduce(job, error) : status;
}

void validate_free(validate_job *job) {
    for (int k = 0; k < VALIDATE_LISTS; k++) free(job->lists[k].compared);
    free(job->at);
    lq_ndf_close(job->origin.settings.opened);
    lq_table_free(job->table);
}

const char *validate_complaint(const validate_job *job) {
    const lq_comparison *stored = &job->lists[STORED_EXACT].result;
    if (job->entries.faults > 0) return job->fault;
    if (!stored->explained) return "stored values are off by more than the tolerance they state";
    if (job->fault[0]) return job->fault; /* one entry, where the sampled ones are right */
    for (int k = STORED_WALK; k < VALIDATE_LISTS; k++)
        if (job->lists[k].used && !job->lists[k].result.explained)
            return "noise does not explain the difference to the walk";
    const double worst = fmax(stored->max, job->lists[BETWEEN_EXACT].result.max);
    if (job->request.budget > 0.0 && !(worst <= job->request.budget)) return "the error exceeds the budget";
    return NULL;
}
