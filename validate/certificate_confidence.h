/* How sure a sample of clustered points is: effective sample size, and exact binomial limits. */
#ifndef LACQUER_VALIDATE_CERTIFICATE_CONFIDENCE_H
#define LACQUER_VALIDATE_CERTIFICATE_CONFIDENCE_H

#include <stddef.h>

/* Confidence of every limit in a certificate, one-sided. */
#define LQ_CONFIDENCE 0.95

/* The share of a population may be as large as this where `hits` of `count` independent draws have a property
 * (Clopper & Pearson 1934); both may be fractions, as effective sizes are. */
double lq_share_limit(double hits, double count, double confidence);

/* Points come in blocks that share coordinates. With hits[b] points of block b having a property: how many
 * independent points would estimate its share as well (Korn & Graubard 1998). At most all points; as many as
 * there are blocks where no block differs from another. */
double lq_effective_points(const size_t *hits, size_t blocks, size_t per_block);

/* Of n independent errors in ascending order, the rank (from 0) that the quantile `share` lies below with the
 * confidence; n where no rank does. */
double lq_quantile_rank(double n, double share, double confidence);

#endif
