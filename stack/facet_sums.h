/* facet_sums.h - where the facets that one direction sees send light, in all modes: moments on cosine axes.
 */
#ifndef LACQUER_STACK_FACET_SUMS_H
#define LACQUER_STACK_FACET_SUMS_H

#include "microfacet/facets.h"
#include "precompute/nodes.h"
#include "stack/modes.h"

/* Parts of the light, by where they go after the hit. What rises on either side is summed twice: on the axis
 * of the medium, for what leaves, and on the nodes of the level, for what hits again. */
typedef enum lq_facet_part {
    LQ_PART_ESCAPES, /* reflected, away from the surface: on the axis leaving[0] */
    LQ_PART_PASSES,  /* refracted likewise: on leaving[1] */
    LQ_PART_RISES,   /* as ESCAPES; from here on: on `nodes` */
    LQ_PART_FALLS,
    LQ_PART_CROSSES,
    LQ_PART_CROSSES_FALLING,
    LQ_PARTS
} lq_facet_part;

typedef struct lq_facet_sums {
    const lq_ndf *ndf;
    double alpha;
    double eta;              /* of the dielectric; 0: conductors, which let nothing through */
    int materials;           /* conductors; 1 dielectric */
    const double *n, *kappa; /* of each conductor */
    double v_z;              /* height of the direction light comes from */
    const lq_facet_rule *rule;
    const lq_panels *kinks;
    const lq_node_axis *nodes;
    const lq_node_axis *leaving[2]; /* own side, other side */
    const lq_facet_cuts *cuts[2];   /* where they are not smooth; NULL: nowhere */
    bool masked; /* light arrives from outside: ESCAPES has the masking of each facet, RISES what it stops */
    /* Results and work. */
    double sine, area, total;
    size_t stride;   /* the longest axis */
    double *moments; /* [(part * variants + material * LQ_MODES + mode) * stride + m] */
} lq_facet_sums;

/* LQ_NO_MEMORY; free it on LQ_OK. */
lq_status lq_facet_sums_make(lq_facet_sums *sums, lq_error *error);
void lq_facet_sums_free(lq_facet_sums *sums);

/* Weights on the nodes of the part's axis, variant = material * LQ_MODES + mode; those of all light that a
 * lossless surface turns add up to 1 in mode 0. */
void lq_facet_sums_project(const lq_facet_sums *sums, int part, size_t variant, double *weights);

#endif
