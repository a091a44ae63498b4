/* What all interfaces of one roughness share at one level of resolution: node cosines, depths, travel. */
#ifndef LACQUER_PRECOMPUTE_ROUGH_LEVEL_H
#define LACQUER_PRECOMPUTE_ROUGH_LEVEL_H

#include "microfacet/facets.h"
#include "precompute/depth.h"
#include "precompute/dielectric.h"
#include "precompute/nodes.h"

/* Where rewards of the light that leaves after its first hit are read, outside the iteration: tau^(1/mu) has
 * an essential singularity at grazing, which costs nodes that plain energy can do without. */
enum { LQ_LEAVING = 64 };

typedef struct lq_leaving {
    lq_node_axis axis;
    double lambda[LQ_LEAVING];
} lq_leaving;

/* Rising and falling directions of both sides use the same nodes, so that light which crosses undeviated is
 * not interpolated at all. */
struct lq_rough_level {
    lq_node_axis axis;
    double divided_at; /* of nearly matched media: the critical cosine; otherwise 0 */
    double lambda[LQ_NODES_MAX];
    lq_depths depths;
    lq_facet_rule rule;
    double *travel_down, *travel_up; /* [(i * depths + from) * depths + at] */
    double *survival;                /* [depth * nodes + j]: u^Lambda */
    lq_leaving leaving[2];           /* for energy alone, and for any reward */
    double theta_from;               /* of the arrivals at grazing, where theta = (1 + Lambda)^(-1/8) */
    double *refracted_hits; /* [(arrival * depths + at) * nodes + j], arrivals at Chebyshev nodes of theta */
};

/* lq_refracted_hits of light that arrives with `lambda` at all rising nodes: hits[at * nodes + j]. */
void lq_rough_level_refracted(const lq_rough_level *level, double lambda, double *hits);

/* Node cosines (all elements together a multiple of 4), depths (too), quadrature nodes per panel of d and per
 * piece of azimuth. */
typedef struct lq_resolution {
    int nodes, depths, outer, inner;
} lq_resolution;

/* Cosines that divide the axis of a level, ascending in (0,1). */
typedef struct lq_level_splits {
    int count;
    double at[LQ_ELEMENTS_MAX];
} lq_level_splits;

/* A level of one's own, for an interface of relative index eta either way (0: light is reflected alone, and
 * lq_rough_level_refracted has no answer); its nodes are those of one element
 * of the axis. It has no leaving nodes. NULL without memory. */
lq_rough_level *lq_rough_level_make(const lq_ndf *ndf, double alpha, double eta,
                                    const lq_resolution *resolution, const lq_level_splits *splits);
void lq_rough_level_free(lq_rough_level *level); /* NULL: nothing */

/* Made when first asked for, and kept in `rough`; NULL without memory. */
const lq_rough_level *lq_rough_level_get(lq_rough *rough, double eta, int level);

#endif
