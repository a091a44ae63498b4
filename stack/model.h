/* model.h - models of layered materials, as a renderer would run them: a few lobes, each with an energy, a
 * mean direction and a roughness.
 *
 * They are models: lq_stack_solve is what they approximate, and docs/stacks.md says how well. model_kind.h
 * lists them; model_shape.h has them as functions of directions.
 *
 * b18-forward is the statistical model of B18 sec. 5-6, one lobe an interface. Coefficients come from exact
 * tables (model_tables.h). Where B18's released code departs from the paper both are to be had:
 *
 *                        paper (default)                        released
 *     r21, t21           looked up from inside                  r12, t12
 *     FGD, TIR           at the interface's own alpha           at f^-1(variance so far + f(alpha))
 *     media that scatter what is scattered is spread           all that crosses
 *     transmitted alpha  s of the refracted cosines (eq. 10)    s as at normal incidence
 *
 * Media scatter forward, once (0 < g < 1); what goes back or is scattered again is lost.
 *
 * A Lambertian base is D22's lobe, under one coat or none. Below an interface that the mean direction does
 * not refract into there is no light.
 *
 * baked is what scenes give a shader (material.h): the top interface's own lobe, and one for all the rest,
 * with the exact stack's energies and the roughness that spreads as far across the plane of incidence.
 */
#ifndef LACQUER_STACK_MODEL_H
#define LACQUER_STACK_MODEL_H

#include "stack/model_kind.h"
#include "stack/model_tables.h"

typedef struct lq_model_lobe {
    double energy;
    double mean;     /* sin theta of its direction, away from the light */
    double variance; /* linear: f of `alpha` */
    double alpha;    /* of a GGX lobe about that direction */
} lq_model_lobe;

typedef struct lq_model_query {
    const double *mu; /* cosines of incidence, from above */
    size_t mu_count;
    lq_model_id model;
    lq_model_variant variant; /* for those that have variants, as is f */
    lq_model_f f;
    const lq_model_mapping *mapping; /* that f, where it was made already; NULL: made for this query */
    const lq_model_source *source;   /* of tables; NULL: they are computed exactly */
    double tolerance;                /* of tables; 0: what each has by itself */
    int threads;                     /* 0: one per core */
} lq_model_query;

/* Lobes of one cosine and channel: one a layer, of what that interface adds to the reflected light, and last
 * the light that goes through, in the lowest medium. Those of baked are the first, of the top, the last
 * layer's, of all the rest, and the last; over a Lambertian base the second has the light that did not meet
 * it. */
size_t lq_model_lobe_count(const lq_stack *stack);

/* lobes[(m * channels + c) * lobe count + k]. LQ_BAD_INPUT: what lq_stack_solve refuses, an NDF that is not
 * ggx, what the model refuses besides (model_kind.h), and a relative index that a table does not have.
 * LQ_NOT_CONVERGED: a table was not reached; `lobes` are not all filled. */
lq_status lq_model_solve(const lq_stack *stack, const lq_model_query *query, lq_model_lobe *lobes,
                         const lq_progress *progress, lq_error *error);

/* What that refuses before anything is solved. */
lq_status lq_model_check(const lq_stack *stack, const lq_model_query *query, lq_error *error);

/* The same as lq_stack_solve has it, from the lobes of one cosine and channel: moments of GGX lobes of these
 * energies and roughnesses, light arriving mirrored to their means. `error` is 0: a model has no estimate. */
lq_stack_light lq_model_light(const lq_stack *stack, const lq_model_lobe *lobes);

#endif
