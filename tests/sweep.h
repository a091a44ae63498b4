/* sweep.h - tables that are interpolated between the sweep's own nodes, against solves of one roughness each.
 */
#ifndef LACQUER_TESTS_SWEEP_H
#define LACQUER_TESTS_SWEEP_H

#include "tests/expect.h"
#include "tests/uniform.h"

#include "lacquer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A table, and how many of its roughnesses are solved alone; of each, every value is compared. */
typedef struct sweep_case {
    const char *kind, *ndf;
    const char *axes[LQ_MAX_AXES]; /* as on the command line; NULL: those of the kind */
    double tolerance;
    size_t roughnesses;
    size_t evaluated; /* random values of the table that are compared with lq_eval */
    lq_scattering scattering;
} sweep_case;

static inline lq_status sweep_table(const sweep_case *c, lq_axis *axes, double tolerance, int threads,
                                    lq_table **table) {
    lq_settings settings = lq_settings_default();
    lq_error error = {""};
    settings.tolerance = tolerance;
    settings.threads = threads;
    if (c->ndf) settings.ndf = c->ndf;
    settings.scattering = c->scattering;
    const lq_status status = lq_precompute(lq_kind_find(c->kind, NULL), &settings, axes, NULL, table, &error);
    if (!*table) print_error("%s: %s\n", c->kind, error.text);
    return status;
}

static inline void sweep_axes(const sweep_case *c, lq_axis *axes) {
    const lq_kind *kind = lq_kind_find(c->kind, NULL);
    lq_error error = {""};
    assert_int_equal(lq_kind_axes(kind, axes, &error), LQ_OK);
    for (int a = 0; a < kind->axis_count; a++)
        if (c->axes[a]) {
            lq_axis_free(&axes[a]);
            assert_int_equal(lq_axis_parse(&axes[a], kind->axes[a].name, c->axes[a], &error), LQ_OK);
        }
}

static inline int sweep_alpha(const lq_kind *kind) {
    int alpha = 0;
    while (strcmp(kind->axes[alpha].name, "alpha") != 0) alpha++;
    return alpha;
}

/* Every value of one roughness against a table of it alone, ten times as fine, and one of them against
 * lq_eval. The largest difference over what the two estimates allow. */
static inline double sweep_compare(const sweep_case *c, const lq_table *table, size_t node, size_t *points) {
    const lq_kind *kind = lq_kind_find(c->kind, NULL);
    const int alpha = sweep_alpha(kind);
    const double finer = fmax(0.4 * c->tolerance, kind->finest_tolerance);
    lq_axis axes[LQ_MAX_AXES];
    lq_table *exact = NULL;
    sweep_axes(c, axes);
    const double at = axes[alpha].nodes[node];
    lq_axis_free(&axes[alpha]);
    assert_int_equal(lq_axis_make(&axes[alpha], "alpha", at, at, 1, LQ_MAP_LINEAR, 0.0, NULL), LQ_OK);
    sweep_table(c, axes, finer, 2, &exact);
    assert_non_null(exact);
    const double allowed = atof(lq_table_fact(table, "error")) + atof(lq_table_fact(exact, "error")) + 1e-7;
    size_t inner = 1, entries = lq_table_entries(exact);
    double most = 0.0;
    for (int a = 0; a < alpha; a++) inner *= axes[a].size;
    for (int k = 0; k < kind->channel_count; k++)
        for (size_t i = 0; i < entries; i++) {
            const size_t there = (i / inner * table->axes[alpha].size + node) * inner + i % inner;
            most = fmax(most, fabs((double)table->channels[k][there] - (double)exact->channels[k][i]));
        }
    *points += entries;
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    lq_table_free(exact);
    return most / allowed;
}

/* One random value against lq_eval. */
static inline void sweep_compare_eval(const sweep_case *c, const lq_table *table, unsigned long long draw) {
    const lq_kind *kind = lq_kind_find(c->kind, NULL);
    lq_settings settings = lq_settings_default();
    double point[LQ_MAX_AXES], values[LQ_MAX_CHANNELS], estimate = 0.0;
    size_t at = 0, stride = 1;
    for (int a = 0; a < kind->axis_count; a++) {
        const size_t i = (size_t)(uniform(draw * 8 + (unsigned long long)a) * (double)table->axes[a].size);
        point[a] = table->axes[a].nodes[i];
        at += i * stride;
        stride *= table->axes[a].size;
    }
    settings.tolerance = c->tolerance;
    if (c->ndf) settings.ndf = c->ndf;
    settings.scattering = c->scattering;
    const lq_status status = lq_eval(kind, &settings, point, values, &estimate, NULL);
    assert_true(status == LQ_OK || status == LQ_NOT_CONVERGED);
    for (int k = 0; k < kind->channel_count; k++)
        assert_near((double)table->channels[k][at], values[k],
                    atof(lq_table_fact(table, "error")) + estimate + 1e-7);
}

/* The table keeps its tolerance, and random values of it their estimates; the same bits for 1 and 2 threads.
 */
/* With LACQUER_POINTS every roughness of the case is solved alone; otherwise as many as make 500 points. */
static inline void sweep_check(const sweep_case *c) {
    enum { ENOUGH = 500, FEW = 10 };
    const bool whole = getenv("LACQUER_POINTS") != NULL;
    const lq_kind *kind = lq_kind_find(c->kind, NULL);
    lq_axis axes[LQ_MAX_AXES];
    lq_table *table = NULL, *again = NULL;
    size_t points = 0;
    double most = 0.0;
    sweep_axes(c, axes);
    assert_int_equal(sweep_table(c, axes, c->tolerance, 2, &table), LQ_OK);
    if (c->tolerance >= 1e-3) assert_int_equal(sweep_table(c, axes, c->tolerance, 1, &again), LQ_OK);
    for (int k = 0; again && k < kind->channel_count; k++)
        assert_memory_equal(table->channels[k], again->channels[k], lq_table_entries(table) * sizeof(float));
    for (size_t r = 0; r < c->roughnesses && (whole || points < ENOUGH); r++) {
        const size_t size = table->axes[sweep_alpha(kind)].size;
        most = fmax(most, sweep_compare(c, table, (size_t)(uniform(r) * (double)size), &points));
    }
    const size_t evaluated = whole || c->evaluated < FEW ? c->evaluated : FEW;
    for (unsigned long long p = 0; p < evaluated; p++) sweep_compare_eval(c, table, p);
    print_message("%s, tolerance %g: %zu points, error %s, at most %.2f of what is allowed\n", c->kind,
                  c->tolerance, points, lq_table_fact(table, "error"), most);
    assert_true(points + evaluated >= ENOUGH);
    assert_true(most <= 1.0);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    lq_table_free(table);
    lq_table_free(again);
}

#endif
