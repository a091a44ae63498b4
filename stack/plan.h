/* plan.h - a stack as light meets it: distinct surfaces, the media between them, and the order of both.
 *
 * Interfaces that are alike are solved once, whichever way up they lie and however many channels have them:
 * every medium of one index has one cosine axis, cut at the critical angles towards all rarer media of the
 * stack.
 */
#ifndef LACQUER_STACK_PLAN_H
#define LACQUER_STACK_PLAN_H

#include "stack/media.h"
#include "stack/surface.h"

typedef struct lq_plan_surface {
    lq_surface spec; /* without axes and entries */
    size_t axis[2];
    bool inside[2]; /* light arrives on that side from a medium between layers: at the nodes of its axis */
    bool asked[2];  /* or from outside: at the cosines that are asked for */
} lq_plan_surface;

typedef struct lq_plan_step {
    size_t surface;
    bool flipped; /* side 1 is up */
    int material;
} lq_plan_step;

typedef struct lq_plan_medium {
    size_t axis;
    double tau;
} lq_plan_medium;

/* One channel, from where the light comes: medium[0], step[0], medium[1], ... */
typedef struct lq_plan_chain {
    size_t steps;
    lq_plan_step *step;
    lq_plan_medium *medium; /* steps + 1; the last one counts only where the last step lets light through */
    bool opaque;
} lq_plan_chain;

typedef struct lq_plan {
    int channels;         /* of all stacks */
    lq_plan_chain *chain; /* of each channel, those of a later stack behind those of the ones before */
    size_t surface_count, axis_count, ndf_count;
    lq_plan_surface *surface;
    lq_plan_axis *axis;
    const lq_ndf **ndf; /* opened */
} lq_plan;

/* Of stacks that lq_stack_solvable accepts: what they have in common is solved once. Free it on LQ_OK. */
lq_status lq_plan_make(lq_plan *plan, const lq_stack *const *stacks, size_t count, bool from_below,
                       lq_scattering scattering, lq_error *error);
void lq_plan_free(lq_plan *plan);

#endif
