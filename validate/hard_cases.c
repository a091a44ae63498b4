/* Hard cases: single points against their limits, and whole grids of ends and limits against their range. */
#include "validate/hard_cases.h"

#include "system/number.h"
#include "system/status.h"
#include "validate/hard_cases_list.h"
#include "validate/smooth_limit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CASES = sizeof cases / sizeof cases[0], HARD_AXES = sizeof hard_values / sizeof hard_values[0] };

typedef struct counter {
    const lq_hard_run *run;
    size_t done, all;
} counter;

/* One step of the run is over. */
static lq_status step(counter *count, lq_error *error) {
    const lq_progress *progress = count->run->progress;
    count->done++;
    if (!progress || !progress->report ||
        progress->report(progress->user, (double)count->done / (double)count->all))
        return LQ_OK;
    return lq_fail(error, LQ_CANCELLED, "cancelled");
}

/* A NaN is between nothing. */
static void judge(const lq_hard_run *run, lq_hard_result *result) {
    result->passed = result->least >= result->low && result->most <= result->high;
    run->report(run->user, result);
}

/* ======================================================================================
 *                                     Single points
 * ====================================================================================== */

static lq_settings settings_of(const lq_hard_run *run, const lq_kind *kind) {
    lq_settings settings = lq_settings_default();
    settings.ndf = run->ndf;
    settings.threads = run->threads;
    settings.tolerance = kind->tolerance;
    return settings;
}

static lq_status value_at(const lq_hard_run *run, const lq_kind *kind, const double *point, double *values,
                          lq_error *error) {
    double estimate;
    const lq_settings settings = settings_of(run, kind);
    const lq_status status = run->source.eval(kind, &settings, point, values, &estimate, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

static void describe(const lq_kind *kind, const double *point, char *text, size_t size) {
    size_t used = (size_t)snprintf(text, size, "%s", kind->id);
    for (int a = 0; a < kind->axis_count && used < size; a++)
        used += (size_t)lq_print(text + used, size - used, " %s=%.8g", kind->axes[a].name, point[a]);
}

static lq_status limit_of(const lq_hard_run *run, const hard_case *hard, const lq_kind *kind, double *limit,
                          double *within, lq_error *error) {
    const lq_kind *other = hard->other_kind ? lq_kind_find(hard->other_kind, error) : kind;
    *within = hard->within + kind->tolerance;
    if (!other) return LQ_BAD_INPUT;
    if (hard->rule == SMOOTH) lq_smooth_limit(kind, hard->at, limit);
    for (int c = 0; c < kind->channel_count && hard->rule == NUMBER; c++)
        limit[c] = c == 0 ? hard->other[0] : NAN;
    if (hard->rule == SMOOTH || hard->rule == NUMBER) return LQ_OK;
    const lq_status status = value_at(run, other, hard->other, limit, error);
    *within += other->tolerance;
    for (int c = 0; hard->rule == REST && c < other->channel_count; c++) limit[c] = 1.0 - limit[c];
    return status;
}

static lq_status examine(const lq_hard_run *run, const hard_case *hard, lq_error *error) {
    const lq_kind *kind = lq_kind_find(hard->kind, error);
    if (!kind) return LQ_BAD_INPUT;
    double values[LQ_MAX_CHANNELS], limit[LQ_MAX_CHANNELS] = {0.0}, within;
    lq_status status = value_at(run, kind, hard->at, values, error);
    if (status == LQ_OK) status = limit_of(run, hard, kind, limit, &within, error);
    if (status != LQ_OK) return status;
    for (int c = 0; c < kind->channel_count; c++) {
        if (isnan(limit[c])) continue; /* no limit is known for this channel */
        lq_hard_result result = {hard->group,       "",   values[c], values[c], limit[c] - within,
                                 limit[c] + within, false};
        describe(kind, hard->at, result.asked, sizeof result.asked);
        judge(run, &result);
    }
    return LQ_OK;
}

/* ======================================================================================
 *                                         Grids
 * ====================================================================================== */

static lq_status make_hard_axis(const lq_axis_info *info, lq_axis *axis, lq_error *error) {
    double nodes[8] = {info->min, info->max};
    size_t count = info->min < info->max ? 2 : 1;
    for (size_t h = 0; h < HARD_AXES; h++) {
        if (strcmp(hard_values[h].axis, info->name) != 0) continue;
        count = 0;
        for (size_t i = 0; i < hard_values[h].count; i++)
            if (hard_values[h].values[i] >= info->lowest && hard_values[h].values[i] <= info->highest)
                nodes[count++] = hard_values[h].values[i];
    }
    return lq_axis_make_custom(axis, info->name, nodes, count, error);
}

/* Ends and limits break a solver at any tolerance; a loose one is quicker. */
static double grid_tolerance(const lq_kind *kind) {
    return fmin(10.0 * kind->tolerance, LQ_LOOSEST_TOLERANCE);
}

static lq_status make_grid(const lq_hard_run *run, const lq_kind *kind, lq_table **table, lq_error *error) {
    lq_axis axes[LQ_MAX_AXES] = {{.size = 0}};
    lq_status status = LQ_OK;
    for (int a = 0; status == LQ_OK && a < kind->axis_count; a++)
        status = make_hard_axis(&kind->axes[a], &axes[a], error);
    lq_settings settings = settings_of(run, kind);
    settings.tolerance = grid_tolerance(kind);
    if (status == LQ_OK) status = run->source.precompute(kind, &settings, axes, NULL, table, error);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* Smallest and largest of all channels where axis `a` has node `node`; NaN if any is. */
static void range_of(const lq_table *table, int a, size_t node, double *least, double *most) {
    size_t stride = 1;
    for (int k = 0; k < a; k++) stride *= table->axes[k].size;
    *least = INFINITY;
    *most = -INFINITY;
    for (int c = 0; c < table->channel_count; c++)
        for (size_t i = 0; i < lq_table_entries(table); i++) {
            const double value = (double)table->channels[c][i];
            if (i / stride % table->axes[a].size != node) continue;
            *least = isnan(value) || isnan(*least) ? NAN : fmin(*least, value);
            *most = isnan(value) || isnan(*most) ? NAN : fmax(*most, value);
        }
}

static void judge_ranges(const lq_hard_run *run, const lq_kind *kind, const lq_table *table) {
    for (int a = 0; a < table->axis_count; a++)
        for (size_t node = 0; node < table->axes[a].size; node++) {
            lq_hard_result result = {.group = "range", .low = kind->value_min, .high = kind->value_max};
            lq_print(result.asked, sizeof result.asked, "%s %s=%.8g, %zu values", kind->id,
                     table->axes[a].name, table->axes[a].nodes[node],
                     lq_table_entries(table) / table->axes[a].size * (size_t)table->channel_count);
            range_of(table, a, node, &result.least, &result.most);
            judge(run, &result);
        }
}

/* The solver's own estimate of its largest error there. */
static void judge_estimate(const lq_hard_run *run, const lq_kind *kind, const lq_table *table) {
    const char *fact = lq_table_fact(table, "error");
    const double estimate = fact ? lq_strtod(fact, NULL) : NAN;
    lq_hard_result result = {"error estimate", "", estimate, estimate, 0.0, grid_tolerance(kind), false};
    snprintf(result.asked, sizeof result.asked, "%s, %zu points", kind->id, lq_table_entries(table));
    judge(run, &result);
}

/* The entry of `table` with the coordinates of entry `i` of `like` and, where it has tau, tau = 1. */
static size_t matching(const lq_table *table, const lq_table *like, size_t i) {
    double at[LQ_MAX_AXES];
    for (int a = 0; a < like->axis_count; a++) {
        at[a] = like->axes[a].nodes[i % like->axes[a].size];
        i /= like->axes[a].size;
    }
    size_t entry = 0, stride = 1;
    for (int a = 0; a < table->axis_count; a++) {
        const int same = lq_table_axis(like, table->axes[a].name);
        entry += stride * (size_t)lround(lq_axis_locate(&table->axes[a], same >= 0 ? at[same] : 1.0));
        stride *= table->axes[a].size;
    }
    return entry;
}

/* What goes one way and what goes the other, where nothing is lost. */
static void judge_sum(const lq_hard_run *run, const char *what, const lq_table *one, const lq_table *other,
                      double tolerance) {
    lq_hard_result result = {"R + T = 1", "", INFINITY, -INFINITY, 1.0 - tolerance, 1.0 + tolerance, false};
    const int tau = lq_table_axis(one, "tau");
    size_t count = 0, stride = 1;
    for (int a = 0; a < tau; a++) stride *= one->axes[a].size;
    for (size_t i = 0; i < lq_table_entries(one); i++) {
        if (tau >= 0 && one->axes[tau].nodes[i / stride % one->axes[tau].size] != 1.0) continue;
        const double sum = (double)one->channels[0][i] + (double)other->channels[0][matching(other, one, i)];
        result.least = isnan(sum) ? NAN : fmin(result.least, sum);
        result.most = isnan(sum) ? NAN : fmax(result.most, sum);
        count++;
    }
    snprintf(result.asked, sizeof result.asked, "%s at tau=1, %zu points", what, count);
    judge(run, &result);
}

enum { REFLECTED, TRANSMITTED, RETURNED, LEFT, SHARES };
static const char *const sharing[SHARES] = {"fgd-dielectric", "transmission", "diffuse-reflection",
                                            "diffuse-transmission"};

static lq_status examine_grids(const lq_hard_run *run, counter *count, lq_error *error) {
    lq_table *kept[SHARES] = {NULL};
    lq_status status = LQ_OK;
    double tolerance = 0.0;
    for (size_t k = 0; status == LQ_OK && k < lq_kind_count(); k++) {
        const lq_kind *kind = lq_kind_at(k);
        lq_table *table = NULL;
        status = make_grid(run, kind, &table, error);
        if (status == LQ_OK) judge_ranges(run, kind, table);
        if (status == LQ_OK) judge_estimate(run, kind, table);
        for (int s = 0; s < SHARES; s++) {
            if (status != LQ_OK || strcmp(sharing[s], kind->id) != 0) continue;
            kept[s] = table;
            table = NULL;
            tolerance = fmax(tolerance, grid_tolerance(kind));
            break;
        }
        lq_table_free(table);
        if (status == LQ_OK) status = step(count, error);
    }
    if (status == LQ_OK && kept[REFLECTED] && kept[TRANSMITTED])
        judge_sum(run, "fgd-dielectric + transmission", kept[REFLECTED], kept[TRANSMITTED], 2.0 * tolerance);
    if (status == LQ_OK && kept[RETURNED] && kept[LEFT])
        judge_sum(run, "diffuse-reflection + diffuse-transmission", kept[RETURNED], kept[LEFT],
                  2.0 * tolerance);
    for (int s = 0; s < SHARES; s++) lq_table_free(kept[s]);
    return status;
}

lq_status lq_hard_cases(const lq_hard_run *run, lq_error *error) {
    counter count = {run, 0, CASES + lq_kind_count()};
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < CASES; i++) {
        if (!cases[i].ggx || strcmp(run->ndf, "ggx") == 0) status = examine(run, &cases[i], error);
        if (status == LQ_OK) status = step(&count, error);
    }
    if (status == LQ_OK) status = lq_hard_mappings(run, error);
    return status == LQ_OK ? examine_grids(run, &count, error) : status;
}
