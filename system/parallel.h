/* parallel.h - the one parallel loop. */
#ifndef LACQUER_SYSTEM_PARALLEL_H
#define LACQUER_SYSTEM_PARALLEL_H

#include "lacquer.h"

/* One turn of a loop: turn `index`, run by thread `thread` (0 <= thread < lq_parallel_threads), which is the
 * only one of that number at a time and may so own scratch memory. */
typedef lq_status lq_turn(void *user, size_t index, int thread, lq_error *error);

/* The threads a loop of `count` turns runs on: `threads` (0: one per core, or what OMP_NUM_THREADS says),
 * never more than turns, and 1 inside another loop. */
int lq_parallel_threads(size_t count, int threads);

/* Run turns 0 to count - 1, handed out in that order. After a failure no new turn starts, and status and
 * message are those of the lowest turn that failed: the same for any number of threads, as long as turns do
 * not depend on each other. LQ_NOT_CONVERGED is no failure: every turn still runs, and it is the loop's
 * status if nothing fails. `progress` (may be NULL) gets the fraction of turns done; LQ_CANCELLED where it
 * asks to stop. */
lq_status lq_parallel(size_t count, int threads, lq_turn *turn, void *user, const lq_progress *progress,
                      lq_error *error);

/* What loops of the calling thread that are given 0 threads run on, from here on; 0: as before. Returns what
 * it was, to be set again. The number belongs to that thread, not to the process. */
int lq_threads_set(int threads);

#endif
