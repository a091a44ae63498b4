/* tir-pass and tir-loss: limits, identities, plain quadrature, the random walk, hard cases, honest estimates.
 */
#include "tests/expect.h"

#include "lacquer.h"
#include "microfacet/fresnel.h"
#include "precompute/angle_lobe.h"
#include "validate/stream.h"
#include "validate/walk_kind.h"

#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static double eval_at(const char *id, double mu, double alpha, double eta, double tolerance,
                      double *estimate) {
    lq_settings settings = lq_settings_default();
    lq_error error = {""};
    const double point[] = {mu, alpha, eta};
    double value;
    settings.tolerance = tolerance;
    const lq_status status = lq_eval(lq_kind_find(id, &error), &settings, point, &value, estimate, &error);
    assert_true(status == LQ_OK || status == LQ_NOT_CONVERGED);
    assert_true(value >= 0.0 && value <= 1.0);
    return value;
}

static double pass(double mu, double alpha, double eta) {
    double estimate;
    return eval_at("tir-pass", mu, alpha, eta, 0.0, &estimate);
}

static double loss(double mu, double alpha, double eta) {
    double estimate;
    return eval_at("tir-loss", mu, alpha, eta, 0.0, &estimate);
}

/* ------------------------------------------------------------------------------------- limits */

static void a_smooth_base_is_the_mirror_direction(void **state) {
    (void)state;
    for (double mu = 0.0; mu <= 1.0; mu += 0.125)
        for (double eta = 0.0625; eta < 1.0; eta += 0.0625) {
            assert_near(pass(mu, 0.0, eta), 1.0 - lq_fresnel_dielectric(mu, eta, NULL), 0.0);
            assert_near(loss(mu, 0.0, eta), sqrt(1.0 - mu * mu) > eta ? 1.0 : 0.0, 0.0);
        }
    /* and is approached */
    assert_near(pass(0.8, 1e-5, 0.7), pass(0.8, 0.0, 0.7), 1e-4);
    assert_near(loss(0.6, 1e-5, 0.7), 1.0, 1e-4);
    assert_near(loss(0.9, 1e-5, 0.7), 0.0, 1e-4);
}

static void equal_media_pass_everything_and_no_medium_nothing(void **state) {
    (void)state;
    for (double alpha = 0.0; alpha <= 1.0; alpha += 0.25)
        for (double mu = 0.0; mu <= 1.0; mu += 0.25) {
            assert_near(pass(mu, alpha, 1.0), 1.0, 0.0);
            assert_near(loss(mu, alpha, 1.0), 0.0, 0.0);
            assert_near(pass(mu, alpha, 0.0), 0.0, 0.0);
            assert_near(loss(mu, alpha, 0.0), 1.0, 0.0);
        }
}

static void both_change_one_way_with_the_index(void **state) {
    (void)state;
    for (double alpha = 0.05; alpha <= 1.0; alpha += 0.19)
        for (double mu = 0.0; mu <= 1.0; mu += 0.2)
            for (double eta = 0.05; eta < 0.95; eta += 0.05) {
                assert_true(loss(mu, alpha, eta + 0.05) <= loss(mu, alpha, eta) + 2e-5);
                assert_true(pass(mu, alpha, eta + 0.05) >= pass(mu, alpha, eta) - 2e-5);
                assert_true(pass(mu, alpha, 1.0 / (eta + 0.05)) >= pass(mu, alpha, 1.0 / eta) - 2e-5);
                /* what passes is below the critical angle */
                assert_true(pass(mu, alpha, eta) <= 1.0 - loss(mu, alpha, eta) + 2e-5);
            }
}

/* ------------------------------------------------------------------------- against other ways */

/* The whole lobe is the separable albedo: integral of D(h)/4 G = sigma E. Another quadrature gives that one.
 */
static void its_energy_is_the_albedo(void **state) {
    (void)state;
    static const double alphas[] = {1e-6, 1e-4, 1e-2, 0.1, 0.4, 1.0},
                        cosines[] = {0.0, 1e-6, 1e-3, 0.05, 0.5, 1.0};
    const lq_ndf *ggx = lq_ndf_find("ggx");
    lq_angle_lobe *lobe = malloc(sizeof *lobe);
    lq_angle_lobe_rule rule;
    lq_angle_lobe_rule_make(&rule, 32, 24);
    for (size_t a = 0; a < 6; a++)
        for (size_t m = 0; m < 6; m++) {
            lq_settings settings = lq_settings_default();
            const double mu = cosines[m], alpha = alphas[a], point[] = {mu, alpha};
            double albedo, estimate;
            lq_error error = {""};
            settings.masking = LQ_SEPARABLE;
            settings.tolerance = 1e-8;
            lq_eval(lq_kind_find("albedo", &error), &settings, point, &albedo, &estimate, &error);
            lq_angle_lobe_make(lobe, ggx, alpha, mu, &rule);
            const double sigma = lq_area_above(ggx, alpha, mu, lq_sine(mu));
            assert_near(lq_angle_lobe_total(lobe) / sigma, albedo, 1e-7 + estimate);
        }
    free(lobe);
}

typedef struct plain_sums {
    double energy, passed, lost;
} plain_sums;

/* GGX written out, one outgoing direction at a time: midpoints in angle and azimuth between two angles. */
static void add_plain(double mu, double alpha, double eta, double from, double to, plain_sums *sums) {
    enum { ANGLES = 600, AZIMUTHS = 600 };
    const double s = sqrt(1.0 - mu * mu), a2 = alpha * alpha;
    for (int i = 0; i < ANGLES; i++) {
        const double theta = from + (to - from) * (i + 0.5) / ANGLES, so = sin(theta), co = cos(theta);
        const double lambda = 0.5 * (sqrt(1.0 + a2 * so * so / (co * co)) - 1.0);
        const double passed = 1.0 - lq_fresnel_dielectric(co, eta, NULL);
        for (int j = 0; j < AZIMUTHS; j++) {
            const double x = s + so * cos(pi * (j + 0.5) / AZIMUTHS), y = so * sin(pi * (j + 0.5) / AZIMUTHS);
            const double z = mu + co, cos2 = z * z / (x * x + y * y + z * z), q = cos2 * (a2 - 1.0) + 1.0;
            const double w = (to - from) / ANGLES * so * a2 / (q * q) / (1.0 + lambda) / AZIMUTHS;
            sums->energy += w;
            sums->passed += w * passed;
            if (so > eta) sums->lost += w;
        }
    }
}

static void plain_quadrature_agrees(void **state) {
    (void)state;
    static const double points[][3] = {
        {0.5, 0.5, 0.7}, {0.9, 0.3, 0.6},   {0.05, 0.4, 0.9},
        {1.0, 1.0, 0.5}, {0.3, 0.25, 0.25}, {0.0, 0.6, 0.8},
    };
    for (size_t i = 0; i < 6; i++) {
        const double mu = points[i][0], alpha = points[i][1], eta = points[i][2], critical = asin(eta);
        plain_sums sums = {0.0, 0.0, 0.0};
        add_plain(mu, alpha, eta, 0.0, critical, &sums);
        add_plain(mu, alpha, eta, critical, 0.5 * pi, &sums);
        assert_near(pass(mu, alpha, eta), sums.passed / sums.energy, 6e-5);
        assert_near(loss(mu, alpha, eta), sums.lost / sums.energy, 2e-5);
    }
}

static void the_walk_agrees(void **state) {
    (void)state;
    static const double points[][3] = {
        {0.5, 0.5, 0.7}, {0.02, 0.1, 0.95}, {1.0, 0.01, 0.01}, {0.7, 0.03, 0.71}};
    for (size_t i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++) {
            lq_error error = {""};
            const char *id = k ? "tir-loss" : "tir-pass";
            const lq_settings settings = lq_settings_default();
            const lq_walk_run run = {.samples = 200000, .seed = 11, .purpose = i};
            lq_walk_mean mean;
            double estimate;
            assert_int_equal(
                lq_walk_kind(lq_kind_find(id, &error), &settings, points[i], &run, &mean, &error), LQ_OK);
            const double value = eval_at(id, points[i][0], points[i][1], points[i][2], 0.0, &estimate);
            assert_near(value, mean.mean, 4.5 * lq_walk_noise(mean, run.samples) + estimate);
            assert_true(mean.error < 2e-3);
        }
}

/* --------------------------------------------------------------------------------- hard cases */

static void hard_cases_converge(void **state) {
    (void)state;
    static const double alphas[] = {0.0, 1e-7, 1e-4, 1e-3, 0.3, 1.0}, cosines[] = {0.0, 1e-6, 1e-3, 0.3, 1.0};
    static const double etas[] = {0.0, 1e-6, 0.01, 0.25, 0.6, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 1.5, 4.0};
    for (size_t a = 0; a < 6; a++)
        for (size_t m = 0; m < 5; m++)
            for (size_t e = 0; e < 10; e++) {
                double estimate;
                eval_at("tir-pass", cosines[m], alphas[a], etas[e], 0.0, &estimate);
                assert_true(estimate <= 1e-5);
                if (etas[e] > 1.0) continue;
                eval_at("tir-loss", cosines[m], alphas[a], etas[e], 0.0, &estimate);
                assert_true(estimate <= 1e-5);
            }
}

/* Below 1e-8 the lobe is taken as a mirror's; next to the critical angle that is not known to be right. */
static void an_unresolved_lobe_says_so(void **state) {
    (void)state;
    double estimate;
    eval_at("tir-loss", 0.8, 1e-9, 0.6, 0.0, &estimate);
    assert_true(estimate > 0.5);
    eval_at("tir-loss", 0.9, 1e-9, 0.6, 0.0, &estimate);
    assert_true(estimate < 1e-6);
}

/* Half of them with a small roughness, and of those many with the lobe on the critical angle. */
static void estimates_cover_the_truth(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 400; i++) {
        lq_stream stream = lq_stream_open(5, 1, i);
        const char *id = i % 2 ? "tir-loss" : "tir-pass";
        const double mu = lq_stream_uniform(&stream), u = lq_stream_uniform(&stream);
        const double alpha = i % 4 < 2 ? pow(10.0, -4.0 * u) : u;
        const double sharp = sqrt(1.0 - mu * mu) + 2.0 * alpha * (lq_stream_uniform(&stream) - 0.5);
        const double eta = i % 8 < 4 ? fmin(fmax(sharp, 0.0), 1.0) : lq_stream_uniform(&stream);
        double coarse, fine;
        const double value = eval_at(id, mu, alpha, eta, 1e-4, &coarse);
        const double truth = eval_at(id, mu, alpha, eta, 1e-8, &fine);
        assert_near(value, truth, coarse + fine);
        assert_true(coarse <= 1e-4 && fine <= 1e-8);
    }
}

static void a_table_says_which_convention_it_is(void **state) {
    (void)state;
    lq_axis axes[3];
    lq_error error = {""};
    lq_axis_make(&axes[0], "mu", 0.0, 1.0, 3, LQ_MAP_LINEAR, 0.0, &error);
    lq_axis_make(&axes[1], "alpha", 0.0, 1.0, 3, LQ_MAP_LINEAR, 0.0, &error);
    lq_axis_make(&axes[2], "eta", 0.0, 1.0, 3, LQ_MAP_LINEAR, 0.0, &error);
    const lq_settings settings = lq_settings_default();
    lq_table *table;
    for (int k = 0; k < 2; k++) {
        const char *id = k ? "tir-loss" : "tir-pass";
        assert_int_equal(lq_precompute(lq_kind_find(id, &error), &settings, axes, NULL, &table, &error),
                         LQ_OK);
        assert_string_equal(lq_table_fact(table, "table"), id);
        assert_non_null(strstr(lq_table_fact(table, "usage"), k ? "r += TIR t" : "r21 += (1 - TIR) t21"));
        assert_near((double)table->channels[0][1 + 3 * (1 + 3 * 1)],
                    k ? loss(0.5, 0.5, 0.5) : pass(0.5, 0.5, 0.5), 1e-7);
        lq_table_free(table);
    }
    for (int a = 0; a < 3; a++) lq_axis_free(&axes[a]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_smooth_base_is_the_mirror_direction),
        cmocka_unit_test(equal_media_pass_everything_and_no_medium_nothing),
        cmocka_unit_test(both_change_one_way_with_the_index),
        cmocka_unit_test(its_energy_is_the_albedo),
        cmocka_unit_test(plain_quadrature_agrees),
        cmocka_unit_test(the_walk_agrees),
        cmocka_unit_test(hard_cases_converge),
        cmocka_unit_test(an_unresolved_lobe_says_so),
        cmocka_unit_test(estimates_cover_the_truth),
        cmocka_unit_test(a_table_says_which_convention_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
