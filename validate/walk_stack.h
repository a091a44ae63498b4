/* walk_stack.h - single rays through a layered stack, interface by interface (lq_stack_walk).
 *
 * Directions are kept in three dimensions. Their z belongs to the interface at hand and to the side of it
 * that the ray is on: positive is away from it, so that both sides of every interface run the same code (H16,
 * the flipped frame); x and y are those of the stack, with the light travelling to +x.
 */
#ifndef LACQUER_VALIDATE_WALK_STACK_H
#define LACQUER_VALIDATE_WALK_STACK_H

#include "validate/sample_visible.h"
#include "validate/stream.h"
#include "validate/walk_ray.h"

#include <stdbool.h>

typedef struct lq_walk_interface {
    bool opaque, diffuse; /* neither: a dielectric; opaque alone: a conductor */
    bool rough;
    bool once;       /* the first hit alone: what is blocked afterwards is lost */
    double eta[2];   /* dielectric: index of the other side over that of this one */
    double n, kappa; /* conductor, relative to the medium above */
    double rho;      /* diffuse */
    double alpha;
    const lq_ndf *ndf;
    lq_visible visible; /* where it is rough */
} lq_walk_interface;

typedef struct lq_traveller {
    lq_ray ray;     /* its s is the length of (x, y) */
    double x, y;    /* direction of travel along the interface */
    int side;       /* 0 above, 1 below the interface */
    long hits_left; /* 0: given up, with what it carries */
} lq_traveller;

/* From its arrival, z < 0, until it leaves on either side, z >= 0, is absorbed (weight 0) or given up. */
void lq_walk_meet(const lq_walk_interface *interface, lq_traveller *traveller, lq_stream *stream);

#endif
