/* Which roughnesses a sweep solves, and what the series between them says of its error. */
#include "tests/expect.h"

#include "precompute/along.h"

#include <string.h>

enum { NODES = 64 };

static const double accuracy = 2e-6;

static void fill_linear(double *nodes) {
    for (int i = 0; i < NODES; i++) nodes[i] = i / (double)(NODES - 1);
}

typedef double function(double alpha, double scale);

/* Singular at alpha = i / scale, like everything that turns over cosines of alpha. */
static double smooth(double alpha, double scale) {
    return 1.0 / (1.0 + scale * scale * alpha * alpha);
}

/* Likewise, but weaker there. */
static double angle(double alpha, double scale) {
    return atan(scale * alpha);
}

static double kinked(double alpha, double scale) {
    return fabs(log(alpha) - log(scale));
}

/* The largest error at the nodes of panel 0; *missing is what the series says. */
static double error_of(const lq_along *along, function *f, double scale, double *missing) {
    double value[LQ_SERIES_MAX], weight[LQ_ALONG_POINTS], most = 0.0;
    const double *at[LQ_SERIES_MAX];
    const lq_along_panel *panel = &along->panel[0];
    size_t first;
    for (size_t k = 0; k < panel->series.nodes; k++) {
        value[k] = f(along->value[panel->first + k], scale);
        at[k] = &value[k];
    }
    *missing = lq_series_missing(&panel->series, at, 1);
    for (size_t i = panel->begin; i < panel->end; i++) {
        const size_t points = lq_along_weights(along, i, &first, weight);
        double sum = -f(along->nodes[i], scale);
        for (size_t k = 0; k < points; k++) sum += weight[k] * value[first + k - panel->first];
        most = fmax(most, fabs(sum));
    }
    return most;
}

static void test_plan(void **state) {
    (void)state;
    double nodes[NODES];
    lq_along along;
    fill_linear(nodes);
    assert_true(lq_along_plan(&along, nodes, NODES, accuracy));
    assert_true(along.panel[0].used && along.count <= 22);
    double worst = 0.0, most = 0.0;
    for (int i = 0; i < 800; i++) {
        double missing;
        const double scale = pow(10.0, -1.0 + 3.0 * (i / 2) / 399.0);
        const double error = error_of(&along, i % 2 ? smooth : angle, scale, &missing);
        if (error > missing) print_error("scale %g: error %.1e, series says %.1e\n", scale, error, missing);
        worst = fmax(worst, error / missing);
        most = fmax(most, missing);
    }
    print_message("error over what the series says: %.2f; it says %.1e at most\n", worst, most);
    assert_true(worst <= 1.0 && most <= 10.0 * accuracy);
    lq_along_free(&along);
}

/* A panel that has a kink does not hold. Refined and then dropped, it keeps what was solved. */
static void test_kink(void **state) {
    (void)state;
    double nodes[NODES], missing;
    lq_along along;
    fill_linear(nodes);
    assert_true(lq_along_plan(&along, nodes, NODES, accuracy));
    const size_t points = along.panel[0].series.nodes, before = along.count;
    const double error = error_of(&along, kinked, 0.37, &missing);
    print_message("kink: error %.1e, series says %.1e\n", error, missing);
    assert_true(missing > 100.0 * accuracy);
    lq_along_refine(&along, 0);
    assert_int_equal(along.panel[0].series.nodes, 2 * points - 1);
    for (size_t v = 0, repeated = 0; v < along.count; v++) {
        repeated += along.same[v] != v;
        assert_true(along.value[along.same[v]] == along.value[v]);
        if (v + 1 == along.count) assert_int_equal(repeated, points);
    }
    lq_along_drop(&along, 0);
    assert_true(along.count <= along.most);
    assert_int_equal(along.count, before + 2 * points - 1 + along.panel[0].end - along.panel[0].begin);
    for (size_t i = 0; i < NODES; i++) {
        double weight[LQ_ALONG_POINTS];
        size_t first;
        assert_int_equal(lq_along_weights(&along, i, &first, weight), 1);
        assert_true(along.value[first] == nodes[i] && along.node[first] == i);
    }
    lq_along_free(&along);
}

static void test_few(void **state) {
    (void)state;
    const double nodes[] = {0.0, 0.1, 0.3, 0.6, 1.0};
    lq_along along;
    assert_true(lq_along_plan(&along, nodes, 5, accuracy));
    assert_false(along.panel[0].used);
    assert_int_equal(along.count, 5);
    lq_along_free(&along);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_plan), cmocka_unit_test(test_kink),
                                       cmocka_unit_test(test_few)};
    return cmocka_run_group_tests_name("along", tests, NULL, NULL);
}
