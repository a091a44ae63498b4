/* The lobe of a rough mirror by single reflections: the independent check of `tir-pass` and `tir-loss`. */
#ifndef LACQUER_VALIDATE_WALK_LOBE_H
#define LACQUER_VALIDATE_WALK_LOBE_H

#include "validate/walk.h"

typedef enum lq_walk_lobe_mean {
    LQ_WALK_PASSES, /* 1 - F(cos theta, eta): eta is walk->n */
    LQ_WALK_LOST    /* sin theta > eta */
} lq_walk_lobe_mean;

/* Mean over the lobe of F = 1 at walk->mu with separable masking, normalised by its energy above the horizon.
 */
lq_status lq_walk_lobe(const lq_walk *walk, lq_walk_lobe_mean which, lq_walk_mean *mean, lq_error *error);

#endif
