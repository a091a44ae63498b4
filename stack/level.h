/* level.h - a planned stack solved at one level of resolution. */
#ifndef LACQUER_STACK_LEVEL_H
#define LACQUER_STACK_LEVEL_H

#include "stack/plan.h"

/* What a query asks for, the default where it asks for nothing. */
double lq_stack_tolerance(const lq_stack_query *query);

/* Several stacks at once, each with the channels of its own: light[(m * channels + c) * paths + p], c over
 * all of them. As lq_stack_solve. */
lq_status lq_stack_solve_list(const lq_stack *const *stacks, size_t stack_count, const lq_stack_query *query,
                              lq_stack_light *light, const lq_progress *progress, lq_error *error);

/* What is asked of every channel: light as in lq_stack_solve, its errors left alone. LQ_NOT_CONVERGED: this
 * level is too fine for some interface. */
lq_status lq_stack_level(const lq_plan *plan, const lq_stack_query *query, int level, lq_stack_light *light,
                         const lq_progress *progress, lq_error *error);

#endif
