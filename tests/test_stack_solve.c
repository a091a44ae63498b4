/* Light of layered stacks: what is exact at any resolution, and what is refused. */
#include <math.h>

#include "microfacet/fresnel.h"
#include "microfacet/gauss.h"
#include "tests/stack_light.h"

/* ======================================================================================
 *                                     Exact limits
 * ====================================================================================== */

static void test_lossless_is_one(void **state) {
    (void)state;
    static const char *const stacks[] = {
        WHITE,
        LAYERS(DIELECTRIC(1.5, 1) "," CONDUCTOR(0, 2, 0.3)),
        LAYERS(DIELECTRIC(1.5, 0) "," LAMBERTIAN(1)),
        LAYERS(DIELECTRIC(2.4, 0.7) "," DIELECTRIC(1.2, 0.01) "," LAMBERTIAN(1)),
        LAYERS(DIELECTRIC(1.5, 0) "," CONDUCTOR(0, 2,
                                                0)), /* total reflection traps light that nothing lets in */
        LAYERS(DIELECTRIC(1.7, 0.3) "," DIELECTRIC(1, 0.3))};
    const double mu[] = {1.0, 0.6, 0.15, 1e-3};
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++) {
        const lq_stack_query query = {.mu = mu, .mu_count = 4, .tolerance = 1e-3};
        lq_stack_light light[4];
        solve(stacks[i], &query, light);
        for (int m = 0; m < 4; m++)
            assert_near(light[m].reflected.energy + light[m].transmitted.energy, 1.0, 1e-10);
    }
}

/* Smooth interfaces: an interface of reflectance a over media of transmittance t over what reflects b. */
static double over(double a, double t, double b) {
    return a + (1.0 - a) * (1.0 - a) * t * t * b / (1.0 - a * t * t * b);
}

static void test_smooth_closed_form(void **state) {
    (void)state;
    const char *stack = LAYERS(COATING(1.5, 0, 0.8) "," COATING(1.9, 0, 0.6) "," CONDUCTOR(0.2, 3.9, 0));
    for (double mu = 0.1; mu <= 1.0; mu += 0.3) {
        double cos1, cos2;
        const double a = lq_fresnel_dielectric(mu, 1.5, &cos1),
                     b = lq_fresnel_dielectric(cos1, 1.9 / 1.5, &cos2);
        const double base = lq_fresnel_conductor(cos2, 0.2 / 1.9, 3.9 / 1.9);
        const double exact = over(a, pow(0.8, 1.0 / cos1), over(b, pow(0.6, 1.0 / cos2), base));
        const lq_stack_light light = light_at(stack, mu, 1e-6);
        assert_near(light.reflected.energy, exact, 1e-6);
        assert_near(light.reflected.sin2, 1.0 - mu * mu, 1e-6);
        assert_near(light.reflected.mean, sqrt(1.0 - mu * mu), 1e-6);
        assert_near(light.reflected.across, 0.0, 1e-6);
    }
}

/* A SLAB between smooth faces, both ways, and what lies along the way out. */
static void test_smooth_slab(void **state) {
    (void)state;
    const char *stack = LAYERS(COATING(1.5, 0, 0.7) "," COATING(1.2, 0, 0.9));
    const double mu = 0.4;
    double cos1, cos2;
    const double a = lq_fresnel_dielectric(mu, 1.5, &cos1), b = lq_fresnel_dielectric(cos1, 0.8, &cos2);
    const double t = pow(0.7, 1.0 / cos1), out = pow(0.9, 1.0 / cos2);
    const double passes = (1.0 - a) * t * (1.0 - b) / (1.0 - a * b * t * t) * out;
    const lq_stack_light light = light_at(stack, mu, 1e-6);
    assert_near(light.transmitted.energy, passes, 1e-6);
    assert_near(light.transmitted.sin2, 1.0 - cos2 * cos2, 1e-6);
    assert_near(light.transmitted.mean, sqrt(1.0 - cos2 * cos2), 1e-6);
    const lq_stack_query below = {.mu = &cos2, .mu_count = 1, .from_below = true, .tolerance = 1e-6};
    lq_stack_light back;
    solve(stack, &below, &back);
    assert_near(back.transmitted.energy, passes, 1e-6);
    assert_near(back.transmitted.sin2, 1.0 - mu * mu, 1e-6);
    assert_near(back.reflected.energy, out * out * over(b, t, a), 1e-6);
}

static void test_paths_add_up(void **state) {
    (void)state;
    const double mu[] = {0.8, 0.2};
    enum { PATHS = 5 };
    lq_stack_query query = {.mu = mu, .mu_count = 2, .tolerance = 1e-4};
    for (int i = 0; i < 2; i++) {
        const char *stack = i ? SLAB : FROSTED;
        lq_stack_light all[2], paths[2 * PATHS];
        query.paths = 0;
        solve(stack, &query, all);
        query.paths = PATHS;
        solve(stack, &query, paths);
        for (int m = 0; m < 2; m++) {
            double reflected = 0.0, sin2 = 0.0, transmitted = 0.0;
            for (int p = 0; p < PATHS; p++) {
                const lq_stack_light *l = &paths[m * PATHS + p];
                reflected += l->reflected.energy;
                sin2 += l->reflected.energy * l->reflected.sin2;
                transmitted += l->transmitted.energy;
            }
            assert_near(reflected, all[m].reflected.energy, 2e-4);
            assert_near(sin2, all[m].reflected.energy * all[m].reflected.sin2, 2e-4);
            assert_near(transmitted, all[m].transmitted.energy, 2e-4);
        }
        const lq_stack_light top = light_at(LAYERS(DIELECTRIC(1.5, 0.2)), mu[0], 1e-4);
        if (i == 0) assert_near(paths[0].reflected.energy, top.reflected.energy, 2e-4);
    }
}

/* Doubling: equal layers as one run, and cut into runs by a layer that changes next to nothing. */
static void test_doubling(void **state) {
    (void)state;
    char equal[8192] = "{\"layers\": [", broken[8192] = "{\"layers\": [";
    for (int i = 0; i < 12; i++) {
        char a[120], b[120];
        snprintf(a, sizeof a, "%s" COATING(1.5, 0.1, 0.99) "," DIELECTRIC(1, 0.3), i ? "," : "");
        snprintf(b, sizeof b,
                 "%s{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.1}, \"medium\": {\"tau\": %.12f}}," DIELECTRIC(
                     1, 0.3),
                 i ? "," : "", 0.99 + 1e-9 * i);
        strcat(equal, a);
        strcat(broken, b);
    }
    strcat(equal, "]}");
    strcat(broken, "]}");
    const lq_stack_light one = light_at(equal, 0.7, 1e-3), many = light_at(broken, 0.7, 1e-3);
    assert_near(one.reflected.energy, many.reflected.energy, 1e-7);
    assert_near(one.transmitted.energy, many.transmitted.energy, 1e-7);
    assert_near(one.transmitted.sin2, many.transmitted.sin2, 1e-7);
    assert_true(one.reflected.energy > 0.3 && one.transmitted.energy > 0.01);
}

static void test_threads_do_not_matter(void **state) {
    (void)state;
    const double mu[] = {0.9, 0.3};
    lq_stack_light light[2][2];
    for (int i = 0; i < 2; i++) {
        const lq_stack_query query = {.mu = mu, .mu_count = 2, .threads = i ? 3 : 1};
        solve(SLAB, &query, light[i]);
    }
    assert_memory_equal(light[0], light[1], sizeof light[0]);
}

/* ======================================================================================
 *                                       Refusals
 * ====================================================================================== */

static void refused(const char *text, const lq_stack_query *query, const char *message) {
    lq_stack *stack = parse(text);
    lq_error error = {""};
    lq_stack_light light;
    assert_int_equal(lq_stack_solve(stack, query, &light, NULL, &error), LQ_BAD_INPUT);
    if (!strstr(error.text, message)) fail_msg("'%s' does not say '%s'", error.text, message);
    lq_stack_free(stack);
}

static void test_refusals(void **state) {
    (void)state;
    double mu = 0.5;
    lq_stack_query query = {.mu = &mu, .mu_count = 1};
    refused(LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": {\"x\": 0.1, \"y\": 0.3}}}"), &query,
            "layer 1 is anisotropic");
    refused(
        LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.1}, \"medium\": {\"sigma_a\": 0, \"sigma_s\": 1, "
               "\"depth\": 1}}," LAMBERTIAN(0.5)),
        &query, "layer 1 has a medium that scatters");
    query.from_below = true;
    refused(FROSTED, &query, "light from below a conductor base");
    query.from_below = false;
    mu = 1.5;
    refused(FROSTED, &query, "mu = 1.5; accepted: 0 <= mu <= 1");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lossless_is_one), cmocka_unit_test(test_smooth_closed_form),
        cmocka_unit_test(test_smooth_slab),     cmocka_unit_test(test_paths_add_up),
        cmocka_unit_test(test_doubling),        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
