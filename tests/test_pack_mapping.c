/* The tables of f, its inverse and sigma_g against their definitions, and what they refuse. */
#include "tests/expect.h"

#include "fit/curve.h"
#include "fit/phase.h"
#include "microfacet/lobe.h"
#include "pack/mapping.h"

#include <math.h>
#include <string.h>

static lq_table *make(const char *id, const char *nodes) {
    lq_error error = {""};
    lq_axis axis;
    lq_table *table;
    const lq_settings settings = lq_settings_default();
    const lq_kind *kind = lq_mapping_find(id, &error);
    assert_non_null(kind);
    assert_true(lq_is_mapping(kind));
    assert_int_equal(lq_axis_parse(&axis, kind->axes[0].name, nodes, &error), LQ_OK);
    assert_int_equal(lq_mapping_table(kind, &settings, &axis, &table, &error), LQ_OK);
    lq_axis_free(&axis);
    return table;
}

static double largest_departure(const lq_table *table, double (*exact)(const lq_curve *, double)) {
    lq_error error = {""};
    lq_curve curve;
    const lq_ndf *ndf;
    double worst = 0.0;
    assert_int_equal(lq_ndf_open(&ndf, "ggx", &error), LQ_OK);
    assert_int_equal(lq_curve_make(&curve, ndf, &error), LQ_OK);
    for (size_t i = 0; i < table->axes[0].size; i++)
        worst =
            fmax(worst, fabs((double)table->channels[0][i] / exact(&curve, table->axes[0].nodes[i]) - 1.0));
    lq_ndf_close(ndf);
    return worst;
}

/* From the functional equation, not from the curve that the table samples. */
static double f_of(const lq_curve *curve, double alpha) {
    double error;
    return lq_curve_limit(curve, alpha, &error);
}

/* The root of f by bisection. */
static double root_of(const lq_curve *curve, double f) {
    double low = 0.0, high = 0.99999;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        *(f_of(curve, middle) < f ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

/* The forward variance of Henyey & Greenstein (1941) by sums, then the lobe of that variance. */
static double sigma_of(const lq_curve *curve, double g) {
    enum { STEPS = 200000 };
    double squares = 0.0, all = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double mu = (i + 0.5) / STEPS, p = pow(1.0 + g * g - 2.0 * g * mu, -1.5);
        squares += p * (1.0 - mu * mu);
        all += p;
    }
    return f_of(curve, lq_lobe_roughness(curve->ndf, squares / all));
}

static void test_f(void **state) {
    (void)state;
    lq_table *table = make("f", "0.001:0.95:40");
    assert_near(largest_departure(table, f_of), 0.0, 3e-6); /* the curve is tabulated */
    assert_near((double)table->channels[0][0], 0.0, 1e-4);
    lq_table_free(table);
}

static void test_inverse(void **state) {
    (void)state;
    lq_table *table = make("f-inverse", "0.001:1000:20:power6");
    assert_near(largest_departure(table, root_of), 0.0, 1e-6);
    lq_table_free(table);
}

static void test_sigma(void **state) {
    (void)state;
    lq_table *table = make("sigma-g", "0.1:0.9:9");
    assert_near(largest_departure(table, sigma_of), 0.0, 1e-5);
    lq_table_free(table);
}

static void test_refusals(void **state) {
    (void)state;
    lq_error error = {""};
    lq_axis axis;
    lq_table *table;
    const lq_settings settings = {.ndf = "beckmann"};
    assert_null(lq_mapping_find("g", &error));
    assert_non_null(strstr(error.text, "accepted: f, f-inverse, sigma-g"));
    assert_false(lq_is_mapping(lq_kind_find("fgd", &error)));
    /* Beckmann's pole lies at 0.5: no f beyond. */
    assert_int_equal(lq_axis_parse(&axis, "alpha", "0.1:0.9:9", &error), LQ_OK);
    assert_int_equal(lq_mapping_table(lq_mapping_find("f", &error), &settings, &axis, &table, &error),
                     LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "the pole of f, alpha = 0."));
    assert_null(table);
    lq_axis_free(&axis);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_f), cmocka_unit_test(test_inverse),
                                       cmocka_unit_test(test_sigma), cmocka_unit_test(test_refusals)};
    return cmocka_run_group_tests_name("pack-mapping", tests, NULL, NULL);
}
