/* Error metrics of a list of numbers against a reference, and whether noise explains the difference. */
#ifndef LACQUER_VALIDATE_COMPARE_H
#define LACQUER_VALIDATE_COMPARE_H

#include "lacquer.h"

typedef struct lq_compared {
    double value, reference;
    double allowance; /* how far apart the two may be by their own statement: tolerance, rounding */
    double noise;     /* standard error of their difference; 0: none */
} lq_compared;

/* d is value - reference. The score z of a point is what exceeds the allowance, in standard errors:
 * z = sign(d) (|d| - allowance)+ / noise. Where everything is in order |z| is at most a normal deviate. */
double lq_compared_score(const lq_compared *point);

typedef struct lq_comparison {
    size_t count;
    double max, rms, mean, p99; /* of |d|, d^2, d and |d|: largest, root mean square, bias, percentile */
    size_t worst;               /* the point of `max` */
    double z_max;               /* largest |z| */
    size_t z_worst;             /* the point of `z_max` */
    double z2;                  /* mean z^2: at most 1 is expected, 1 where noise dominates */
    double z_bias;           /* sum of z / sqrt(count): a normal deviate, large where errors share a sign */
    size_t beyond4;          /* points with |z| > 4 */
    double beyond4_expected; /* at most this many are, on average */
    double z_limit;          /* what |z| and |z_bias| may reach by chance */
    bool explained;          /* they do not exceed it */
} lq_comparison;

/* `comparisons`: how many numbers are looked at in the whole report; z_limit accounts for all of them. */
lq_status lq_compare(const lq_compared *points, size_t count, size_t comparisons, lq_comparison *result,
                     lq_error *error);

/* The chance of a false alarm over one whole report: that any of its normal deviates exceeds z_limit. */
#define LQ_FALSE_ALARM 1e-4

/* |z| that one of `comparisons` normal deviates exceeds with probability LQ_FALSE_ALARM (Bonferroni). */
double lq_z_limit(size_t comparisons);

/* Two tables over the same axes, channel by channel, entry by entry. */
lq_status lq_compare_tables(const lq_table *table, const lq_table *reference, int channel,
                            lq_comparison *result, lq_error *error);

#endif
