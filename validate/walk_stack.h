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
    bool once;     /* the first hit alone: what is blocked afterwards is lost */
    double eta[2]; /* dielectric: index of the other side over that of this one */
    double n[LQ_STACK_CHANNELS], kappa[LQ_STACK_CHANNELS]; /* conductor, relative to the medium above */
    double rho[LQ_STACK_CHANNELS];                         /* diffuse */
    double alpha;
    const lq_ndf *ndf;
    bool ggx;           /* which has facets and areas in closed form; otherwise */
    lq_visible visible; /* where it is rough */
} lq_walk_interface;

typedef struct lq_traveller {
    lq_ray ray;  /* its s is the length of (x, y), its weight that of the brightest colour */
    double x, y; /* direction of travel along the interface */
    double tint[LQ_STACK_CHANNELS]; /* of each colour over that; of one colour it is not read */
    int colours;
    int side;       /* 0 above, 1 below the interface */
    long hits_left; /* 0: given up, with what it carries */
} lq_traveller;

/* From its arrival, z < 0, until it leaves on either side, z >= 0, is absorbed (weight 0) or given up. */
void lq_walk_meet(const lq_walk_interface *interface, lq_traveller *traveller, lq_stream *stream);

/* Weaken it, each colour by its own factor. */
void lq_walk_tint(lq_traveller *traveller, const double *factor);

/* A stack made ready for rays: of one channel, or of all three where they take the same ways. */
typedef struct lq_walk_pile {
    size_t count;
    int colours;
    bool from_below;
    lq_walk_interface *interface;
    double (*log_tau)[LQ_STACK_CHANNELS]; /* of the media, [count + 1]; the first is outside */
} lq_walk_pile;

/* Whether a ray's way is the same in all channels: no dielectric's index, no roughness differs. Its colours
 * are then a matter of weights. */
bool lq_walk_pile_shared(const lq_stack *stack);

/* From `channel` on, `colours` of them. Free it whatever comes back. */
lq_status lq_walk_pile_make(lq_walk_pile *pile, const lq_stack *stack, const lq_stack_query *query,
                            int channel, int colours, lq_error *error);
void lq_walk_pile_free(lq_walk_pile *pile);

/* One ray at cosine mu, until it leaves or nothing is left of it. */
typedef enum lq_fate { LQ_ABSORBED, LQ_RETURNED, LQ_THROUGH, LQ_GIVEN_UP } lq_fate;
lq_fate lq_walk_through(const lq_walk_pile *pile, double mu, lq_stream *stream, lq_traveller *traveller,
                        size_t *meetings);

#endif
