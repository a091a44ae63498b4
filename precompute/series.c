/* Chebyshev points of the second kind: weights, and what the tail of the series says (T13, ch. 5
 * and 8). */
#include "precompute/series.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double lq_series_node(const lq_series *s, size_t k) {
    const double middle = 0.5 * (s->from + s->to), half = 0.5 * (s->to - s->from);
    return middle - half * cos(pi * (double)k / (double)(s->nodes - 1));
}

size_t lq_series_points(double length, double accuracy) {
    const double s = pi / fmax(length, 1e-3), rho = s + sqrt(1.0 + s * s);
    return (size_t)fmax(ceil(1.0 - log(accuracy) / log(rho)), LQ_SERIES_MIN);
}

void lq_series_weights(const lq_series *s, double x, double *weight) {
    double sum = 0.0;
    const size_t last = s->nodes - 1;
    for (size_t k = 0; k <= last; k++) {
        const double gap = x - lq_series_node(s, k), end = k == 0 || k == last ? 0.5 : 1.0;
        if (fabs(gap) < 1e-13 * (1.0 + fabs(x))) {
            for (size_t l = 0; l <= last; l++) weight[l] = l == k ? 1.0 : 0.0;
            return;
        }
        weight[k] = (k % 2 ? -end : end) / gap;
        sum += weight[k];
    }
    for (size_t k = 0; k <= last; k++) weight[k] /= sum;
}

/* Coefficient m of one value, but for its sign. */
static double coefficient(const lq_series *s, const double *at_node, size_t stride, size_t m) {
    const size_t last = s->nodes - 1;
    double sum = 0.0;
    for (size_t k = 0; k <= last; k++) {
        const double end = k == 0 || k == last ? 0.5 : 1.0;
        sum += end * cos(pi * (double)((k * m) % (2 * last)) / (double)last) * at_node[k * stride];
    }
    return 2.0 / (double)last * sum;
}

double lq_series_truncation(const lq_series *s, const double *at_node, size_t stride, size_t step,
                            size_t count) {
    double most = 0.0;
    for (size_t i = 0; i < count; i++)
        for (size_t m = s->nodes - 3; m < s->nodes; m++)
            most = fmax(most, (m == s->nodes - 1 ? 0.5 : 1.0) *
                                  fabs(coefficient(s, at_node + i * step, stride, m)));
    return 2.0 * most;
}

/* Weights of the nodes in coefficient m. */
static void coefficient_weights(const lq_series *s, size_t m, double weight[LQ_SERIES_MAX]) {
    const size_t last = s->nodes - 1;
    for (size_t k = 0; k <= last; k++) {
        const double end = k == 0 || k == last ? 0.5 : 1.0;
        weight[k] = (m == last ? 1.0 : 2.0) / (double)last * end *
                    cos(pi * (double)((k * m) % (2 * last)) / (double)last);
    }
}

static double largest_coefficient(const lq_series *s, const double *const *at_node, size_t count, size_t m) {
    double weight[LQ_SERIES_MAX], most = 0.0;
    coefficient_weights(s, m, weight);
    for (size_t i = 0; i < count; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < s->nodes; k++) sum += weight[k] * at_node[k][i];
        most = fmax(most, fabs(sum));
    }
    return most;
}

void lq_series_tail_add(lq_series_tail *tail, const lq_series *s, const double *const *at_node,
                        size_t count) {
    enum { RUN = 3 };
    for (size_t m = s->nodes - 2 * RUN; m < s->nodes; m++) {
        double *run = m + RUN < s->nodes ? &tail->older : &tail->newer;
        *run = fmax(*run, largest_coefficient(s, at_node, count, m));
    }
}

/* The last run may be small by chance, all of it: three coefficients fade by 8 where rho is 2. What does not
 * fade is the noise of the values. */
double lq_series_tail_missing(const lq_series_tail *tail) {
    const double older = tail->older, newer = tail->newer;
    const double fading = older > 0.0 ? fmin(fmax(newer / older, 1.0 / 8.0), 1.0) : 1.0;
    return 2.0 * fading * fmax(newer, older / 8.0);
}

double lq_series_missing(const lq_series *s, const double *const *at_node, size_t count) {
    lq_series_tail tail = {0.0, 0.0};
    lq_series_tail_add(&tail, s, at_node, count);
    return lq_series_tail_missing(&tail);
}
