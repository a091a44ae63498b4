/* What each further term of a factored table buys: bytes against error. */
#ifndef LACQUER_VALIDATE_REPORT_RANKS_H
#define LACQUER_VALIDATE_REPORT_RANKS_H

#include "validate/certificate_checks.h"

#include <stdio.h>

enum { LQ_RANKS_MAX = 12 };

typedef struct lq_rank {
    size_t terms, bytes; /* kept, of all pieces and streams; of the bases they use */
    double max, p99, rms;
} lq_rank;

/* The first terms of every sum only, in up to LQ_RANKS_MAX steps, at points of the certificate. The factors
 * were fitted for all their terms: a fit to fewer would do better than these. Returns the steps; 0 where
 * there are no factors. */
size_t lq_ranks(const lq_certified *certified, lq_rank *ranks);

/* As an <svg> element. */
lq_status lq_report_ranks(const lq_rank *ranks, size_t count, FILE *out, lq_error *error);

#endif
