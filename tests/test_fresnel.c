/* Fresnel reflectance: closed forms, limits and the hard cases where a literal formula fails. */
#include "microfacet/fresnel.h"
#include "tests/expect.h"

#include "microfacet/gauss.h"

#include <complex.h>

static double normal_incidence(double n, double kappa) {
    return ((n - 1) * (n - 1) + kappa * kappa) / ((n + 1) * (n + 1) + kappa * kappa);
}

static void normal_incidence_has_its_closed_form(void **state) {
    (void)state;
    const double index[][2] = {{0.2, 3.9},  {1.5, 0.0}, {1.5, 1e-6}, {4.0, 10.0},
                               {0.25, 0.0}, {0.0, 1.0}, {1.0, 1e-6}};
    for (size_t i = 0; i < sizeof index / sizeof index[0]; i++) {
        const double want = normal_incidence(index[i][0], index[i][1]);
        assert_near(lq_fresnel_conductor(1.0, index[i][0], index[i][1]) / want, 1.0, 1e-12);
    }
}

/* The literal complex formula, for angles and indices where it does not cancel. */
static double literal(double c, double n, double kappa) {
    const double complex eps = (n + I * kappa) * (n + I * kappa), w = csqrt(eps - (1 - c * c));
    const double rs = cabs((c - w) / (c + w)), rp = cabs((eps * c - w) / (eps * c + w));
    return 0.5 * (rs * rs + rp * rp);
}

static void agrees_with_the_literal_formula(void **state) {
    (void)state;
    for (double n = 0.1; n < 4; n += 0.37)
        for (double kappa = 0.1; kappa < 10; kappa *= 1.7)
            for (double c = 0.02; c <= 1; c += 0.07)
                assert_near(lq_fresnel_conductor(c, n, kappa), literal(c, n, kappa), 1e-13);
}

static void no_absorption_is_the_dielectric(void **state) {
    (void)state;
    const double eta[] = {0.25, 0.7, 1 - 1e-6, 1.0, 1 + 1e-6, 1.33, 4.0};
    for (size_t i = 0; i < sizeof eta / sizeof eta[0]; i++)
        for (double c = 0.0; c <= 1.0; c += 0.01)
            assert_near(lq_fresnel_conductor(c, eta[i], 0.0), lq_fresnel_dielectric(c, eta[i], NULL), 1e-13);
}

/* Cosine-weighted external reflectance of a smooth dielectric (Walsh 1926). */
static void cosine_weighted_mean_is_walsh(void **state) {
    (void)state;
    const double want[][2] = {{1.1, .0251573574}, {1.33, .0659308493}, {1.5, .0917779593},
                              {2.0, .1605966371}, {2.5, .2218665735},  {4.0, .3666380565}};
    lq_gauss rule;
    lq_gauss_make(&rule, 64);
    for (size_t i = 0; i < sizeof want / sizeof want[0]; i++) {
        double mean = 0.0;
        for (int q = 0; q < rule.count; q++) {
            const double mu = rule.node[q] * rule.node[q];
            mean +=
                rule.weight[q] * 2.0 * rule.node[q] * 2.0 * mu * lq_fresnel_dielectric(mu, want[i][0], NULL);
        }
        assert_near(mean, want[i][1], 1e-10);
    }
}

static void refraction_obeys_snell_and_is_reciprocal(void **state) {
    (void)state;
    for (double eta = 0.25; eta <= 4.0; eta *= 1.19)
        for (double c = 0.01; c <= 1.0; c += 0.045) {
            double cos_t;
            const double r = lq_fresnel_dielectric(c, eta, &cos_t);
            if (cos_t == 0.0) {
                assert_true(r == 1.0);
                continue;
            }
            assert_near((1 - c * c) / (eta * eta), 1 - cos_t * cos_t, 1e-13);
            assert_near(lq_fresnel_dielectric(cos_t, 1 / eta, NULL), r, 1e-11);
        }
}

static void hard_cases_stay_in_range(void **state) {
    (void)state;
    const double index[] = {0.0, 1e-6, 0.25, 1 - 1e-6, 1.0, 1 + 1e-6, 4.0, 100.0};
    const double kappas[] = {0.0, 1e-6, 0.01, 1.0, 10.0, 100.0};
    const double cosines[] = {0.0, 1e-300, 1e-6, 0.5, 1.0};
    for (size_t i = 0; i < 8; i++)
        for (size_t k = 0; k < 6; k++)
            for (size_t c = 0; c < 5; c++) {
                const double r = lq_fresnel_conductor(cosines[c], index[i], kappas[k]);
                assert_true(r >= 0.0 && r <= 1.0);
            }
    assert_true(lq_fresnel_conductor(0.0, 1.0, 0.0) == 0.0);
    assert_true(lq_fresnel_dielectric(0.3, 1.0, NULL) == 0.0);
    assert_true(lq_fresnel_conductor(0.0, 1.5, 0.3) == 1.0);
    assert_near(lq_fresnel_conductor(0.4, 0.0, 2.0), 1.0, 1e-15);
    /* Nearly matched: R = delta^2 / 4 at normal incidence, lost by a literal 1 - n. */
    assert_near(lq_fresnel_dielectric(1.0, 1 + 1e-6, NULL) / 2.5e-13, 1.0, 2e-6);
}

static void the_critical_angle_is_a_singularity_on_the_axis(void **state) {
    (void)state;
    lq_fresnel_singularity found[2];
    lq_fresnel_singularities(0.7, 0.0, found);
    assert_near(sin(found[0].angle), 0.7, 1e-12);
    assert_true(found[0].distance < 1e-12);
    lq_fresnel_singularities(0.7, 0.1, found);
    assert_true(found[0].distance > 0.05 && found[0].distance < 0.2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_incidence_has_its_closed_form),
        cmocka_unit_test(agrees_with_the_literal_formula),
        cmocka_unit_test(no_absorption_is_the_dielectric),
        cmocka_unit_test(cosine_weighted_mean_is_walsh),
        cmocka_unit_test(refraction_obeys_snell_and_is_reciprocal),
        cmocka_unit_test(hard_cases_stay_in_range),
        cmocka_unit_test(the_critical_angle_is_a_singularity_on_the_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
