/* GMRES (Saad & Schultz 1986, algorithm 4), eight systems at once, one a lane, or one whose vectors fill the
 * lanes.
 *
 * A fixed-point iteration needs as many passes as light has hits, and an interpolation that overshoots by a
 * hair makes it grow; a Krylov space holds the answer after a fraction of the passes, in either case.
 */
#ifndef LACQUER_PRECOMPUTE_KRYLOV_H
#define LACQUER_PRECOMPUTE_KRYLOV_H

#include "precompute/kernels.h"

#include <stdbool.h>

/* out = M x, vectors of the system's size. */
typedef void lq_krylov_apply(void *user, const lq_v8 *x, lq_v8 *out);

/* Solve x = M x + b from the guess in x, with at most `most` products with M. Returns what is left: the
 * largest residual over the lanes, a 2-norm, over the largest norm of b. Negative without memory. `joined`:
 * the lanes are one system. */
double lq_krylov_solve(lq_krylov_apply *apply, void *user, size_t size, bool joined, const lq_v8 *b, lq_v8 *x,
                       int most, double tolerance);

#endif
