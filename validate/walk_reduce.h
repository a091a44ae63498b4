/* Runs a sampling function many times on all threads and reduces to means and standard errors that do not
 * depend on the number of threads, bit for bit. */
#ifndef LACQUER_VALIDATE_WALK_REDUCE_H
#define LACQUER_VALIDATE_WALK_REDUCE_H

#include "lacquer.h"
#include "validate/stream.h"
#include "validate/walk.h"

enum { LQ_WALK_MAX_VALUES = 64 };

/* Writes the `count` numbers of one sample; `values` comes zeroed. */
typedef void lq_walk_sample(const void *context, lq_stream *stream, double *values);

lq_status lq_walk_reduce(const lq_walk *walk, lq_walk_sample *sample, const void *context, size_t count,
                         lq_walk_mean *means, lq_error *error);

/* y/x of two means and its error; `sum` is the mean of x + y, whose error tells their covariance. 0 where
 * there is no x. */
lq_walk_mean lq_walk_ratio(lq_walk_mean y, lq_walk_mean x, lq_walk_mean sum);

#endif
