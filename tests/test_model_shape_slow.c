/* Models as functions of directions: energies and moments of what they send, sides, and the least roughness.
 */
#include <math.h>

#include "microfacet/fresnel.h"
#include "stack/model_shape.h"
#include "tests/stack_light.h"

/* Directions by the degree, or by the fifth of one. */
enum { COARSE = 180, FINE = 450 };

static const double PI = 3.14159265358979323846;

/* Of a model whose lobes are those of an incidence: such a shape needs its stack no more. */
static lq_model_shape make(const char *text, const lq_shape_query *query, double mu) {
    lq_stack *stack = parse(text);
    lq_model_shape shape;
    lq_error error = {""};
    if (lq_model_shape_make(&shape, stack, query, mu, &error) != LQ_OK) fail_msg("%s: %s", text, error.text);
    lq_stack_free(stack);
    return shape;
}

/* As released: that asks for no tables from inside, which take longest. */
static lq_status stand_in(void *user, const lq_kind *kind, const double *point, double *values,
                          lq_error *error) {
    (void)user;
    (void)error;
    values[0] = strcmp(kind->id, "fgd-dielectric") == 0 ? lq_fresnel_dielectric(point[0], point[2], NULL)
                : strcmp(kind->id, "fgd") == 0          ? lq_fresnel_conductor(point[0], point[2], point[3])
                                                        : 0.8;
    if (kind->channel_count > 1) values[1] = 0.5;
    return LQ_OK;
}

/* Smooth energies in place of tables, for what does not depend on them: pairs of directions need many. */
static const lq_model_source quick_source = {NULL, stand_in};
static const lq_shape_query quick = {.f = LQ_MODEL_F_B18, .source = &quick_source},
                            symmetric = {.model = LQ_MODEL_B18_SYMMETRIC,
                                         .f = LQ_MODEL_F_B18,
                                         .source = &quick_source};

static const lq_shape_query b18 = {.variant = LQ_MODEL_RELEASED, .f = LQ_MODEL_F_B18},
                            masked_b18 = {.variant = LQ_MODEL_RELEASED, .f = LQ_MODEL_F_B18, .masked = true},
                            baked = {.model = LQ_MODEL_BAKED, .f = LQ_MODEL_F_B18};

typedef struct totals {
    lq_stack_lobe direct, rest; /* of channel 0, not divided by their energies */
} totals;

static void add(lq_stack_lobe *sum, double flux, double x, double y) {
    sum->energy += flux;
    sum->sin2 += flux * (x * x + y * y);
    sum->mean += flux * x;
    sum->across += flux * y * y;
}

/* Over one hemisphere, `side` 1 or -1; its halves in y are alike, and one is summed. */
static totals sum_up(const lq_model_shape *shape, double side, int rings) {
    totals sum = {0};
    const double step = 0.5 * PI / rings;
    for (int r = 0; r < rings; r++)
        for (int t = 0; t < 2 * rings; t++) {
            const double theta = (r + 0.5) * step, phi = (t + 0.5) * step;
            const double x = sin(theta) * cos(phi), y = sin(theta) * sin(phi);
            const double angle = 2.0 * sin(theta) * step * step;
            double direct[3], rest[3];
            lq_model_shape_value(shape, x, y, side * cos(theta), direct, rest);
            add(&sum.direct, angle * direct[0], x, y);
            add(&sum.rest, angle * rest[0], x, y);
        }
    return sum;
}

/* A hemisphere of what the lobes of model.h have in sum. */
static void assert_moments(totals got, const lq_stack_lobe *expected, double tolerance) {
    const double energy = got.direct.energy + got.rest.energy;
    assert_near(energy, expected->energy, tolerance * expected->energy);
    if (!(energy > 0.0)) return;
    assert_near((got.direct.sin2 + got.rest.sin2) / energy, expected->sin2, 2e-3);
    assert_near((got.direct.mean + got.rest.mean) / energy, expected->mean, 2e-3);
    assert_near((got.direct.across + got.rest.across) / energy, expected->across, 2e-3);
}

static lq_stack_light light_of(const char *text, const lq_shape_query *query, double mu) {
    lq_stack *stack = parse(text);
    lq_model_lobe lobes[3 * 8];
    lq_error error = {""};
    const lq_model_query light = {.mu = &mu,
                                  .mu_count = 1,
                                  .model = query->model,
                                  .variant = query->variant,
                                  .f = query->f,
                                  .source = query->source};
    if (lq_model_solve(stack, &light, lobes, NULL, &error) != LQ_OK) fail_msg("%s", error.text);
    const lq_stack_light got = lq_model_light(stack, lobes);
    lq_stack_free(stack);
    return got;
}

static void test_energies_and_moments(void **state) {
    (void)state;
    static const char *const stacks[] = {FROSTED, SLAB, LAYERS(COATING(1.5, 0.3, 0.8) "," LAMBERTIAN(0.7))};
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++)
        for (double mu = 0.4; mu <= 1.0; mu += 0.3) {
            const lq_stack_light expected = light_of(stacks[i], &quick, mu);
            lq_model_shape shape = make(stacks[i], &quick, mu);
            assert_moments(sum_up(&shape, 1.0, COARSE), &expected.reflected, 1e-3);
            assert_moments(sum_up(&shape, -1.0, COARSE), &expected.transmitted, 1e-3);
            lq_model_shape_free(&shape);
        }
}

/* Baked lobes have the exact energies, each its own, and the exact spread across the plane of incidence. */
static void test_baked_is_exact(void **state) {
    (void)state;
    static const char *const stacks[] = {FROSTED, SLAB, VARNISHED};
    const double mu = 0.6;
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++) {
        const lq_stack_query light = {.mu = &mu, .mu_count = 1, .paths = 2};
        lq_stack_light exact[2];
        solve(stacks[i], &light, exact);
        lq_model_shape shape = make(stacks[i], &baked, mu);
        const totals up = sum_up(&shape, 1.0, COARSE), down = sum_up(&shape, -1.0, COARSE);
        assert_near(up.direct.energy, exact[0].reflected.energy, 3e-4);
        assert_near(up.rest.energy, exact[1].reflected.energy, 3e-4);
        assert_near(down.rest.energy, exact[0].transmitted.energy + exact[1].transmitted.energy, 3e-4);
        if (i < 2) assert_near(up.rest.across / up.rest.energy, exact[1].reflected.across, 1e-3);
        lq_model_shape_free(&shape);
    }
}

/* Behind a window as well; the two parts of what was inside have their own spread, which is theirs together.
 * Over a Lambertian base it is baked. */
static void test_baked_window_is_exact(void **state) {
    (void)state;
    static const char *const stacks[] = {FROSTED, SLAB};
    const lq_shape_query query = {.model = LQ_MODEL_BAKED_WINDOW}, plain = {.model = LQ_MODEL_BAKED};
    for (size_t i = 0; i < 2; i++)
        for (double mu = 0.6; mu <= 1.0; mu += 0.4) {
            const lq_stack_query light = {.mu = &mu, .mu_count = 1, .paths = 3};
            lq_stack_light exact[3];
            solve(stacks[i], &light, exact);
            lq_model_shape shape = make(stacks[i], &query, mu);
            const totals up = sum_up(&shape, 1.0, COARSE), down = sum_up(&shape, -1.0, COARSE);
            double inner = 0.0, through = 0.0;
            for (int p = 0; p < 3; p++) through += exact[p].transmitted.energy;
            for (int p = 0; p < LQ_WINDOW_PARTS; p++) {
                lq_window part = shape.lobes[1].window;
                part.part[1 - p].energy = 0.0;
                inner += exact[1 + p].reflected.energy;
                if (part.part[p].alpha < 1.0)
                    assert_near(lq_window_light(&part, mu).across, exact[1 + p].reflected.across, 1e-4);
                else assert_true(lq_window_light(&part, mu).across < exact[1 + p].reflected.across);
            }
            const lq_stack_lobe sum = lq_window_light(&shape.lobes[1].window, mu);
            assert_near(up.direct.energy, exact[0].reflected.energy, 3e-4);
            assert_near(up.rest.energy, inner, 3e-4);
            assert_near(up.rest.across / up.rest.energy, sum.across, 3e-4);
            assert_near(up.rest.mean / up.rest.energy, sum.mean, 1e-3);
            assert_near(down.rest.energy, through, 3e-4);
            lq_model_shape_free(&shape);
        }
    lq_model_shape one = make(VARNISHED, &query, 0.6), other = make(VARNISHED, &plain, 0.6);
    for (size_t k = 0; k < one.count; k++) assert_true(one.lobes[k].scale == other.lobes[k].scale);
    lq_model_shape_free(&one);
    lq_model_shape_free(&other);
}

/* Below a smooth coat light that was inside once has the form of a window, and nothing else is as narrow: the
 * peak is that of the base's own facets, T(mu) D G2 / (4 mu_i') F / n^2. */
static void test_window_below_a_smooth_coat(void **state) {
    (void)state;
    const double mu = 0.6, n = 1.5, alpha = 0.2, sine = 0.8, inside = sqrt(1.0 - sine * sine / (n * n));
    const char *black = LAYERS(DIELECTRIC(1.5, 0) "," CONDUCTOR(0.2, 3.9, 0.2));
    const lq_shape_query query = {.model = LQ_MODEL_BAKED_WINDOW};
    lq_model_shape shape = make(black, &query, mu);
    double direct[3], rest[3];
    lq_model_shape_value(&shape, sine, 0.0, mu, direct, rest);
    const double through = 1.0 - lq_fresnel_dielectric(mu, n, NULL);
    const double base = lq_fresnel_conductor(inside, 0.2 / n, 3.9 / n);
    const double once = through * through * base *
                        lq_lobe_density((lq_incidence){inside, sine / n}, alpha, sine / n, 0.0, inside) * mu /
                        (n * n * inside);
    print_message("peak %.4f, of one bounce %.4f\n", rest[0], once);
    assert_true(rest[0] > once && rest[0] < 1.2 * once);
    lq_model_shape_free(&shape);
}

/* What one interface does has nothing that was inside, on either side. */
static void test_one_interface_is_direct(void **state) {
    (void)state;
    const lq_stack_light exact = light_at(LAYERS(DIELECTRIC(1.5, 0.3)), 0.7, 1e-5);
    for (int model = 0; model < 2; model++) {
        const lq_shape_query query = model ? baked : b18;
        lq_model_shape shape = make(LAYERS(DIELECTRIC(1.5, 0.3)), &query, 0.7);
        const totals up = sum_up(&shape, 1.0, COARSE), down = sum_up(&shape, -1.0, COARSE);
        assert_near(up.direct.energy, exact.reflected.energy, 2e-4);
        assert_near(down.direct.energy, exact.transmitted.energy, 2e-3);
        assert_near(up.rest.energy + down.rest.energy, 0.0, 0.0);
        lq_model_shape_free(&shape);
    }
}

/* A lobe as B18 has it is short by the albedo of its microsurface. */
static void test_masked_lobes_lose_light(void **state) {
    (void)state;
    const char *text = LAYERS(CONDUCTOR(0, 2, 0.5));
    const lq_settings settings = lq_settings_default();
    double albedo, estimate;
    const lq_status status =
        lq_eval(lq_kind_find("albedo", NULL), &settings, (double[]){0.4, 0.5}, &albedo, &estimate, NULL);
    assert_int_equal(status, LQ_OK);
    lq_model_shape whole = make(text, &b18, 0.4);
    lq_model_shape masked = make(text, &masked_b18, 0.4);
    assert_near(sum_up(&whole, 1.0, COARSE).direct.energy, 1.0, 1e-3);
    assert_near(sum_up(&masked, 1.0, COARSE).direct.energy, albedo, 1e-3);
    assert_true(albedo < 0.9);
    lq_model_shape_free(&whole);
    lq_model_shape_free(&masked);
}

/* Smooth layers: the least roughness keeps its energy on the cells, and says that it was taken. */
static void test_least_roughness(void **state) {
    (void)state;
    const char *text = LAYERS(DIELECTRIC(1.5, 0) "," CONDUCTOR(0.2, 3.9, 0));
    for (double mu = 0.3; mu < 1.0; mu += 0.3) {
        const lq_stack_light expected = light_of(text, &b18, mu);
        lq_model_shape shape = make(text, &b18, mu);
        const totals got = sum_up(&shape, 1.0, FINE);
        assert_near(shape.sharpest, 0.0, 0.0);
        assert_near(shape.lobes[1].alpha, LQ_SHAPE_LEAST_ALPHA, 0.0);
        assert_near(got.direct.energy + got.rest.energy, expected.reflected.energy, 2e-4);
        assert_near((got.direct.mean + got.rest.mean) / expected.reflected.energy, sqrt(1.0 - mu * mu), 3e-3);
        lq_model_shape_free(&shape);
    }
}

static void test_channels_and_ends(void **state) {
    (void)state;
    const char *rgb = LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}, \"medium\": {\"tau\": [1, 0.5, "
                             "0.2]}}," CONDUCTOR(0.2, 3.9, 0.05));
    double direct[3], rest[3], same[3], grey[3];
    lq_model_shape shape = make(rgb, &b18, 0.5);
    lq_model_shape one = make(FROSTED, &b18, 0.5);
    lq_model_shape_value(&shape, 0.6, 0.0, 0.8, direct, rest);
    lq_model_shape_value(&one, 0.6, 0.0, 0.8, same, grey);
    for (int c = 0; c < 3; c++) {
        assert_near(direct[c], same[0], 1e-12);
        assert_near(grey[c], grey[0], 0.0);
    }
    assert_near(rest[0], grey[0], 1e-12);
    assert_true(rest[0] > rest[1] && rest[1] > rest[2] && rest[2] > 0.0);
    lq_model_shape_free(&shape);
    lq_model_shape_free(&one);
    const double mu[] = {0.0, 1.0};
    for (int m = 0; m < 2; m++)
        for (int alpha = 0; alpha < 2; alpha++) {
            const char *text = alpha ? LAYERS(CONDUCTOR(0.2, 3.9, 1)) : LAYERS(CONDUCTOR(0.2, 3.9, 0));
            lq_model_shape end = make(text, &b18, mu[m]);
            lq_model_shape_value(&end, sqrt(1.0 - mu[m] * mu[m]), 0.0, mu[m], direct, rest);
            assert_true(isfinite(direct[0]) && direct[0] >= 0.0);
            lq_model_shape_value(&end, 0.8, 0.0, 0.6, direct, rest);
            assert_true(isfinite(direct[0]) && direct[0] > 0.0);
            lq_model_shape_free(&end);
        }
}

/* ======================================================================================
 *                                    Pairs of directions
 * ====================================================================================== */

static void aim(lq_model_shape *shape, double mu) {
    lq_error error = {""};
    if (lq_model_shape_aim(shape, mu, &error) != LQ_OK) fail_msg("%s", error.text);
}

static double sine_of(double mu) {
    return sqrt((1.0 - mu) * (1.0 + mu));
}

/* In the plane of incidence, towards +x; all lobes. */
static double value_at(const lq_model_shape *shape, double z) {
    double direct[3], rest[3];
    lq_model_shape_value(shape, sine_of(fabs(z)), 0.0, z, direct, rest);
    return direct[0] + rest[0];
}

/* Where the half vector is the normal, theta_d is theta_i; on either side. */
static void test_symmetric_mirrors_as_forward(lq_model_shape *shape, const char *text) {
    for (double mu = 0.1; mu <= 1.0; mu += 0.3) {
        lq_model_shape forward = make(text, &quick, mu);
        aim(shape, mu);
        assert_near(value_at(shape, mu) / value_at(&forward, mu), 1.0, 5e-3);
        if (forward.lobes[forward.count - 1].energy > 0.0)
            assert_near(value_at(shape, -mu) / value_at(&forward, -mu), 1.0, 5e-3);
        lq_model_shape_free(&forward);
    }
}

/* f(i, o) = f(o, i); of b18-forward that is not so. */
static void test_symmetric_is_reciprocal(lq_model_shape *shape) {
    aim(shape, 0.5);
    const double there = value_at(shape, 0.8) / 0.8;
    aim(shape, 0.8);
    const double back = value_at(shape, 0.5) / 0.5;
    assert_near(there / back, 1.0, 1e-12);
    lq_model_shape one = make(FROSTED, &quick, 0.5), other = make(FROSTED, &quick, 0.8);
    assert_true(fabs(value_at(&one, 0.8) / 0.8 / (value_at(&other, 0.5) / 0.5) - 1.0) > 0.1);
    lq_model_shape_free(&one);
    lq_model_shape_free(&other);
}

/* What it sends altogether, by half vectors and by directions. */
static void test_symmetric_sums(lq_model_shape *shape) {
    for (double mu = 0.3; mu < 1.0; mu += 0.5) {
        aim(shape, mu);
        const lq_stack_light light = lq_model_shape_light(shape, 0);
        assert_moments(sum_up(shape, 1.0, COARSE), &light.reflected, 2e-3);
        assert_moments(sum_up(shape, -1.0, COARSE), &light.transmitted, 2e-3);
    }
}

static void test_symmetric(void **state) {
    (void)state;
    static const char *const stacks[] = {FROSTED, SLAB};
    for (int i = 0; i < 2; i++) {
        lq_stack *stack = parse(stacks[i]);
        lq_error error = {""};
        lq_model_shape shape;
        if (lq_model_shape_make(&shape, stack, &symmetric, 1.0, &error) != LQ_OK) fail_msg("%s", error.text);
        test_symmetric_mirrors_as_forward(&shape, stacks[i]);
        test_symmetric_sums(&shape);
        if (i == 0) test_symmetric_is_reciprocal(&shape);
        assert_int_equal(lq_model_shape_aim(&shape, 2.0, &error), LQ_BAD_INPUT);
        lq_model_shape_free(&shape);
        lq_stack_free(stack);
    }
}

/* Sums over half vectors are those of lobes that are normalised, at any incidence. */
static void test_moments_of_lobes(void **state) {
    (void)state;
    for (double mu = 0.1; mu <= 1.0; mu += 0.3) {
        lq_model_shape shape = make(SLAB, &quick, mu);
        const lq_stack_light expected = light_of(SLAB, &quick, mu), got = lq_model_shape_light(&shape, 0);
        for (int side = 0; side < 2; side++) {
            const lq_stack_lobe *a = side ? &got.transmitted : &got.reflected;
            const lq_stack_lobe *b = side ? &expected.transmitted : &expected.reflected;
            assert_near(a->energy, b->energy, 1e-3 * b->energy);
            assert_near(a->sin2, b->sin2, 2e-3);
            assert_near(a->mean, b->mean, 2e-3);
            assert_near(a->across, b->across, 1e-3);
        }
        lq_model_shape_free(&shape);
    }
}

static void test_names_and_refusals(void **state) {
    (void)state;
    lq_model_id id = LQ_MODELS;
    lq_error error = {""};
    lq_model_shape shape;
    assert_int_equal(lq_model_find("baked", &id, &error), LQ_OK);
    assert_int_equal(id, LQ_MODEL_BAKED);
    assert_int_equal(lq_model_find("phong", &id, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "phong"));
    assert_non_null(strstr(error.text, "b18-forward, b18-symmetric, "));
    lq_stack *stack = parse(VARNISHED);
    assert_int_equal(lq_model_shape_make(&shape, stack, &b18, 0.5, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "a lambertian base under 2 coats"));
    lq_model_shape_free(&shape);
    assert_int_equal(lq_model_shape_make(&shape, stack, &b18, 1.5, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "mu = 1.5"));
    lq_model_shape_free(&shape);
    assert_int_equal(lq_model_shape_make(&shape, stack, &symmetric, 0.5, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "a lambertian base; accepted by b18-symmetric"));
    lq_model_shape_free(&shape);
    lq_stack_free(stack);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energies_and_moments),
        cmocka_unit_test(test_baked_is_exact),
        cmocka_unit_test(test_baked_window_is_exact),
        cmocka_unit_test(test_window_below_a_smooth_coat),
        cmocka_unit_test(test_one_interface_is_direct),
        cmocka_unit_test(test_masked_lobes_lose_light),
        cmocka_unit_test(test_least_roughness),
        cmocka_unit_test(test_channels_and_ends),
        cmocka_unit_test(test_symmetric),
        cmocka_unit_test(test_moments_of_lobes),
        cmocka_unit_test(test_names_and_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
