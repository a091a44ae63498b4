/* Chebyshev interpolation of many values at once over one coordinate, both ends included among the nodes. */
#ifndef LACQUER_PRECOMPUTE_SERIES_H
#define LACQUER_PRECOMPUTE_SERIES_H

#include <stddef.h>

enum { LQ_SERIES_MIN = 7, LQ_SERIES_MAX = 64 };

typedef struct lq_series {
    size_t nodes; /* 4 to LQ_SERIES_MAX */
    double from, to;
} lq_series;

/* How many nodes over a length leave out no more than `accuracy` of a function of size 1 whose singularities
 * lie pi / 2 off the real axis: coefficient m falls like rho^-m, rho + i the sum of half axes of the ellipse
 * through them (T13, ch. 8). May exceed LQ_SERIES_MAX. */
size_t lq_series_points(double length, double accuracy);

double lq_series_node(const lq_series *series, size_t k);

/* Barycentric weights of the nodes at x; where x is a node, that node alone. */
void lq_series_weights(const lq_series *series, double x, double *weight);

/* What the coefficients that were not computed may add up to, the largest of `count` values: at_node[k *
 * stride + i * step] at node k. From the last three coefficients, one of which may vanish by chance. */
double lq_series_truncation(const lq_series *series, const double *at_node, size_t stride, size_t step,
                            size_t count);

/* The same of values that lie apart, at_node[k][i] value i at node k, and of all of them together: from the
 * largest of the last three coefficients, and of the three before, which might be more by chance. For
 * functions without kinks: of one it says too little. At least LQ_SERIES_MIN nodes. */
double lq_series_missing(const lq_series *series, const double *const *at_node, size_t count);

/* The same in steps, of values that are not all there at once: the largest of the last three coefficients and
 * of the three before, starting from {0}. */
typedef struct lq_series_tail {
    double older, newer;
} lq_series_tail;

void lq_series_tail_add(lq_series_tail *tail, const lq_series *series, const double *const *at_node,
                        size_t count);
double lq_series_tail_missing(const lq_series_tail *tail);

#endif
