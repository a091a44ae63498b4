/* The random walk that stands for each table kind of the catalogue. */
#ifndef LACQUER_VALIDATE_WALK_KIND_H
#define LACQUER_VALIDATE_WALK_KIND_H

#include "lacquer.h"
#include "validate/walk.h"

typedef struct lq_walk_run {
    size_t samples;
    uint64_t seed, purpose; /* one purpose a point keeps their noise independent */
    int threads;            /* 0: one per core */
} lq_walk_run;

/* The coordinate of the axis called `name`, or `otherwise` where the kind has no such axis. */
double lq_kind_coordinate(const lq_kind *kind, const double *point, const char *name, double otherwise);

bool lq_walk_knows(const lq_kind *kind);

/* One mean per channel of the kind. LQ_BAD_INPUT where no walk is known for it or the point is outside. */
lq_status lq_walk_kind(const lq_kind *kind, const lq_settings *settings, const double *point,
                       const lq_walk_run *run, lq_walk_mean *values, lq_error *error);

/* Standard error to judge a difference by. Events that fewer than a few of the samples met are missing from
 * the measured error, or dominate it; an energy they change by at most 1 is uncertain by 3/samples. */
double lq_walk_noise(lq_walk_mean mean, size_t samples);

#endif
