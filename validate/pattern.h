/* Does the difference of two tables over the same nodes look like noise, bias, or nodes placed otherwise?
 *
 * Noise of independent samples is uncorrelated from node to node; a bias is smooth. A table whose nodes were
 * meant for other coordinates (i/N, cell centres) agrees better with the reference looked up there.
 */
#ifndef LACQUER_VALIDATE_PATTERN_H
#define LACQUER_VALIDATE_PATTERN_H

#include "lacquer.h"

/* Other places where node i of N may have been sampled, in cells of the axis as read, i/(N-1). */
typedef enum lq_sampling {
    LQ_SAMPLED_CENTRES, /* (i + 1/2)/N */
    LQ_SAMPLED_STARTS,  /* i/N */
    LQ_SAMPLED_ENDS,    /* (i + 1)/N */
    LQ_SAMPLED_UP,      /* half a cell up */
    LQ_SAMPLED_DOWN,    /* half a cell down */
    LQ_SAMPLINGS
} lq_sampling;

const char *lq_sampling_name(lq_sampling sampling);

typedef enum lq_verdict {
    LQ_AGREES,    /* no entry is off by more than the allowance */
    LQ_SPOTS,     /* at most one entry in a hundred is off, by far more than all the others */
    LQ_MISPLACED, /* another sampling halves the rms */
    LQ_NOISE,     /* uncorrelated, mean 0 */
    LQ_OFFSET,    /* uncorrelated around a mean that is not 0 */
    LQ_SHARED,    /* correlated, but the mean is no larger than so few independent errors explain: noise of
                   * samples that neighbours share, or a bias of either sign */
    LQ_BIAS       /* correlated, and of one sign */
} lq_verdict;

/* A few words for a report. */
const char *lq_verdict_text(lq_verdict verdict);

typedef struct lq_pattern {
    size_t spots;    /* isolated wrong entries, see LQ_SPOTS */
    size_t zeros;    /* entries that are exactly 0 where the reference is not, by far */
    size_t zero_at;  /* the first of them */
    size_t outliers; /* entries beyond 8 rms, left out of all below but `sampled` */
    double rms, mean;
    double correlation[LQ_MAX_AXES]; /* of neighbours along each axis; 0 on axes of one node */
    double shared;                   /* the same over all axes: the part of the variance neighbours share */
    double independent;              /* about how many independent errors the table holds */
    double z_mean;                   /* the mean in standard errors of that many */
    double read_rms;                 /* rms as read, outliers included */
    double sampled[LQ_MAX_AXES][LQ_SAMPLINGS]; /* rms were that axis sampled so */
    int best_axis;                             /* where `sampled` is smallest, -1: nowhere below read_rms */
    lq_sampling best_sampling;
    lq_verdict verdict;
} lq_pattern;

/* Entries of `table` minus `reference`, one channel of each, over the axes of `table`. */
lq_status lq_pattern_of(const lq_table *table, const lq_table *reference, int channel, double allowance,
                        lq_pattern *pattern, lq_error *error);

#endif
