/* Materials of scenes: their lobes hold the exact stack's energy at any albedo, spread as it does, are found
 * between the parameters that were solved, and their texels keep the budget they were made for. */
#include "pack/lobes_measure.h"
#include "stack/level.h"
#include "tests/stack_light.h"

#define RANGE(a, b) "{\"min\": " #a ", \"max\": " #b "}"

static const double cosines[] = {0.9, 0.5, 0.2, 0.05};
enum { COSINES = 4 };

static lq_material describe(const char *text, lq_stack **stack) {
    lq_material m = {0};
    lq_error error = {""};
    if (lq_stack_parse(stack, text, "a.json", LQ_STACK_RANGES, &error) != LQ_OK ||
        lq_material_describe(&m, *stack, &error) != LQ_OK)
        fail_msg("%s", error.text);
    return m;
}

static void numbers_at(const lq_material *m, const double *values, double *numbers) {
    double mu[COSINES + 1];
    lq_spread spread;
    lq_error error = {""};
    memcpy(mu, cosines, sizeof cosines);
    mu[COSINES] = 1.0;
    assert_int_equal(lq_spread_make(&spread, mu, COSINES + 1, &error), LQ_OK);
    const lq_status status =
        lq_material_solve(m, values, &spread, cosines, COSINES, -1, 1e-4, numbers, &error);
    if (status != LQ_OK) fail_msg("%s", error.text);
    lq_spread_free(&spread);
}

static double energy(const lq_material *m, const double *n, int colour, double rho) {
    return n[LQ_MATERIAL_TOP + colour] + n[LQ_MATERIAL_INNER + colour] + lq_material_base(n, colour, m, rho);
}

/* The same lobes as of a mirror of that roughness. */
static void test_spread(void **state) {
    (void)state;
    static const double alphas[] = {0.05, 0.3, 0.7, 1.0};
    for (int a = 0; a < 4; a++)
        for (int m = 0; m < COSINES; m++) {
            char text[128];
            snprintf(text, sizeof text, LAYERS("{\"conductor\": {\"n\": 0, \"kappa\": 1, \"alpha\": %g}}"),
                     alphas[a]);
            lq_stack *stack = parse(text);
            const lq_stack_query query = {.mu = &cosines[m], .mu_count = 1, .single = true};
            lq_stack_light light;
            lq_spread spread;
            assert_int_equal(lq_stack_solve(stack, &query, &light, NULL, NULL), LQ_OK);
            assert_near(lq_spread_across(cosines[m], alphas[a]), light.reflected.across,
                        1e-4 + 0.015 * light.reflected.across);
            assert_int_equal(lq_spread_make(&spread, &cosines[m], 1, NULL), LQ_OK);
            /* Near 1 a little spread is much roughness. */
            assert_near(lq_spread_alpha(&spread, 0, light.reflected.across), alphas[a],
                        alphas[a] < 1.0 ? 0.02 : 0.06);
            lq_spread_free(&spread);
            lq_stack_free(stack);
        }
}

/* One solve of three albedos says what any albedo, and any colour of the coat, comes to. */
static void test_any_albedo(void **state) {
    (void)state;
    static const double alphas[] = {0.1, 0.35}, rhos[] = {0.2, 0.77, 1.0};
    lq_stack *stack;
    const lq_material m = describe(LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": " RANGE(
                                       0.02, 0.5) "}, \"medium\": {\"tau\": [0.9, "
                                                  "0.7, 0.4]}},{\"lambertian\": {\"rho\": " RANGE(0, 1) "}}"),
                                   &stack);
    assert_int_equal(m.range_count, 1);
    assert_true(m.open_rho);
    assert_string_equal(m.ranges[0].name, "alpha");
    for (int a = 0; a < 2; a++)
        for (int r = 0; r < 3; r++) {
            double n[COSINES * LQ_MATERIAL_NUMBERS];
            char text[256];
            numbers_at(&m, &alphas[a], n);
            snprintf(text, sizeof text,
                     LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": %g}, \"medium\": {\"tau\": [0.9, 0.7, "
                            "0.4]}},{\"lambertian\": {\"rho\": %g}}"),
                     alphas[a], rhos[r]);
            lq_stack *exact = parse(text);
            const lq_stack_query query = {.mu = cosines, .mu_count = COSINES, .tolerance = 1e-4};
            lq_stack_light light[COSINES * LQ_STACK_CHANNELS];
            assert_int_equal(lq_stack_solve(exact, &query, light, NULL, NULL), LQ_OK);
            for (int i = 0; i < COSINES * LQ_STACK_CHANNELS; i++)
                assert_near(energy(&m, n + i / LQ_STACK_CHANNELS * LQ_MATERIAL_NUMBERS, i % LQ_STACK_CHANNELS,
                                   rhos[r]),
                            light[i].reflected.energy, 1e-4);
            lq_stack_free(exact);
        }
    lq_stack_free(stack);
}

/* Nothing is lost where nothing absorbs. */
static void test_furnace(void **state) {
    (void)state;
    static const char *const white[] = {
        LAYERS(DIELECTRIC(1.5, 0.3) "," LAMBERTIAN(1)), LAYERS(DIELECTRIC(1.5, 0.3) "," CONDUCTOR(0, 1, 0.2)),
        LAYERS(DIELECTRIC(1.33, 0.1) "," DIELECTRIC(1.6, 0.4) "," LAMBERTIAN(1)), LAYERS(LAMBERTIAN(1))};
    for (int w = 0; w < 4; w++) {
        lq_stack *stack;
        const lq_material m = describe(white[w], &stack);
        double n[COSINES * LQ_MATERIAL_NUMBERS];
        numbers_at(&m, NULL, n);
        for (int i = 0; i < COSINES; i++)
            assert_near(energy(&m, n + i * LQ_MATERIAL_NUMBERS, 0, 1.0), 1.0, 1e-6);
        lq_stack_free(stack);
    }
}

/* A lobe spreads as the light it stands for: the frosted metal of definitions, and what left a base. */
static void test_roughness(void **state) {
    (void)state;
    lq_stack *stack;
    const lq_material metal = describe(FROSTED, &stack);
    double n[COSINES * LQ_MATERIAL_NUMBERS];
    numbers_at(&metal, NULL, n);
    for (int i = 0; i < COSINES; i++) {
        lq_stack_light light[2];
        const lq_stack_query query = {.mu = &cosines[i], .mu_count = 1, .paths = 2};
        assert_int_equal(lq_stack_solve(stack, &query, light, NULL, NULL), LQ_OK);
        assert_near(lq_spread_across(cosines[i], n[i * LQ_MATERIAL_NUMBERS + LQ_MATERIAL_INNER_ALPHA]),
                    light[1].reflected.across, 1e-3);
        assert_near(n[i * LQ_MATERIAL_NUMBERS + LQ_MATERIAL_TOP], light[0].reflected.energy, 1e-4);
    }
    lq_stack_free(stack);
}

/* Several stacks solved at once are what they are one by one. */
static void test_list(void **state) {
    (void)state;
    lq_stack *stacks[] = {parse(FROSTED), parse(VARNISHED),
                          parse(LAYERS(COATING(1.5, 0.2, 0.5) "," LAMBERTIAN(0.3)))};
    const lq_stack_query query = {.mu = cosines, .mu_count = COSINES, .tolerance = 1e-4};
    lq_stack_light all[COSINES * 3], one[COSINES];
    assert_int_equal(lq_stack_solve_list((const lq_stack *const *)stacks, 3, &query, all, NULL, NULL), LQ_OK);
    for (int s = 0; s < 3; s++) {
        assert_int_equal(lq_stack_solve(stacks[s], &query, one, NULL, NULL), LQ_OK);
        for (int i = 0; i < COSINES; i++) {
            assert_near(all[i * 3 + s].reflected.energy, one[i].reflected.energy,
                        all[i * 3 + s].error + one[i].error);
            assert_near(all[i * 3 + s].reflected.across, one[i].reflected.across,
                        all[i * 3 + s].error + one[i].error);
        }
    }
    for (int s = 0; s < 3; s++) lq_stack_free(stacks[s]);
}

/* Two ranges: between the solved parameters, and as texels. */
static void test_bake(void **state) {
    (void)state;
    lq_stack *stack;
    lq_error error = {""};
    const lq_material m = describe(
        LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": " RANGE(
            0.1, 0.4) "}},"
                      "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": " RANGE(0.1, 0.3) "}}"),
        &stack);
    assert_string_equal(m.ranges[0].name, "top_alpha");
    assert_string_equal(m.ranges[1].name, "base_alpha");
    double mu[LQ_LOBES_COSINES];
    lq_baked baked;
    lq_lobes lobes;
    lq_lobes_measure measure;
    const lq_lobes_budget budget = {4e-3, 1e-2};
    lq_lobes_cosines(mu);
    assert_int_equal(
        lq_bake((const lq_material *const[]){&m}, 1, mu, LQ_LOBES_COSINES, 1e-2, 0, NULL, &baked, &error),
        LQ_OK);
    assert_int_equal(lq_lobes_make(&lobes, &baked, &budget, &error), LQ_OK);
    assert_int_equal(lobes.axis_count, 3);
    assert_true(lobes.image.height == lobes.axes[2].size * lq_lobes_pitch(&lobes) - LQ_LOBES_BORDER);
    lq_lobes_exact exact;
    assert_int_equal(
        lq_lobes_exact_make(&exact, (const lq_material *const[]){&m}, 1, 6, 1, 0.0, 0, NULL, &error), LQ_OK);
    assert_int_equal(lq_lobes_measure_one(&exact, 0, &lobes, &measure, &error), LQ_OK);
    lq_lobes_exact_free(&exact);
    print_message("two ranges: %zu bytes, p99 %.2e, max %.2e\n", lq_image_bytes(&lobes.image), measure.p99,
                  measure.max);
    assert_near(measure.p99, 0.0, budget.p99);
    assert_near(measure.max, 0.0, budget.max);
    assert_true(measure.rms > 1e-5); /* something was compared */
    lq_lobes_free(&lobes);
    lq_baked_free(&baked);
    lq_stack_free(stack);
}

static void test_refuses(void **state) {
    (void)state;
    static const char *const bad[][2] = {
        {SLAB, "lets light through"},
        {LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": {\"x\": 0.1, \"y\": 0.2}}}," LAMBERTIAN(1)),
         "anisotropic"},
        {LAYERS("{\"conductor\": {\"n\": 1, \"kappa\": 2, \"alpha\": 0.2, \"ndf\": \"beckmann\"}}"), "ggx"},
        {LAYERS("{\"conductor\": {\"n\": " RANGE(1, 2) ", \"kappa\": " RANGE(1, 2) ", \"alpha\": " RANGE(
             0.1, 1) "}}"),
         "range too many"}};
    for (int i = 0; i < 4; i++) {
        lq_stack *stack;
        lq_material m;
        lq_error error = {""};
        assert_int_equal(lq_stack_parse(&stack, bad[i][0], "a.json", LQ_STACK_RANGES, &error), LQ_OK);
        assert_int_equal(lq_material_describe(&m, stack, &error), LQ_BAD_INPUT);
        if (!strstr(error.text, bad[i][1])) fail_msg("'%s' does not say '%s'", error.text, bad[i][1]);
        lq_stack_free(stack);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_spread),  cmocka_unit_test(test_any_albedo),
                                       cmocka_unit_test(test_furnace), cmocka_unit_test(test_roughness),
                                       cmocka_unit_test(test_list),    cmocka_unit_test(test_bake),
                                       cmocka_unit_test(test_refuses)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
