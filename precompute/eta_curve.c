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
    double *at_node[LQ_SERIES_MAX];
    double estimate; /* of what was solved */
} solved;

/* What interpolation may leave out at least: sweep.c says why so little. */
static const double INTERPOLATION = 0.3;

/* Coefficient m of the series is this times rho^-m and less. */
static const double SCALE = 5.0;

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
    const size_t nodes = lq_series_points(s->to - s->from, INTERPOLATION * curve->tolerance / SCALE);
    return nodes <= LQ_SERIES_MAX && nodes < covered ? nodes : 0;
}

static lq_status solve_node(const lq_eta_curve *curve, solved *s, size_t k, lq_error *error) {
    double estimate = 0.0;
    s->at_node[k] = malloc(curve->count * sizeof *s->at_node[k]);
    if (!s->at_node[k]) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", curve->count);
    const lq_status status =
        curve->solve(curve->user, index_at(lq_series_node(&s->series, k)),
                     curve->tolerance * (1.0 - INTERPOLATION), s->at_node[k], &estimate, error);
    s->estimate = fmax(s->estimate, estimate);
    return status;
}

static lq_status solve_nodes(const lq_eta_curve *curve, solved *s, lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t k = 0; status == LQ_OK && k < s->series.nodes; k++)
        if (!s->at_node[k]) status = solve_node(curve, s, k, error);
    return status;
}

/* Twice as many nodes less one, every other one of which is there. */
static void refine(solved *s) {
    for (size_t k = s->series.nodes; k-- > 1;) {
        s->at_node[2 * k] = s->at_node[k];
        s->at_node[2 * k - 1] = NULL;
    }
    s->series.nodes = 2 * s->series.nodes - 1;
}

/* Nodes until the series holds, or none are left where it does not pay any more. */
static lq_status settle(const lq_eta_curve *curve, solved *s, size_t most, double *estimate,
                        lq_error *error) {
    while (s->series.nodes > 0) {
        const lq_status status = solve_nodes(curve, s, error);
        if (status != LQ_OK) return status;
        const double missing = lq_series_missing(&s->series, (const double *const *)s->at_node, curve->count);
        *estimate = s->estimate + missing;
        if (missing <= fmax(INTERPOLATION * curve->tolerance, curve->tolerance - s->estimate)) return LQ_OK;
        if (2 * s->series.nodes - 1 > LQ_SERIES_MAX || s->series.nodes - 1 >= most) s->series.nodes = 0;
        else refine(s);
    }
    *estimate = 0.0;
    return LQ_OK;
}

static void interpolate(const solved *s, size_t count, double eta, double *values) {
    double weight[LQ_SERIES_MAX];
    lq_series_weights(&s->series, position_of(eta), weight);
    memset(values, 0, count * sizeof *values);
    for (size_t k = 0; k < s->series.nodes; k++)
        for (size_t i = 0; i < count; i++) values[i] += weight[k] * s->at_node[k][i];
    for (size_t i = 0; i < count; i++) values[i] = fmin(fmax(values[i], 0.0), 1.0);
}

lq_status lq_eta_sweep(const lq_eta_curve *curve, const double *eta, size_t etas, double *values,
                       double *estimate, lq_error *error) {
    solved s = {.estimate = 0.0};
    s.series.nodes = plan(curve, eta, etas, &s.series);
    lq_status status = settle(curve, &s, etas, estimate, error);
    for (size_t e = 0; status == LQ_OK && e < etas; e++) {
        double *at = values + e * curve->count, one = 0.0;
        if (s.series.nodes > 0 && is_covered(curve, eta[e])) interpolate(&s, curve->count, eta[e], at);
        else status = curve->solve(curve->user, eta[e], curve->tolerance, at, &one, error);
        *estimate = fmax(*estimate, one);
    }
    for (size_t k = 0; k < LQ_SERIES_MAX; k++) free(s.at_node[k]);
    return status;
}
