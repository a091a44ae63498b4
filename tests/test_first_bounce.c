/* First bounce: closed forms at alpha = 1, the furnace identity, limits, and the albedo kinds. */
#include "tests/expect.h"

#include "lacquer.h"
#include "precompute/first_bounce.h"

static const lq_ndf *ggx(void) {
    return lq_ndf_find("ggx");
}

static lq_facet_rule fine(void) {
    lq_facet_rule rule;
    lq_gauss_make(&rule.outer, 32);
    lq_gauss_make(&rule.inner, 48);
    return rule;
}

/* GGX at alpha = 1, F = 1: E(mu) = 1 - mu ln(1 + 1/mu). */
static void albedo_at_full_roughness_has_a_closed_form(void **state) {
    (void)state;
    lq_curves curves;
    lq_curves_none(&curves);
    for (double mu = 1e-6; mu <= 1.0; mu = mu < 0.5 ? mu * 3.0 : mu + 0.1) {
        double energy;
        const double estimate =
            lq_first_bounce_converged(ggx(), 1.0, LQ_CORRELATED, &mu, 1, &curves, 1e-7, &energy);
        assert_near(energy, 1.0 - mu * log1p(1.0 / mu), estimate);
        assert_true(estimate <= 1e-7);
    }
}

static void what_leaves_and_what_remains_add_up(void **state) {
    (void)state;
    lq_curves curves;
    lq_curves_conductor(&curves, 0.0, 1.0);
    const lq_facet_rule rule = fine();
    for (double alpha = 1e-6; alpha <= 1.0; alpha *= 10.0)
        for (double mu = 0.0; mu <= 1.0; mu += 0.125) {
            double leaves[2], remains[2];
            lq_first_bounce(ggx(), alpha, LQ_CORRELATED, mu, &curves, &rule, leaves, remains);
            assert_near(leaves[0] + remains[0], 1.0, 1e-14);
            assert_near(leaves[1], 0.0, 1e-15); /* n = 0 absorbs nothing */
        }
}

/* Small roughness: E -> 1 away from grazing; at mu = x alpha it has a limit that depends on x alone. */
static void small_roughness_has_its_limits(void **state) {
    (void)state;
    lq_curves curves;
    lq_curves_none(&curves);
    double at_scale[2];
    for (int i = 0; i < 2; i++) {
        const double alpha = i ? 1e-5 : 1e-4, mu[] = {0.5, alpha};
        double energy[2];
        lq_first_bounce_converged(ggx(), alpha, LQ_CORRELATED, mu, 2, &curves, 1e-8, energy);
        assert_near(energy[0], 1.0, 2.0 * alpha * alpha + 1e-8);
        at_scale[i] = energy[1];
    }
    assert_near(at_scale[0], at_scale[1], 2e-4);
    assert_true(at_scale[0] < 0.95);
}

static double eval(const char *id, lq_masking masking, const double *point, int channel) {
    lq_settings settings = lq_settings_default();
    lq_error error = {""};
    double values[LQ_MAX_CHANNELS], estimate;
    settings.masking = masking;
    const lq_kind *kind = lq_kind_find(id, &error);
    assert_int_equal(lq_eval(kind, &settings, point, values, &estimate, &error), LQ_OK);
    assert_true(estimate <= kind->tolerance);
    return values[channel];
}

/* Mean of E over the hemisphere at alpha = 1: 4 (1 - ln 2) / 3. */
static void average_at_full_roughness_has_a_closed_form(void **state) {
    (void)state;
    const double alpha = 1.0;
    assert_near(eval("albedo-average", LQ_CORRELATED, &alpha, 0), 4.0 * (1.0 - log(2.0)) / 3.0, 1e-6);
    const double smooth = 0.0;
    assert_near(eval("albedo-average", LQ_CORRELATED, &smooth, 0), 1.0, 0.0);
}

static void split_sum_adds_up_to_the_albedo(void **state) {
    (void)state;
    for (double alpha = 0.0; alpha <= 1.0; alpha += 0.2)
        for (double mu = 0.0; mu <= 1.0; mu += 0.25) {
            const double point[] = {mu, alpha};
            const double a = eval("dfg", LQ_CORRELATED, point, 0), b = eval("dfg", LQ_CORRELATED, point, 1);
            assert_near(a + b, eval("albedo", LQ_CORRELATED, point, 0), 2e-6);
            assert_true(a >= 0.0 && b >= 0.0);
        }
    const double smooth[] = {0.5, 0.0};
    assert_near(eval("dfg", LQ_CORRELATED, smooth, 0), 1.0 - pow(0.5, 5.0), 1e-15);
}

/* 1/(1+Lambda_o) is never above (1+Lambda_i)/(1+Lambda_i+Lambda_o). */
static void separable_masking_loses_more(void **state) {
    (void)state;
    for (double mu = 0.05; mu < 0.99; mu += 0.17) {
        const double point[] = {mu, 0.6};
        assert_true(eval("albedo", LQ_SEPARABLE, point, 0) < eval("albedo", LQ_CORRELATED, point, 0));
    }
    const double straight[] = {1.0, 0.6}; /* Lambda_i = 0: the two are one */
    assert_near(eval("albedo", LQ_SEPARABLE, straight, 0), eval("albedo", LQ_CORRELATED, straight, 0), 2e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedo_at_full_roughness_has_a_closed_form),
        cmocka_unit_test(what_leaves_and_what_remains_add_up),
        cmocka_unit_test(small_roughness_has_its_limits),
        cmocka_unit_test(average_at_full_roughness_has_a_closed_form),
        cmocka_unit_test(split_sum_adds_up_to_the_albedo),
        cmocka_unit_test(separable_masking_loses_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
