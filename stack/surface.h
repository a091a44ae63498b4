/* surface.h - what one rough interface does to any reward: its block, mode by mode.
 *
 * The two-sided solver (precompute/dielectric.h) answers for one reward at a time. Here all rewards are asked
 * at once, as functions on the cosine axes of the two media: light that leaves at its first hit goes straight
 * onto these axes, facet by facet, with the masking of each; what hits again is worth what the fixed point of
 * precompute/hits.h says, solved for a reward of 1 at each of its own rising nodes. In modes 1 and 2 a facet
 * weighs with the harmonic of the azimuth it turns light by; travel between hits is the same, since nothing
 * but a facet changes a direction.
 *
 * In mode 0 the rows of a dielectric add up to 1 at any resolution: a lossless stack is exact.
 */
#ifndef LACQUER_STACK_SURFACE_H
#define LACQUER_STACK_SURFACE_H

#include "microfacet/facets.h"
#include "precompute/dielectric.h"
#include "precompute/nodes.h"
#include "stack/block.h"
#include "stack/modes.h"

typedef struct lq_surface {
    const lq_ndf *ndf;
    double alpha;
    lq_scattering scattering; /* all orders, or the first hit alone: what is blocked then is lost */
    bool opaque;              /* a conductor or a diffuse base: there is no side 1 */
    bool diffuse;             /* Lambertian, of albedo rho */
    double eta;               /* dielectric: n of side 1 / n of side 0 */
    int materials;            /* blocks there are: 1, or bases that differ in the material alone */
    double n[LQ_STACK_CHANNELS], kappa[LQ_STACK_CHANNELS]; /* conductors: relative to side 0 */
    double rho[LQ_STACK_CHANNELS];
    const lq_node_axis *axis[2]; /* of the media on both sides */
    lq_facet_cuts sharp[2]; /* cosines of the axes at which interfaces, smooth or nearly so, make steps */
    const double *entry[2]; /* cosines at which light arrives */
    size_t entry_count[2];
    bool grazing; /* light from outside arrives along the horizon, or nearly so */
} lq_surface;

/* Levels of resolution count from 0; LQ_LEVEL_TRIAL is there to judge level 0 by. */
enum { LQ_LEVEL_TRIAL = -1, LQ_SURFACE_LEVELS = 7 };

/* One surface at one level of resolution. Its rows may be filled in any order and by any thread, then its
 * batches be solved likewise; then blocks can be had. A smooth surface has neither rows nor batches. */
typedef struct lq_surface_work lq_surface_work;

lq_status lq_surface_begin(lq_surface_work **work, const lq_surface *surface, int level, lq_error *error);
void lq_surface_end(lq_surface_work *work); /* NULL: nothing */

size_t lq_surface_rows(const lq_surface_work *work);
lq_status lq_surface_row(lq_surface_work *work, size_t row, lq_error *error);

size_t lq_surface_batches(const lq_surface_work *work);
/* LQ_NOT_CONVERGED: this level is too fine for so grazing rays. */
lq_status lq_surface_batch(lq_surface_work *work, size_t batch, lq_error *error);

/* One block a mode. */
lq_status lq_surface_blocks(const lq_surface_work *work, int material, lq_block blocks[LQ_MODES],
                            lq_error *error);

#endif
