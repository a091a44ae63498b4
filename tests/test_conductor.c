/* FGD-infinity of conductors: published values, the furnace, orders of scattering, every hard case. */
#include "tests/expect.h"

#include "lacquer.h"
#include "microfacet/fresnel.h"
#include "precompute/conductor.h"
#include "precompute/kernels.h"

static const lq_ndf *ggx(void) {
    return lq_ndf_find("ggx");
}

static double eval_at(double mu, double alpha, double n, double kappa, double tolerance) {
    lq_settings settings = lq_settings_default();
    lq_error error = {""};
    settings.tolerance = tolerance;
    const double point[] = {mu, alpha, n, kappa};
    double value, estimate;
    const lq_status status =
        lq_eval(lq_kind_find("fgd", &error), &settings, point, &value, &estimate, &error);
    if (status != LQ_OK) fail_msg("mu %g alpha %g n %g kappa %g: %s", mu, alpha, n, kappa, error.text);
    assert_true(value >= 0.0 && value <= 1.0);
    assert_true(estimate <= tolerance);
    return value;
}

/* Random walks of 2e7 samples, sigma about 1e-5, made once with an independent program. */
static void random_walks_of_a_metal(void **state) {
    (void)state;
    const double want[][3] = {{.05, .05, .96123}, {.4, .05, .94330}, {.95, .05, .95173},
                              {.05, .3, .94501},  {.4, .3, .93688},  {.95, .3, .94393},
                              {.05, 1.0, .94117}, {.4, 1.0, .91441}, {.95, 1.0, .89007}};
    for (size_t i = 0; i < sizeof want / sizeof want[0]; i++)
        assert_near(eval_at(want[i][0], want[i][1], 0.2, 3.9, 1e-6), want[i][2], 4e-5);
}

/* F = 1 (n = 0): nothing is lost, at any resolution, cosine or roughness. */
static void furnace_is_exact(void **state) {
    (void)state;
    const double alphas[] = {0.0, 1e-9, 1e-4, 1e-3, 0.03, 0.2, 0.7, 1.0};
    const double mus[] = {0.0, 1e-6, 1e-3, 0.03, 0.4, 1.0};
    for (size_t a = 0; a < sizeof alphas / sizeof alphas[0]; a++)
        for (size_t m = 0; m < sizeof mus / sizeof mus[0]; m++)
            for (double tolerance = 1e-2; tolerance >= 1e-7; tolerance *= 1e-5)
                assert_near(eval_at(mus[m], alphas[a], 0.0, 1.0, tolerance), 1.0, 1e-12);
    /* Below 1e-4 the rounding of angles shows, about 1e-16 / alpha in every matrix element. */
    for (size_t m = 0; m < sizeof mus / sizeof mus[0]; m++)
        assert_near(eval_at(mus[m], 1e-6, 0.0, 1.0, 1e-5), 1.0, 1e-7);
}

static void smooth_interface_is_fresnel(void **state) {
    (void)state;
    for (double mu = 0.0; mu <= 1.0; mu += 0.1) {
        assert_near(eval_at(mu, 0.0, 0.2, 3.9, 1e-5), lq_fresnel_conductor(mu, 0.2, 3.9), 0.0);
        /* Continuous at the threshold where roughness starts to count. */
        assert_near(eval_at(mu, 0.9e-8, 0.2, 3.9, 1e-5), eval_at(mu, 2e-8, 0.2, 3.9, 1e-5), 1e-6);
    }
}

/* Small roughness at fixed mu: the lobe narrows, FGD-infinity -> F(mu), almost like alpha^2 (GGX: its tail
 * leaves a logarithm). */
static void small_roughness_tends_to_fresnel(void **state) {
    (void)state;
    const double far = eval_at(0.5, 0.02, 1.5, 0.5, 1e-8) - lq_fresnel_conductor(0.5, 1.5, 0.5);
    const double near = eval_at(0.5, 0.002, 1.5, 0.5, 1e-8) - lq_fresnel_conductor(0.5, 1.5, 0.5);
    assert_true(fabs(far) > 1e-4);
    assert_true(near / far > 0.01 && near / far < 0.05);
}

static void orders_of_scattering(void **state) {
    (void)state;
    const double want[] = {.3069, .3225, .2117, .1025, .0395, .0126, .0035};
    const double white[] = {1.0, 1.0, 0.0, 1.0};
    lq_settings settings = lq_settings_default();
    double energies[40], sum = 0.0;
    assert_int_equal(lq_eval_orders(&settings, white, 40, energies, NULL), LQ_OK);
    /* Four digits of a random walk. */
    for (int i = 0; i < 7; i++) assert_near(energies[i], want[i], 1.5e-4);
    for (int i = 0; i < 40; i++) sum += energies[i];
    assert_near(sum, 1.0, 1e-10);
    /* Second order at mu = 1: pi^2/12 - 1/2. */
    assert_near(energies[1], 3.14159265358979 * 3.14159265358979 / 12.0 - 0.5, 2e-6);
    const double metal[] = {0.4, 0.5, 1.5, 0.7};
    assert_int_equal(lq_eval_orders(&settings, metal, 40, energies, NULL), LQ_OK);
    sum = 0.0;
    for (int i = 0; i < 40; i++) sum += energies[i];
    assert_near(sum, eval_at(0.4, 0.5, 1.5, 0.7, 1e-7), 1e-6);
}

/* Constant F: scale the curve of total reflection. F = f is 1 minus (1-f) times "everything absorbed", and a
 * matched index (n = 1, kappa = 0) is what absorbs everything. */
static void constant_reflectance_at_full_roughness(void **state) {
    (void)state;
    const double want[2][4] = {{.5, .46007, .33053, .26845}, {.9, .88505, .82655, .79101}};
    const double mean_want[2] = {.31143, .81521};
    const double n = 1.0, kappa = 0.0;
    for (int i = 0; i < 2; i++) {
        lq_conductors black;
        assert_int_equal(lq_conductors_make(&black, &n, &kappa, 1, 1e-12, NULL), LQ_OK);
        black.coefficients[1] = 1.0 - want[i][0];
        lq_gauss rule;
        lq_gauss_make(&rule, 32);
        double mu[35] = {.05, .5, .999}, energy[35], estimate;
        for (int q = 0; q < 32; q++) mu[3 + q] = rule.node[q] * rule.node[q];
        assert_int_equal(lq_conductor_energies(ggx(), 1.0, &black, mu, 35, 1e-6, energy, &estimate, NULL),
                         LQ_OK);
        for (int m = 0; m < 3; m++) assert_near(energy[m], want[i][1 + m], 1.1e-5);
        double mean = 0.0;
        for (int q = 0; q < 32; q++)
            mean += rule.weight[q] * 2.0 * rule.node[q] * 2.0 * mu[3 + q] * energy[3 + q];
        assert_near(mean, mean_want[i], 1.1e-5);
        lq_conductors_free(&black);
    }
}

static void more_hits_cannot_take_energy_away(void **state) {
    (void)state;
    lq_settings single = lq_settings_default();
    single.scattering = LQ_SINGLE;
    for (double alpha = 0.05; alpha <= 1.0; alpha *= 1.8)
        for (double mu = 0.0; mu <= 1.0; mu += 0.2) {
            const double point[] = {mu, alpha, 0.3, 2.0};
            double value, estimate;
            lq_error error;
            assert_int_equal(lq_eval(lq_kind_find("fgd", &error), &single, point, &value, &estimate, &error),
                             LQ_OK);
            const double all = eval_at(mu, alpha, 0.3, 2.0, 1e-6);
            assert_true(all > value - 1e-5);
            assert_true(all <= 1.0);
        }
}

static void hard_cases_have_values(void **state) {
    (void)state;
    const double alphas[] = {0.0, 1e-4, 1e-3, 1.0}, mus[] = {0.0, 1e-6, 0.3};
    const double index[][2] = {{1.0, 0.0},  {1 - 1e-6, 0.0}, {1 + 1e-6, 0.0}, {1.0, 1e-6},
                               {0.25, 0.0}, {4.0, 0.0},      {0.2, 1e-6},     {0.1, 0.02},
                               {1.5, 10.0}, {0.0, 0.0},      {100.0, 100.0}};
    for (size_t a = 0; a < 4; a++)
        for (size_t m = 0; m < 3; m++)
            for (size_t i = 0; i < sizeof index / sizeof index[0]; i++)
                eval_at(mus[m], alphas[a], index[i][0], index[i][1], 1e-3);
    assert_near(eval_at(0.3, 0.4, 1.0, 0.0, 1e-5), 0.0, 1e-12);
    /* Continuous in kappa at 0. */
    assert_near(eval_at(0.3, 0.4, 0.7, 0.0, 1e-5), eval_at(0.3, 0.4, 0.7, 1e-6, 1e-5), 2e-5);
}

/* (mu, alpha) -> (0, 0) along mu = x alpha: all light leaves in the end, 1 - E going like alpha log(1/alpha)
 * with a factor that depends on x. */
static void the_corner_depends_on_the_approach(void **state) {
    (void)state;
    double before = 0.0;
    for (double x = 0.1; x <= 10.0; x *= 10.0) {
        const double far = 1.0 - eval_at(x * 1e-3, 1e-3, 1.5, 0.5, 1e-6);
        const double near = 1.0 - eval_at(x * 1e-4, 1e-4, 1.5, 0.5, 1e-6);
        assert_true(near > 0.1 * far - 1e-6 && near < 0.2 * far);
        assert_true(fabs(far - before) > 1e-3);
        before = far;
    }
}

/* As good as it gets; whether 1e-8 itself is reached depends on the material. */
static double best_at(const double *point) {
    lq_settings settings = lq_settings_default();
    settings.tolerance = 1e-8;
    lq_error error;
    double value, estimate;
    lq_eval(lq_kind_find("fgd", &error), &settings, point, &value, &estimate, &error);
    assert_true(estimate <= 5e-8);
    return value;
}

static void finer_tolerances_are_reached(void **state) {
    (void)state;
    const double points[][4] = {
        {.3, .5, .2, 3.9}, {.02, .03, 1.5, .5}, {.9, 1.0, 1.5, 2.0}, {.1, .2, .05, .05}};
    for (size_t i = 0; i < 4; i++) {
        const double *p = points[i], exact = best_at(p);
        assert_near(eval_at(p[0], p[1], p[2], p[3], 1e-7), exact, 1e-7);
        assert_near(eval_at(p[0], p[1], p[2], p[3], 1e-5), exact, 1e-5);
    }
}

/* The SIMD copies agree with the plain one on a whole solve. */
static void kernel_copies_agree(void **state) {
    (void)state;
    const lq_solver_kernels *base = lq_precompute_kernels_base(), *widest = lq_solver_kernels_get();
    const lq_cosine_map map = {.inverse_alpha = 2.0, .scale = 1.3, .shift = -0.9, .half_angle = 1};
    double cosine[40], weight[40], a[24] = {0.0}, b[24] = {0.0};
    for (int i = 0; i < 40; i++) {
        cosine[i] = (i + 0.5) / 40;
        weight[i] = 1.0 / (1 + i);
    }
    base->moments(&map, 40, cosine, weight, 24, a);
    widest->moments(&map, 40, cosine, weight, 24, b);
    for (int m = 0; m < 24; m++) assert_near(a[m], b[m], 1e-12 * fabs(a[m]) + 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_walks_of_a_metal),
        cmocka_unit_test(furnace_is_exact),
        cmocka_unit_test(smooth_interface_is_fresnel),
        cmocka_unit_test(small_roughness_tends_to_fresnel),
        cmocka_unit_test(orders_of_scattering),
        cmocka_unit_test(constant_reflectance_at_full_roughness),
        cmocka_unit_test(more_hits_cannot_take_energy_away),
        cmocka_unit_test(hard_cases_have_values),
        cmocka_unit_test(the_corner_depends_on_the_approach),
        cmocka_unit_test(finer_tolerances_are_reached),
        cmocka_unit_test(kernel_copies_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
