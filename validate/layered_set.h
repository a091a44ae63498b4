/* layered_set.h - a set of stacks that models are measured on: recipes/layered, or anybody's.
 *
 *     {"name": "ba19", "about": "...", "theta": [30, 60],
 *      "stacks": [{"name": "metal", "category": "metals", "over": {"top.alpha": [0.1, 0.5]}, "layers":
 * [...]}]}
 *
 * `over` stands for a stack of every combination of its values, which lq_stack_set sets and which are part of
 * the name: metal-0.1, metal-0.5. Stacks of category "curves" are lines over their first parameter, by the
 * exact solver alone; all others are walked through.
 */
#ifndef LACQUER_VALIDATE_LAYERED_SET_H
#define LACQUER_VALIDATE_LAYERED_SET_H

#include "lacquer.h"

enum { LQ_LAYERED_THETAS = 16, LQ_LAYERED_MAX = 1000 };

typedef struct lq_layered_stack {
    lq_stack *stack; /* its name is complete */
    char base[LQ_STACK_NAME_SIZE], category[64];
    double first; /* the value of the first parameter; 0: none */
} lq_layered_stack;

typedef struct lq_layered_set {
    char name[64];
    size_t theta_count, count;
    double theta[LQ_LAYERED_THETAS]; /* degrees, 0 <= theta < 90 */
    lq_layered_stack *stacks;
} lq_layered_set;

/* Messages name the file and what is accepted. Free it whatever comes back. */
lq_status lq_layered_set_read(lq_layered_set *set, const char *path, lq_error *error);
void lq_layered_set_free(lq_layered_set *set);

#endif
