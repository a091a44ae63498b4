/* media.h - the cosine axis of each medium of a stack, and where energies in it step.
 *
 * Light in a medium is totally reflected towards every rarer one that it can see: through the interface next
 * to it, and on through interfaces that are smooth or nearly so. There energies step at the critical angle,
 * over cosines of the roughness of the roughest interface on the way; behind a rough one there is nothing
 * left of a step.
 */
#ifndef LACQUER_STACK_MEDIA_H
#define LACQUER_STACK_MEDIA_H

#include "microfacet/facets.h"
#include "precompute/nodes.h"

/* Two axes are the same where their bytes are. */
typedef struct lq_plan_axis {
    double n; /* index of the medium */
    int cut_count;
    double cut[LQ_ELEMENTS_MAX];   /* cosines, ascending */
    double width[LQ_ELEMENTS_MAX]; /* roughness that each step has passed, while cuts are looked for */
    bool stepped[LQ_ELEMENTS_MAX]; /* nodes resolve it from below only if they are dense there */
    lq_facet_cuts sharp;           /* those that divide the facet integrals and nodes of other interfaces */
} lq_plan_axis;

/* One channel's media from the top. */
typedef struct lq_media {
    size_t count;
    double *n;     /* of each medium */
    double *alpha; /* of what lies below it: an interface, or a base; infinite where that has no steps */
    double base_n, base_kappa; /* of a conductor, relative to the last medium; base_n < 0: none */
} lq_media;

/* The axis of all media of that index. */
lq_plan_axis lq_media_axis(const lq_media *media, double n);

#endif
