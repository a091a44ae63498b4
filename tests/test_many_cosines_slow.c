/* Many cosines of one interface are interpolated: against one solve each, and their estimate. */
#include "tests/expect.h"

#include "lacquer.h"

#include <stdlib.h>

enum { COSINES = 200, STEP = 29 };

static void check(const char *id, double from, double alpha, double eta, double tau) {
    lq_error error = {""};
    lq_axis axes[LQ_MAX_AXES];
    lq_table *table;
    lq_settings settings = lq_settings_default();
    const lq_kind *kind = lq_kind_find(id, &error);
    const double at[] = {0.0, alpha, eta, tau};
    assert_int_equal(lq_axis_make(&axes[0], "mu", from, 1.0, COSINES, LQ_MAP_LINEAR, 0.0, &error), LQ_OK);
    for (int a = 1; a < kind->axis_count; a++)
        assert_int_equal(
            lq_axis_make(&axes[a], kind->axes[a].name, at[a], at[a], 1, LQ_MAP_LINEAR, 0.0, &error), LQ_OK);
    settings.tolerance = 1e-4;
    assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &table, &error), LQ_OK);
    const double estimate = atof(lq_table_fact(table, "error"));
    settings.tolerance = 1e-6;
    double worst = 0.0;
    for (size_t i = 0; i < COSINES; i += STEP) {
        const double point[] = {axes[0].nodes[i], alpha, eta, tau};
        double value, own;
        const lq_status status = lq_eval(kind, &settings, point, &value, &own, &error);
        assert_true(status == LQ_OK || status == LQ_NOT_CONVERGED);
        const double off = fabs((double)table->channels[0][i] - value);
        worst = fmax(worst, off);
        assert_true(off <= estimate + own + 1e-7);
    }
    print_message("%s alpha %g eta %g from %g: %.1e, estimate %.1e\n", id, alpha, eta, from, worst, estimate);
    assert_true(estimate <= 1e-4);
    assert_near(worst, 0.0, 3e-5);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    lq_table_free(table);
}

static void test_reflection(void **state) {
    (void)state;
    const double alphas[] = {0.02, 0.3, 1.0}, etas[] = {1.05, 4.0};
    for (int a = 0; a < 3; a++)
        for (int e = 0; e < 2; e++) check("fgd-dielectric", 0.02, alphas[a], etas[e], 1.0);
}

/* Down to grazing, where masking goes with mu ln mu and the series may not hold. */
static void test_grazing(void **state) {
    (void)state;
    check("fgd-dielectric", 0.0, 0.1, 1.5, 1.0);
    check("fgd-dielectric", 0.0, 1.0, 1.5, 1.0);
}

static void test_transmission(void **state) {
    (void)state;
    check("transmission", 0.02, 0.05, 1.5, 0.3);
    check("transmission", 0.02, 0.5, 1.1, 0.02);
}

/* From the denser side there is a step, and no interpolation. */
static void test_denser(void **state) {
    (void)state;
    check("fgd-dielectric", 0.02, 0.1, 0.66, 1.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_reflection), cmocka_unit_test(test_grazing),
                                       cmocka_unit_test(test_transmission), cmocka_unit_test(test_denser)};
    return cmocka_run_group_tests_name("many-cosines", tests, NULL, NULL);
}
