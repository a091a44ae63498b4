/* solve.c - lq_stack_solve: levels of resolution until two in a row agree. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stack/description.h"
#include "stack/level.h"
#include "system/status.h"

static const double DEFAULT_TOLERANCE = 1e-4;

double lq_stack_tolerance(const lq_stack_query *query) {
    return query->tolerance > 0.0 ? query->tolerance : DEFAULT_TOLERANCE;
}

static double difference(const lq_stack_lobe *a, const lq_stack_lobe *b) {
    const double energy = fabs(a->energy - b->energy), sin2 = fabs(a->sin2 - b->sin2);
    return fmax(fmax(energy, sin2), fmax(fabs(a->mean - b->mean), fabs(a->across - b->across)));
}

/* The level that is kept is five and more times as good as the one before, as a rule; where light meets many
 * facets between nearly equal indices it can be no better than two thirds, and three times of what has
 * changed covers that. An estimate is never below a tenth of the tolerance: two levels can agree by accident.
 */
static const double CAUTION = 3.0, LEAST = 0.1;

static double estimate_of(const lq_stack_light *now, const lq_stack_light *before, double tolerance) {
    const double change = fmax(difference(&now->reflected, &before->reflected),
                               difference(&now->transmitted, &before->transmitted));
    return fmax(CAUTION * change, LEAST * tolerance);
}

/* Several stacks, each raised until its own estimates hold. */
typedef struct refining {
    const lq_stack *const *stacks;
    size_t count;
    const lq_stack_query *query;
    const lq_progress *progress;
    size_t channels, paths; /* channels of all stacks */
    size_t *first;          /* channels of the stacks before: count + 1 */
    double *worst;          /* estimate of each stack; INFINITY: there is no level yet */
    const lq_stack **open;  /* stacks of one level, */
    size_t *which;          /* and which they are */
    lq_stack_light *light, *now;
} refining;

/* What has been found of one stack: the error of each number, by what it was at the level before. */
static void keep(const refining *r, size_t stack, size_t first, size_t channels) {
    const size_t own = (r->first[stack + 1] - r->first[stack]) * r->paths;
    const bool judged = r->worst[stack] < INFINITY;
    double worst = 0.0;
    for (size_t m = 0; m < r->query->mu_count; m++)
        for (size_t i = 0; i < own; i++) {
            lq_stack_light *now = &r->now[(m * channels + first) * r->paths + i],
                           *kept = &r->light[(m * r->channels + r->first[stack]) * r->paths + i];
            now->error = judged ? estimate_of(now, kept, lq_stack_tolerance(r->query)) : 1.0;
            worst = fmax(worst, now->error);
            *kept = *now;
        }
    r->worst[stack] = worst;
}

/* `count` stacks of r->which at one level. */
static lq_status solve_level(const refining *r, const size_t *which, size_t count, int level,
                             lq_error *error) {
    lq_plan plan;
    size_t first = 0;
    for (size_t i = 0; i < count; i++) r->open[i] = r->stacks[which[i]];
    lq_status status = lq_plan_make(&plan, r->open, count, r->query->from_below,
                                    r->query->single ? LQ_SINGLE : LQ_MULTIPLE, error);
    if (status != LQ_OK) return status;
    status = lq_stack_level(&plan, r->query, level, r->now, r->progress, error);
    for (size_t i = 0; i < count && status == LQ_OK; i++) {
        keep(r, which[i], first, (size_t)plan.channels);
        first += r->first[which[i] + 1] - r->first[which[i]];
    }
    lq_plan_free(&plan);
    return status;
}

/* Levels that may be left out before there is an estimate. */
enum { MISSES = 3 };

/* A level that does not settle is left out: the coarser ones hold, and where there are not two of them yet,
 * finer ones are tried. One stack does not take the others with it. */
static lq_status raise_level(const refining *r, int *missed, int level, lq_error *error) {
    size_t count = 0;
    for (size_t i = 0; i < r->count; i++)
        if (missed[i] < MISSES && r->worst[i] > lq_stack_tolerance(r->query)) r->which[count++] = i;
    lq_status status = count ? solve_level(r, r->which, count, level, error) : LQ_OK;
    if (status != LQ_NOT_CONVERGED) return status;
    for (size_t i = 0; i < count; i++) {
        const size_t stack = r->which[i];
        status = count > 1 ? solve_level(r, &stack, 1, level, error) : LQ_NOT_CONVERGED;
        if (status == LQ_NOT_CONVERGED) missed[stack] = r->worst[stack] < 1.0 ? MISSES : missed[stack] + 1;
        else if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

static lq_status refine(const refining *r, int *missed, lq_error *error) {
    lq_status status = LQ_OK;
    double worst = 0.0;
    for (int level = LQ_LEVEL_TRIAL; level < LQ_SURFACE_LEVELS && status == LQ_OK; level++)
        status = raise_level(r, missed, level, error);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < r->count; i++) worst = fmax(worst, fmin(r->worst[i], 1.0));
    if (worst <= lq_stack_tolerance(r->query)) return LQ_OK;
    return lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance %.2g", worst,
                   lq_stack_tolerance(r->query));
}

static void count_channels(refining *r) {
    r->paths = r->query->paths ? r->query->paths : 1;
    for (size_t i = 0; i < r->count; i++) {
        r->first[i] = r->channels;
        r->channels += (size_t)lq_stack_channels(r->stacks[i]);
        r->worst[i] = INFINITY;
    }
    r->first[r->count] = r->channels;
}

lq_status lq_stack_solve_list(const lq_stack *const *stacks, size_t stack_count, const lq_stack_query *query,
                              lq_stack_light *light, const lq_progress *progress, lq_error *error) {
    refining r = {
        .stacks = stacks, .count = stack_count, .query = query, .progress = progress, .light = light};
    lq_status status = LQ_OK;
    for (size_t i = 0; i < stack_count && status == LQ_OK; i++)
        status = lq_stack_solvable(stacks[i], query, error);
    if (status != LQ_OK) return status;
    r.first = calloc(stack_count + 1, sizeof *r.first);
    r.worst = calloc(stack_count + 1, sizeof *r.worst);
    r.open = calloc(stack_count + 1, sizeof(lq_stack *));
    r.which = calloc(stack_count + 1, sizeof *r.which);
    int *missed = calloc(stack_count + 1, sizeof *missed);
    const bool ok = r.first && r.worst && r.open && r.which && missed;
    if (ok) count_channels(&r);
    const size_t lights = query->mu_count * r.channels * (ok ? r.paths : 0);
    r.now = malloc((lights + 1) * sizeof *r.now);
    for (size_t i = 0; i < lights; i++) light[i] = (lq_stack_light){.error = 1.0};
    status = ok && r.now ? refine(&r, missed, error)
                         : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", query->mu_count);
    free(r.first);
    free(r.worst);
    free(r.open);
    free(r.which);
    free(missed);
    free(r.now);
    return status;
}

lq_status lq_stack_solve(const lq_stack *stack, const lq_stack_query *query, lq_stack_light *light,
                         const lq_progress *progress, lq_error *error) {
    return lq_stack_solve_list(&stack, 1, query, light, progress, error);
}

/* The fewest paths after which no more than `least` is left, of one cosine and channel. */
static size_t paths_of(const lq_stack_light *light, double least) {
    double left = 0.0;
    for (size_t p = LQ_STACK_PATHS_MAX; p-- > 1;) {
        left += light[p].reflected.energy + light[p].transmitted.energy;
        if (left > least) return p + 2 < LQ_STACK_PATHS_MAX ? p + 2 : LQ_STACK_PATHS_MAX;
    }
    return 2;
}

lq_status lq_stack_count_paths(const lq_stack *stack, const lq_stack_query *query, double least,
                               size_t *paths, lq_error *error) {
    lq_stack_query every = *query;
    lq_plan plan;
    lq_status status = lq_stack_solvable(stack, query, error);
    if (status == LQ_OK)
        status =
            lq_plan_make(&plan, &stack, 1, query->from_below, query->single ? LQ_SINGLE : LQ_MULTIPLE, error);
    if (status != LQ_OK) return status;
    every.paths = LQ_STACK_PATHS_MAX;
    const size_t lines = query->mu_count * (size_t)plan.channels;
    lq_stack_light *light = malloc((lines * LQ_STACK_PATHS_MAX + 1) * sizeof *light);
    status = light ? lq_stack_level(&plan, &every, 0, light, NULL, error)
                   : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", query->mu_count);
    *paths = 2;
    for (size_t i = 0; status == LQ_OK && i < lines; i++) {
        const size_t needed = paths_of(light + i * LQ_STACK_PATHS_MAX, least);
        *paths = needed > *paths ? needed : *paths;
    }
    free(light);
    lq_plan_free(&plan);
    return status;
}
