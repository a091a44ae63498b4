/* Chebyshev interpolation of many values at once over one coordinate, both ends included among the nodes. */
#ifndef LACQUER_PRECOMPUTE_SERIES_H
#define LACQUER_PRECOMPUTE_SERIES_H

#include <stddef.h>

enum { LQ_SERIES_MAX = 64 };

typedef struct lq_series {
    size_t nodes; /* 4 to LQ_SERIES_MAX */
    double from, to;
} lq_series;

double lq_series_node(const lq_series *series, size_t k);

/* Barycentric weights of the nodes at x; where x is a node, that node alone. */
void lq_series_weights(const lq_series *series, double x, double *weight);

/* What the coefficients that were not computed may add up to, the largest of `count` values: at_node[k *
 * stride + i * step] at node k. From the last three coefficients, one of which may vanish by chance. */
double lq_series_truncation(const lq_series *series, const double *at_node, size_t stride, size_t step,
                            size_t count);

#endif
