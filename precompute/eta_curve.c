/* Chebyshev interpolation in ln sqrt(eta^2 - 1). */
#include "precompute/eta_curve.h"

#include "precompute/series.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Over x, and the values at its nodes. */
typedef struct solved {
    lq_series series;
    double *at_node; /* [node * count + i] */
    double estimate; /* of what was solved */
} solved;

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
static size_t plan(const lq_eta_curve *curve, const double *eta, size_t etas, lq_series *s) {
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
    return nodes <= LQ_SERIES_MAX && 4 * nodes < 3 * covered ? nodes : 0;
}

static lq_status solve_nodes(const lq_eta_curve *curve, solved *s, lq_error *error) {
    lq_status status = LQ_OK;
    s->estimate = 0.0;
    for (size_t k = 0; status == LQ_OK && k < s->series.nodes; k++) {
        double estimate = 0.0;
        status = curve->solve(curve->user, index_at(lq_series_node(&s->series, k)),
                              curve->tolerance * 2.0 / 3.0, s->at_node + k * curve->count, &estimate, error);
        s->estimate = fmax(s->estimate, estimate);
    }
    return status;
}

static void interpolate(const solved *s, size_t count, double eta, double *values) {
    double weight[LQ_SERIES_MAX];
    lq_series_weights(&s->series, position_of(eta), weight);
    memset(values, 0, count * sizeof *values);
    for (size_t k = 0; k < s->series.nodes; k++)
        for (size_t i = 0; i < count; i++) values[i] += weight[k] * s->at_node[k * count + i];
    for (size_t i = 0; i < count; i++) values[i] = fmin(fmax(values[i], 0.0), 1.0);
}

lq_status lq_eta_sweep(const lq_eta_curve *curve, const double *eta, size_t etas, double *values,
                       double *estimate, lq_error *error) {
    solved s = {.at_node = NULL};
    s.series.nodes = plan(curve, eta, etas, &s.series);
    lq_status status = LQ_OK;
    bool interpolated = s.series.nodes > 0;
    *estimate = 0.0;
    if (interpolated) {
        s.at_node = malloc(s.series.nodes * curve->count * sizeof *s.at_node);
        if (!s.at_node)
            return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values at %zu indices", curve->count,
                           s.series.nodes);
        status = solve_nodes(curve, &s, error);
        if (status == LQ_OK) {
            const double missing = lq_series_truncation(&s.series, s.at_node, curve->count, 1, curve->count);
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
