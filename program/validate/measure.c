/* measure.c - computes the points of `lacquer validate` and the lists of differences. */
#include "program/validate/validate.h"

#include "validate/walk_kind.h"

#include <math.h>
#include <omp.h>
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
    snprintf(error->text, sizeof error->text, "no memory for %zu points", job->request.points);
    return LQ_NO_MEMORY;
}

/* What is known at one point, each per channel. */
typedef struct values {
    double table[LQ_MAX_CHANNELS]; /* stored, or interpolated */
    double exact[LQ_MAX_CHANNELS];
    double estimate; /* error of `exact` */
    lq_walk_mean walk[LQ_MAX_CHANNELS];
} values;

/* The solver is asked for a tenth of the tolerance, so that it can judge values of that tolerance. */
static lq_status compute(const validate_job *job, const lq_drawn *drawn, size_t number, values *v,
                         lq_error *error) {
    const lq_kind *kind = job->origin.kind;
    lq_settings settings = job->origin.settings;
    settings.tolerance = fmax(0.1 * settings.tolerance, kind->finest_tolerance);
    lq_status status = lq_eval(kind, &settings, drawn->at, v->exact, &v->estimate, error);
    if (status == LQ_NOT_CONVERGED) status = LQ_OK; /* its estimate says so */
    if (status != LQ_OK || !job->request.walk) return status;
    const lq_walk_run walk = {.samples = job->request.samples,
                              .seed = job->request.seed,
                              .purpose = number,
                              .threads = job->walk_threads};
    return lq_walk_kind(kind, &settings, drawn->at, &walk, v->walk, error);
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

/* The points run side by side; where there are fewer than threads, the walks of one do instead. */
lq_status validate_measure(validate_job *job, const lq_progress *progress, lq_error *error) {
    lq_status status = prepare(job, error);
    if (status != LQ_OK) return status;
    const size_t points = job->request.points;
    const int threads = job->request.threads > 0 ? (int)job->request.threads : omp_get_max_threads();
    const bool side_by_side = points >= (size_t)threads;
    job->walk_threads = side_by_side ? 1 : threads;
    size_t done = 0;
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (side_by_side)
    for (size_t i = 0; i < points; i++) {
        lq_status stop;
#pragma omp atomic read
        stop = status;
        if (stop != LQ_OK) continue;
        lq_error cause = {""};
        stop = measure_point(job, i, &cause);
#pragma omp critical(validate_point)
        {
            done++;
            if (stop == LQ_OK && !progress->report(progress->user, (double)done / (double)points))
                stop = LQ_CANCELLED;
            if (stop != LQ_OK && status == LQ_OK) {
                *error = cause;
#pragma omp atomic write
                status = stop;
            }
        }
    }
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
    if (!stored->explained) return "stored values are off by more than the tolerance they state";
    for (int k = STORED_WALK; k < VALIDATE_LISTS; k++)
        if (job->lists[k].used && !job->lists[k].result.explained)
            return "noise does not explain the difference to the walk";
    const double worst = fmax(stored->max, job->lists[BETWEEN_EXACT].result.max);
    if (job->request.budget > 0.0 && !(worst <= job->request.budget)) return "the error exceeds the budget";
    return NULL;
}
