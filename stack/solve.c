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

/* Raise the level until all estimates hold; a level that does not settle is left out. `now` has room for
 * `count` lights. */
static lq_status refine(const lq_plan *plan, const lq_stack_query *query, double tolerance,
                        lq_stack_light *light, lq_stack_light *now, size_t count, const lq_progress *progress,
                        lq_error *error) {
    double worst = INFINITY;
    lq_status status = LQ_OK;
    for (int level = 0; level < LQ_SURFACE_LEVELS && worst > tolerance && status == LQ_OK; level++) {
        status = lq_stack_level(plan, query, level, now, progress, error);
        worst = 0.0;
        for (size_t i = 0; i < count && status == LQ_OK; i++) {
            now[i].error = level > 0 ? estimate_of(&now[i], &light[i], tolerance) : 1.0;
            worst = fmax(worst, now[i].error);
            light[i] = now[i];
        }
    }
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
    for (size_t i = 0; i < count; i++) worst = fmax(worst, light[i].error);
    if (worst <= tolerance) return LQ_OK;
    return lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance %.2g", worst,
                   tolerance);
}

lq_status lq_stack_solve_list(const lq_stack *const *stacks, size_t stack_count, const lq_stack_query *query,
                              lq_stack_light *light, const lq_progress *progress, lq_error *error) {
    const double tolerance = lq_stack_tolerance(query);
    lq_plan plan;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < stack_count && status == LQ_OK; i++)
        status = lq_stack_solvable(stacks[i], query, error);
    if (status == LQ_OK)
        status = lq_plan_make(&plan, stacks, stack_count, query->from_below,
                              query->single ? LQ_SINGLE : LQ_MULTIPLE, error);
    if (status != LQ_OK) return status;
    const size_t count = query->mu_count * (size_t)plan.channels * (query->paths ? query->paths : 1);
    lq_stack_light *now = malloc((count + 1) * sizeof *now);
    for (size_t i = 0; i < count; i++) light[i] = (lq_stack_light){.error = 1.0};
    status = now ? refine(&plan, query, tolerance, light, now, count, progress, error)
                 : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", query->mu_count);
    free(now);
    lq_plan_free(&plan);
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
