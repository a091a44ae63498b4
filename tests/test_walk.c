/* Random walks: published values, identities that hold exactly, hard cases, independence of the threads. */
#include "validate/walk.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { SAMPLES = 200000 };

/* Inside four standard errors of the walk and of the reference together. */
static void assert_agrees(lq_walk_mean got, double want, double want_error, const char *what, double x) {
    const double allowed = 4.0 * hypot(got.error, want_error) + 1e-12;
    if (!(fabs(got.mean - want) <= allowed))
        fail_msg("%s at %g: %.7f +- %.1e, expected %.7f +- %.1e", what, x, got.mean, got.error, want,
                 want_error);
}

static void assert_energy(lq_walk_mean e) {
    assert_true(e.mean >= 0.0 && e.mean <= 1.0 + 1e-12);
    assert_true(e.error >= 0.0 && isfinite(e.error));
}

static lq_walk_mean reflect(const lq_walk *walk) {
    lq_walk_mean energy = {NAN, NAN};
    assert_int_equal(lq_walk_reflect(walk, &energy, NULL, 0, NULL), LQ_OK);
    return energy;
}

static lq_walk_sides two_sided(const lq_walk *walk) {
    lq_walk_sides sides = {0};
    assert_int_equal(lq_walk_two_sided(walk, &sides, NULL), LQ_OK);
    return sides;
}

static lq_walk walk_of(double mu, double alpha) {
    lq_walk walk = lq_walk_default();
    walk.mu = mu;
    walk.alpha = alpha;
    walk.samples = SAMPLES;
    return walk;
}

static lq_walk conductor(double mu, double alpha, double n, double kappa) {
    lq_walk walk = walk_of(mu, alpha);
    walk.fresnel = LQ_WALK_CONDUCTOR;
    walk.n = n;
    walk.kappa = kappa;
    return walk;
}

static lq_walk dielectric(double mu, double alpha, double eta) {
    lq_walk walk = walk_of(mu, alpha);
    walk.fresnel = LQ_WALK_DIELECTRIC;
    walk.n = eta;
    return walk;
}

static lq_walk constant(double mu, double alpha, double f) {
    lq_walk walk = walk_of(mu, alpha);
    walk.f0 = walk.f90 = f;
    return walk;
}

/* Light of the base of a coating: index eta from above, so 1/eta seen from inside. */
static lq_walk base_light(double alpha, double eta, double tau) {
    lq_walk walk = dielectric(1.0, alpha, 1.0 / eta);
    walk.cosine = true;
    walk.tau_near = tau;
    return walk;
}

/* Independent walks of 2e7 samples at (n, kappa) = (0.2, 3.9). */
static void test_conductor_values(void **state) {
    (void)state;
    static const double alphas[3] = {0.05, 0.3, 1.0}, mus[3] = {0.05, 0.4, 0.95};
    static const double values[3][3] = {
        {0.96123, 0.94330, 0.95173}, {0.94501, 0.93688, 0.94393}, {0.94117, 0.91441, 0.89007}};
    for (int a = 0; a < 3; a++)
        for (int m = 0; m < 3; m++) {
            const lq_walk walk = conductor(mus[m], alphas[a], 0.2, 3.9);
            assert_agrees(reflect(&walk), values[a][m], 1e-5, "conductor", mus[m]);
        }
}

/* GGX at alpha 1 with constant F: E1 = F (1 - mu ln(1 + 1/mu)), and all orders. */
static void test_constant_reflectance(void **state) {
    (void)state;
    static const double mus[3] = {0.05, 0.5, 0.999};
    static const double all[2][4] = {{0.46007, 0.33053, 0.26845, 0.31143},
                                     {0.88505, 0.82655, 0.79101, 0.81521}};
    for (int k = 0; k < 2; k++) {
        const double f = k == 0 ? 0.5 : 0.9;
        for (int m = 0; m < 3; m++) {
            const lq_walk walk = constant(mus[m], 1.0, f);
            lq_walk_mean energy, first;
            assert_int_equal(lq_walk_reflect(&walk, &energy, &first, 1, NULL), LQ_OK);
            assert_agrees(energy, all[k][m], 5e-6, "constant F", mus[m]);
            assert_agrees(first, f * (1.0 - mus[m] * log1p(1.0 / mus[m])), 0.0, "first order", mus[m]);
        }
        lq_walk mean = constant(0.0, 1.0, f);
        mean.cosine = true;
        lq_walk_mean energy, first;
        assert_int_equal(lq_walk_reflect(&mean, &energy, &first, 1, NULL), LQ_OK);
        assert_agrees(energy, all[k][3], 5e-6, "constant F, mean", f);
        assert_agrees(first, f * 4.0 * (1.0 - log(2.0)) / 3.0, 0.0, "first order, mean", f);
    }
}

static void test_orders(void **state) {
    (void)state;
    static const double energies[7] = {0.3069, 0.3225, 0.2117, 0.1025, 0.0395, 0.0126, 0.0035};
    const lq_walk walk = constant(1.0, 1.0, 1.0);
    lq_walk_mean energy, orders[LQ_WALK_MAX_ORDERS];
    assert_int_equal(lq_walk_reflect(&walk, &energy, orders, LQ_WALK_MAX_ORDERS, NULL), LQ_OK);
    for (int i = 0; i < 7; i++) assert_agrees(orders[i], energies[i], 3e-5, "order", i + 1);
    assert_agrees(orders[1], 3.14159265358979 * 3.14159265358979 / 12.0 - 0.5, 0.0, "second order", 1.0);
    double sum = 0.0;
    for (int i = 0; i < LQ_WALK_MAX_ORDERS; i++) sum += orders[i].mean;
    assert_true(fabs(sum - energy.mean) < 1e-4);
}

static void test_furnace_is_exact(void **state) {
    (void)state;
    static const double alphas[] = {0.0, 1e-4, 1e-3, 0.1, 0.5, 1.0}, mus[] = {0.0, 1e-6, 0.05, 0.5, 1.0};
    for (size_t a = 0; a < 6; a++)
        for (size_t m = 0; m < 5; m++) {
            lq_walk walk = constant(mus[m], alphas[a], 1.0);
            walk.samples = 2000;
            const lq_walk_mean energy = reflect(&walk);
            assert_true(energy.mean == 1.0 && energy.error == 0.0);
        }
}

static void test_dielectric_values(void **state) {
    (void)state;
    static const double alphas[2] = {0.3, 1.0}, mus[3] = {0.05, 0.4, 0.95};
    static const double above[2][3] = {{0.1773, 0.0808, 0.0371}, {0.0823, 0.0332, 0.0160}};
    static const double below[2][3] = {{0.9821, 0.8965, 0.1752}, {0.9877, 0.7596, 0.4149}};
    for (int a = 0; a < 2; a++)
        for (int m = 0; m < 3; m++) {
            const lq_walk down = dielectric(mus[m], alphas[a], 1.5);
            const lq_walk up = dielectric(mus[m], alphas[a], 1.0 / 1.5);
            const lq_walk_sides r01 = two_sided(&down), r10 = two_sided(&up);
            assert_agrees(r01.reflected, above[a][m], 1e-4, "R01", mus[m]);
            assert_agrees(r10.reflected, below[a][m], 1e-4, "R10", mus[m]);
            assert_true(fabs(r01.reflected.mean + r01.transmitted.mean - 1.0) < 1e-13);
            assert_true(fabs(r10.reflected.mean + r10.transmitted.mean - 1.0) < 1e-13);
        }
}

/* Walsh: cosine-weighted reflectance of a smooth dielectric. */
static void test_smooth_dielectric(void **state) {
    (void)state;
    static const double values[6][2] = {{1.1, 0.0251573574}, {1.33, 0.0659308493}, {1.5, 0.0917779593},
                                        {2.0, 0.1605966371}, {2.5, 0.2218665735},  {4.0, 0.3666380565}};
    for (int i = 0; i < 6; i++) {
        lq_walk walk = dielectric(1.0, 0.0, values[i][0]);
        walk.cosine = true;
        assert_agrees(two_sided(&walk).reflected, values[i][1], 0.0, "Walsh", values[i][0]);
    }
}

static void test_base_light(void **state) {
    (void)state;
    static const double smooth[3][3] = {
        {0.9, 0.35806443, 0.37406352}, {0.5, 0.18380126, 0.04744152}, {0.1, 0.03004046, 0.00042305}};
    for (int i = 0; i < 3; i++) {
        const lq_walk walk = base_light(0.0, 1.5, smooth[i][0]);
        const lq_walk_sides sides = two_sided(&walk);
        assert_agrees(sides.transmitted, smooth[i][1], 0.0, "T10", smooth[i][0]);
        assert_agrees(sides.reflected, smooth[i][2], 0.0, "R10", smooth[i][0]);
    }
    static const double spread[4][2] = {{0.0, 0.478350}, {0.1, 0.48454}, {0.5, 0.49575}, {1.0, 0.49725}};
    for (int i = 0; i < 4; i++) {
        const lq_walk walk = base_light(spread[i][0], 1.5, 1.0);
        assert_agrees(two_sided(&walk).transmitted_sin2, spread[i][1], 5e-6, "variance", spread[i][0]);
    }
    const lq_walk denser_air = base_light(0.0, 1.0 / 1.5, 1.0);
    assert_agrees(two_sided(&denser_air).transmitted_sin2, 0.212600, 5e-7, "variance", 1.0 / 1.5);
}

/* R10 = 1 - (1 - R01)/eta^2 between cosine-weighted means: reciprocity, at any roughness. */
static void test_reciprocity(void **state) {
    (void)state;
    static const double alphas[3] = {0.05, 0.4, 1.0};
    for (int i = 0; i < 3; i++) {
        lq_walk outside = dielectric(1.0, alphas[i], 1.5);
        outside.cosine = true;
        const lq_walk inside = base_light(alphas[i], 1.5, 1.0);
        const lq_walk_mean r01 = two_sided(&outside).reflected;
        assert_agrees(two_sided(&inside).reflected, 1.0 - (1.0 - r01.mean) / 2.25, r01.error / 2.25, "R10",
                      alphas[i]);
    }
}

/* A path at cosine c costs tau^(1/c): a smooth interface at one angle says exactly how much. */
static void test_absorption(void **state) {
    (void)state;
    lq_walk walk = dielectric(0.6, 0.0, 1.5);
    const lq_walk_sides clear = two_sided(&walk);
    walk.tau_far = 0.3;
    const double cos_t = sqrt(1.0 - 0.64 / 2.25);
    assert_true(fabs(two_sided(&walk).transmitted.mean - clear.transmitted.mean * pow(0.3, 1.0 / cos_t)) <
                1e-12);
    walk.tau_far = 1.0;
    walk.tau_near = 0.3;
    const lq_walk_sides near = two_sided(&walk);
    assert_true(fabs(near.transmitted.mean - clear.transmitted.mean * pow(0.3, 1.0 / 0.6)) < 1e-12);
    assert_true(fabs(near.reflected.mean - clear.reflected.mean * pow(0.3, 2.0 / 0.6)) < 1e-12);
    walk.alpha = 0.5;
    walk.tau_near = walk.tau_far = 0.0;
    const lq_walk_sides black = two_sided(&walk);
    assert_true(black.reflected.mean == 0.0 && black.transmitted.mean == 0.0);
}

/* One hit at alpha 1, F = 1, mu = 1. Separable masking there is 1/(1 + L_o) over a uniform hemisphere of
 * outgoing light, half of it below the horizon, and 1 + L_o = (1 + 1/c)/2, so E = 1 - ln 2; correlated is the
 * first order of the walk. */
static void test_single_scattering(void **state) {
    (void)state;
    const lq_walk walk = constant(1.0, 1.0, 1.0);
    lq_walk_mean e;
    assert_int_equal(lq_walk_single(&walk, LQ_SEPARABLE, &e, NULL), LQ_OK);
    assert_agrees(e, 1.0 - log(2.0), 0.0, "separable", 1.0);
    for (int i = 1; i < 5; i++) {
        const lq_walk tilted = constant(0.25 * i, 0.2 * i, 1.0);
        lq_walk_mean all, first;
        assert_int_equal(lq_walk_single(&tilted, LQ_CORRELATED, &e, NULL), LQ_OK);
        assert_int_equal(lq_walk_reflect(&tilted, &all, &first, 1, NULL), LQ_OK);
        assert_agrees(e, first.mean, first.error, "correlated", tilted.mu);
    }
}

/* F = F0 A + F90 B: the pieces of dfg add up to the albedo. */
static void test_schlick_pieces(void **state) {
    (void)state;
    lq_walk walk = walk_of(0.3, 0.6);
    lq_walk_mean a, b, e;
    walk.f90 = 0.0;
    assert_int_equal(lq_walk_single(&walk, LQ_CORRELATED, &a, NULL), LQ_OK);
    walk.f0 = 0.0;
    walk.f90 = 1.0;
    assert_int_equal(lq_walk_single(&walk, LQ_CORRELATED, &b, NULL), LQ_OK);
    walk.f0 = 1.0;
    assert_int_equal(lq_walk_single(&walk, LQ_CORRELATED, &e, NULL), LQ_OK);
    assert_true(fabs(a.mean + b.mean - e.mean) < 1e-12);
}

static void test_threads_do_not_matter(void **state) {
    (void)state;
    lq_walk one = conductor(0.3, 0.5, 0.2, 3.9), two = one;
    one.samples = two.samples = 54321;
    one.threads = 1;
    two.threads = 3;
    const lq_walk_mean a = reflect(&one), b = reflect(&two);
    assert_memory_equal(&a, &b, sizeof a);
    one.fresnel = two.fresnel = LQ_WALK_DIELECTRIC;
    one.n = two.n = 1.5;
    const lq_walk_sides c = two_sided(&one), d = two_sided(&two);
    assert_memory_equal(&c, &d, sizeof c);
    two.seed = 2;
    assert_true(reflect(&two).mean != a.mean);
}

static void test_smooth_is_analytic(void **state) {
    (void)state;
    const lq_walk silver = conductor(1.0, 0.0, 0.2, 3.9);
    const lq_walk_mean e = reflect(&silver);
    assert_true(fabs(e.mean - (0.64 + 15.21) / (1.44 + 15.21)) < 1e-15 && e.error == 0.0);
    const lq_walk rough = conductor(1.0, 1e-4, 0.2, 3.9);
    assert_agrees(reflect(&rough), e.mean, 1e-7, "alpha 1e-4", 1.0);
}

/* Corners of the parameter space: smooth, grazing, nearly matched, opaque. */
static void test_hard_cases(void **state) {
    (void)state;
    static const double alphas[] = {0.0, 1e-4, 1e-3, 0.1, 1.0}, mus[] = {0.0, 1e-6, 1e-3, 1.0};
    static const double indices[][2] = {{0.2, 0.0},  {0.5, 1e-6}, {1.0, 0.0},
                                        {1.5, 10.0}, {0.0, 0.0},  {0.0, 3.0}};
    static const double etas[] = {0.25, 1.0 / 1.5, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 4.0};
    for (size_t a = 0; a < 5; a++)
        for (size_t m = 0; m < 4; m++)
            for (size_t k = 0; k < 6; k++) {
                lq_walk walk = conductor(mus[m], alphas[a], indices[k][0], indices[k][1]);
                walk.samples = 500;
                assert_energy(reflect(&walk));
                lq_walk_mean single;
                assert_int_equal(lq_walk_single(&walk, LQ_CORRELATED, &single, NULL), LQ_OK);
                assert_energy(single);
                walk = dielectric(mus[m], alphas[a], etas[k]);
                walk.samples = 500;
                walk.tau_far = 0.5;
                const lq_walk_sides sides = two_sided(&walk);
                assert_energy(sides.reflected);
                assert_energy(sides.transmitted);
                assert_true(isfinite(sides.reflected_sin2.mean) && isfinite(sides.transmitted_sin2.error));
                if (etas[k] == 1.0) assert_true(sides.reflected.mean == 0.0);
            }
}

static void test_bad_input(void **state) {
    (void)state;
    lq_walk_mean e;
    lq_walk_sides sides;
    lq_error error;
    lq_walk walk = walk_of(0.5, 1.5);
    assert_int_equal(lq_walk_reflect(&walk, &e, NULL, 0, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "alpha"));
    walk = walk_of(NAN, 0.5);
    assert_int_equal(lq_walk_single(&walk, LQ_CORRELATED, &e, &error), LQ_BAD_INPUT);
    walk = walk_of(0.5, 0.5);
    assert_int_equal(lq_walk_two_sided(&walk, &sides, &error), LQ_BAD_INPUT);
    walk.samples = 0;
    assert_int_equal(lq_walk_reflect(&walk, &e, NULL, 0, &error), LQ_BAD_INPUT);
    walk.samples = 1;
    assert_int_equal(lq_walk_reflect(&walk, &e, NULL, 0, &error), LQ_OK);
    assert_true(isinf(e.error));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_conductor_values),
        cmocka_unit_test(test_constant_reflectance),
        cmocka_unit_test(test_orders),
        cmocka_unit_test(test_furnace_is_exact),
        cmocka_unit_test(test_dielectric_values),
        cmocka_unit_test(test_smooth_dielectric),
        cmocka_unit_test(test_base_light),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_absorption),
        cmocka_unit_test(test_single_scattering),
        cmocka_unit_test(test_schlick_pieces),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_smooth_is_analytic),
        cmocka_unit_test(test_hard_cases),
        cmocka_unit_test(test_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
