/* sweep_state.h - what solving a sweep and reading its rows share. */
#ifndef LACQUER_PRECOMPUTE_SWEEP_STATE_H
#define LACQUER_PRECOMPUTE_SWEEP_STATE_H

#include "precompute/along.h"
#include "precompute/evaluator.h"
#include "precompute/sweep.h"

struct lq_sweep {
    lq_job job;       /* at the values of `along`, to the share of the tolerance that solves have */
    double tolerance; /* of the table */
    int threads;
    const lq_evaluator *evaluator;
    void *state;
    lq_table *shape;
    lq_along along;
    lq_parts *parts;
    const lq_crew *crew;
    size_t entries;    /* of a slice and channel */
    size_t inner;      /* of them below the slice axis, fastest */
    size_t done;       /* values of `along` that are solved */
    double *estimates; /* of each value of `along` */
};

/* A value of `along` that is a node of the table: it is kept as the table has it. */
bool lq_sweep_is_node(const lq_sweep *sweep, size_t value);

/* Its slice as a part: the estimate, then the numbers of every channel (lq_parts_make). */
lq_status lq_sweep_make_part(void *sweep, size_t value, int thread, void **bytes, size_t *size,
                             lq_error *error);

/* Of one value, positions `from` to `to` - 1 of a channel's slice. */
lq_status lq_sweep_read(const lq_sweep *sweep, size_t value, size_t channel, size_t from, size_t to,
                        double *values, lq_error *error);

/* See lq_rows_read. */
lq_status lq_sweep_read_rows(void *sweep, size_t first, size_t count, float *const *channels,
                             lq_error *error);

#endif
