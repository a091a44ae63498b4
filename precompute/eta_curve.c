/* Chebyshev interpolation in ln sqrt(eta^2 - 1). */
#include "precompute/eta_curve.h"

#include "tables/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { NODES_MAX = 64 };

/* The nodes, both ends included, and the values there. */
typedef struct series {
    size_t nodes;
    double from, to; /* of x */
    double *at_node; /* [node * count + i] */
    double estimate; /* of what was solved */
} series;

static double position_of(double eta) {
    return 0.5 * log((eta - 1.0) * (eta + 1.0));
}

static double index_at(double x) {
    return sqrt(1.0 + exp(2.0 * x));
}

static bool is_covered(const lq_eta_curve *curve, double eta) {
    return eta >= curve->from;
}

/* How many nodes, or 0 where it does not pay. */
static size_t plan(const lq_eta_curve *curve, const double *eta, size_t etas, series *s) {
    size_t covered = 0;
    for (size_t e = 0; e < etas; e++) {
        if (!is_covered(curve, eta[e])) continue;
        const double x = position_of(eta[e]);
        s->from = covered ? fmin(s->from, x) : x;
        s->to = covered ? fmax(s->to, x) : x;
        covered++;
    }
    if (covered == 0) return 0;
    const size_t nodes = (size_t)ceil(5.0 + 5.0 * (s->to - s->from));
    return nodes <= NODES_MAX && 4 * nodes < 3 * covered ? nodes : 0;
}

static double node_x(const series *s, size_t k) {
    const double middle = 0.5 * (s->from + s->to), half = 0.5 * (s->to - s->from);
    return middle - half * cos(pi * (double)k / (double)(s->nodes - 1));
}

static lq_status solve_nodes(const lq_eta_curve *curve, series *s, lq_error *error) {
    lq_status status = LQ_OK;
    s->estimate = 0.0;
    for (size_t k = 0; status == LQ_OK && k < s->nodes; k++) {
        double estimate = 0.0;
        status = curve->solve(curve->user, index_at(node_x(s, k)), curve->tolerance * 2.0 / 3.0,
                              s->at_node + k * curve->count, &estimate, error);
        s->estimate = fmax(s->estimate, estimate);
    }
    return status;
}

/* Coefficient m of the Chebyshev series of value i, but for its sign. */
static double coefficient(const series *s, size_t count, size_t i, size_t m) {
    const size_t last = s->nodes - 1;
    double sum = 0.0;
    for (size_t k = 0; k <= last; k++) {
        const double end = k == 0 || k == last ? 0.5 : 1.0;
        sum += end * cos(pi * (double)((k * m) % (2 * last)) / (double)last) * s->at_node[k * count + i];
    }
    return 2.0 / (double)last * sum;
}

/* What the coefficients that were not computed may add up to, from the last three, one of which may vanish by
 * chance. */
static double truncation(const series *s, size_t count) {
    double most = 0.0;
    for (size_t i = 0; i < count; i++)
        for (size_t m = s->nodes - 3; m < s->nodes; m++)
            most = fmax(most, (m == s->nodes - 1 ? 0.5 : 1.0) * fabs(coefficient(s, count, i, m)));
    return 2.0 * most;
}

/* Barycentric weights of the nodes at x; where x is a node, that node alone. */
static void node_weights(const series *s, double x, double *weight) {
    double sum = 0.0;
    const size_t last = s->nodes - 1;
    for (size_t k = 0; k <= last; k++) {
        const double gap = x - node_x(s, k), end = k == 0 || k == last ? 0.5 : 1.0;
        if (fabs(gap) < 1e-13 * (1.0 + fabs(x))) {
            for (size_t l = 0; l <= last; l++) weight[l] = l == k ? 1.0 : 0.0;
            return;
        }
        weight[k] = (k % 2 ? -end : end) / gap;
        sum += weight[k];
    }
    for (size_t k = 0; k <= last; k++) weight[k] /= sum;
}

static void interpolate(const series *s, size_t count, double eta, double *values) {
    double weight[NODES_MAX];
    node_weights(s, position_of(eta), weight);
    memset(values, 0, count * sizeof *values);
    for (size_t k = 0; k < s->nodes; k++)
        for (size_t i = 0; i < count; i++) values[i] += weight[k] * s->at_node[k * count + i];
    for (size_t i = 0; i < count; i++) values[i] = fmin(fmax(values[i], 0.0), 1.0);
}

lq_status lq_eta_sweep(const lq_eta_curve *curve, const double *eta, size_t etas, double *values,
                       double *estimate, lq_error *error) {
    series s = {0};
    s.nodes = plan(curve, eta, etas, &s);
    lq_status status = LQ_OK;
    bool interpolated = s.nodes > 0;
    *estimate = 0.0;
    if (interpolated) {
        s.at_node = malloc(s.nodes * curve->count * sizeof *s.at_node);
        if (!s.at_node)
            return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values at %zu indices", curve->count,
                           s.nodes);
        status = solve_nodes(curve, &s, error);
        if (status == LQ_OK) {
            const double missing = truncation(&s, curve->count);
            interpolated = missing <= curve->tolerance / 3.0;
            if (interpolated) *estimate = s.estimate + missing;
        }
    }
    for (size_t e = 0; status == LQ_OK && e < etas; e++) {
        double *at = values + e * curve->count, one = 0.0;
        if (interpolated && is_covered(curve, eta[e])) interpolate(&s, curve->count, eta[e], at);
        else status = curve->solve(curve->user, eta[e], curve->tolerance, at, &one, error);
        *estimate = fmax(*estimate, one);
    }
    free(s.at_node);
    return status;
}
