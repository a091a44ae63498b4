/* B18's statistical model: published energies, smooth closed forms, conservation, variances by hand,
 * variants. */
#include <math.h>

#include "fit/phase.h"
#include "microfacet/fresnel.h"
#include "microfacet/lobe.h"
#include "stack/model.h"
#include "stack/spread.h"
#include "tests/stack_light.h"

enum { LOBES = 24 };

static void run_model(const char *text, const lq_model_query *query, lq_model_lobe *lobes) {
    lq_stack *stack = parse(text);
    lq_error error = {""};
    if (lq_model_solve(stack, query, lobes, NULL, &error) != LQ_OK) fail_msg("%s: %s", text, error.text);
    lq_stack_free(stack);
}

static void lobes_at(const char *text, double mu, lq_model_variant variant, lq_model_f f,
                     lq_model_lobe *lobes) {
    run_model(text, &(lq_model_query){.mu = &mu, .mu_count = 1, .variant = variant, .f = f}, lobes);
}

static lq_stack_light model_light(const char *text, double mu, lq_model_variant variant) {
    lq_model_lobe lobes[LOBES];
    lobes_at(text, mu, variant, LQ_MODEL_F_B18, lobes);
    lq_stack *stack = parse(text);
    const lq_stack_light light = lq_model_light(stack, lobes);
    lq_stack_free(stack);
    return light;
}

static double table(const char *id, const double *point) {
    const lq_settings settings = lq_settings_default();
    double values[LQ_MAX_CHANNELS], estimate;
    lq_error error = {""};
    if (lq_eval(lq_kind_find(id, NULL), &settings, point, values, &estimate, &error) != LQ_OK)
        fail_msg("%s: %s", id, error.text);
    return values[0];
}

/* ======================================================================================
 *                                        Energies
 * ====================================================================================== */

/* An implementation of its own gave these. */
static void test_frosted_metal(void **state) {
    (void)state;
    const double mu[] = {1.0, 0.6, 0.15}, energy[] = {0.927, 0.903, 0.782};
    for (int m = 0; m < 3; m++)
        assert_near(model_light(FROSTED, mu[m], LQ_MODEL_PAPER).reflected.energy, energy[m], 6e-4);
}

/* What no second interface meddles with is Fresnel's. */
static void test_smooth_is_fresnel(void **state) {
    (void)state;
    for (double mu = 0.1; mu <= 1.0; mu += 0.3) {
        double cosine;
        const double a = lq_fresnel_dielectric(mu, 1.5, &cosine);
        const lq_stack_light one = model_light(LAYERS(COATING(1.5, 0, 0.8)), mu, LQ_MODEL_PAPER);
        assert_near(one.reflected.energy, a, 1e-4);
        assert_near(one.transmitted.energy, (1.0 - a) * pow(0.8, 1.0 / cosine), 1e-4);
        assert_near(one.transmitted.mean, sqrt(1.0 - cosine * cosine), 1e-9);
        const lq_stack_light base =
            model_light(LAYERS(COATING(1, 0, 0.8) "," CONDUCTOR(0.2, 3.9, 0)), mu, LQ_MODEL_PAPER);
        assert_near(base.reflected.energy, pow(0.8, 2.0 / mu) * lq_fresnel_conductor(mu, 0.2, 3.9), 1e-4);
        assert_near(base.reflected.sin2, 1.0 - mu * mu, 1e-9);
        assert_near(base.reflected.mean, sqrt(1.0 - mu * mu), 1e-9);
        assert_near(base.reflected.across, 0.0, 1e-9);
    }
}

/* An interface of reflectance a outside and `back` inside, over a medium and a base of reflectance b. */
static double coated(double a, double back, double t, double b) {
    return a + (1.0 - a) * (1.0 - back) * t * t * b / (1.0 - back * t * t * b);
}

/* tir-pass takes Fresnel reflection off once more, even from smooth layers: what leaves is (1 - a)^2. */
static void test_smooth_coat_counts_fresnel_twice(void **state) {
    (void)state;
    const char *stack = LAYERS(COATING(1.5, 0, 0.8) "," CONDUCTOR(0.2, 3.9, 0));
    for (double mu = 0.1; mu <= 1.0; mu += 0.3) {
        double cosine;
        const double a = lq_fresnel_dielectric(mu, 1.5, &cosine), t = pow(0.8, 1.0 / cosine);
        const double b = lq_fresnel_conductor(cosine, 0.2 / 1.5, 3.9 / 1.5);
        const double got = model_light(stack, mu, LQ_MODEL_PAPER).reflected.energy;
        assert_near(got, coated(a, 1.0 - (1.0 - a) * (1.0 - a), t, b), 1e-4);
        assert_true(got < coated(a, a, t, b) - 1e-3);
    }
}

static void test_white_furnace(void **state) {
    (void)state;
    static const char *const stacks[] = {WHITE, LAYERS(DIELECTRIC(1.5, 0.6) "," CONDUCTOR(0, 2, 0.3)),
                                         LAYERS(DIELECTRIC(1.5, 0.3) "," LAMBERTIAN(1)),
                                         LAYERS(DIELECTRIC(1.7, 0.3) "," DIELECTRIC(1, 0.3))};
    const double mu[] = {1.0, 0.5, 0.1};
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++)
        for (int m = 0; m < 3; m++)
            for (lq_model_variant v = LQ_MODEL_PAPER; v <= LQ_MODEL_RELEASED; v++) {
                const lq_stack_light light = model_light(stacks[i], mu[m], v);
                const double all = light.reflected.energy + light.transmitted.energy;
                assert_near(all, 1.0, 5e-3);
            }
}

/* Reflection, TIR and addition neither make nor lose light, seen from below; and reciprocal media do both
 * ways. */
static void test_adding_conserves(void **state) {
    (void)state;
    lq_model_sum sum = lq_model_nothing();
    const lq_model_interface top = {.r12.energy = 0.04,
                                    .t12.energy = 0.96,
                                    .r21.energy = 0.3,
                                    .t21.energy = 0.7,
                                    .j12 = 1.5,
                                    .j21 = 1 / 1.5};
    lq_model_add(&sum, &top);
    for (int k = 0; k < 5; k++) {
        assert_near(sum.ri0.energy + sum.ti0.energy, 1.0, 1e-14);
        const double before = sum.ti0.energy;
        lq_model_reflect_back(&sum, 0.8);
        assert_near(sum.ti0.energy, 0.8 * before, 1e-15);
        assert_near(sum.ri0.energy + sum.ti0.energy, 1.0, 1e-14);
        lq_model_add(&sum, &top);
        assert_near(sum.r0i.energy + sum.t0i.energy, 1.0, 1e-14);
    }
}

/* D22 eq. 3 is exact but for how light that comes back to the interface is spread, which no Lambertian base
 * sees. */
static void test_coated_lambertian(void **state) {
    (void)state;
    const char *stack = LAYERS(COATING(1.5, 0.3, 0.8) "," LAMBERTIAN(0.7));
    for (double mu = 0.2; mu < 1.0; mu += 0.4) {
        lq_model_lobe lobes[LOBES];
        lobes_at(stack, mu, LQ_MODEL_PAPER, LQ_MODEL_F_B18, lobes);
        const double exact = light_at(stack, mu, 1e-4).reflected.energy;
        assert_near(lobes[0].energy + lobes[1].energy, exact, 3e-4);
        assert_near(lobes[1].mean, 0.0, 0.0);
    }
    const lq_stack_light bare = model_light(LAYERS(LAMBERTIAN(0.7)), 0.3, LQ_MODEL_PAPER);
    assert_near(bare.reflected.energy, 0.7, 1e-4);
    lq_model_lobe base[LOBES];
    lobes_at(LAYERS(LAMBERTIAN(0.7)), 0.3, LQ_MODEL_PAPER, LQ_MODEL_F_B18, base);
    assert_near(lq_lobe_variance(lq_ndf_find("ggx"), base[0].alpha), 0.5, 1e-3);
    assert_near(bare.reflected.mean, 0.0, 1e-9);
}

/* ======================================================================================
 *                                       Variances
 * ====================================================================================== */

static void test_interface_keeps_its_roughness(void **state) {
    (void)state;
    static const double alpha[] = {0.0, 1e-3, 0.05, 0.3, 0.7, 0.9};
    for (lq_model_f f = LQ_MODEL_F_EXACT; f <= LQ_MODEL_F_B18; f++)
        for (size_t i = 0; i < sizeof alpha / sizeof *alpha; i++) {
            char text[128];
            lq_model_lobe lobes[LOBES];
            snprintf(text, sizeof text, LAYERS("{\"conductor\": {\"n\": 1.5, \"kappa\": 2, \"alpha\": %g}}"),
                     alpha[i]);
            lobes_at(text, 0.7, LQ_MODEL_PAPER, f, lobes);
            assert_near(lobes[0].alpha, alpha[i], 1e-8);
            if (f == LQ_MODEL_F_B18)
                assert_near(lobes[0].variance, pow(alpha[i], 1.1) / (1.0 - pow(alpha[i], 1.1)), 1e-12);
        }
}

static double b18(double alpha) {
    return pow(alpha, 1.1) / (1.0 - pow(alpha, 1.1));
}

/* Up + J (down + base + again (base + coat from inside)): eq. 47 of one coat, written out. */
static double coat_variance(double mu, bool released, double again) {
    const double eta = 1.5, a = 0.2, out = sqrt(1.0 - (1.0 - mu * mu) / (eta * eta));
    const double tilt = released ? 1.0 : mu / out, jacobian = eta * out / mu;
    const double down = b18(0.5 * a * fabs(1.0 - tilt / eta)), up = b18(0.5 * a * fabs(1.0 - eta / tilt));
    return up + jacobian * (down + b18(0.05) + again * (b18(0.05) + b18(a)));
}

static void test_variance_of_a_coat(void **state) {
    (void)state;
    for (double mu = 0.4; mu <= 1.0; mu += 0.3) {
        const double out = sqrt(1.0 - (1.0 - mu * mu) / 2.25);
        lq_model_lobe lobes[LOBES];
        lobes_at(FROSTED, mu, LQ_MODEL_PAPER, LQ_MODEL_F_B18, lobes);
        const double r21 = table("fgd-dielectric", (double[]){out, 0.2, 1.0 / 1.5});
        const double pass = table("tir-pass", (double[]){out, 0.05, 1.0 / 1.5});
        const double base = table("fgd", (double[]){out, 0.05, 0.2 / 1.5, 3.9 / 1.5});
        const double back = base * (1.0 - pass * (1.0 - r21));
        assert_near(lobes[1].variance, coat_variance(mu, false, back / (1.0 - back)), 1e-3);
        assert_near(lobes[1].alpha, pow(lobes[1].variance / (1 + lobes[1].variance), 1 / 1.1), 1e-12);
    }
}

/* Eq. 47-51 of a second interface, term by term: what goes down and up carries the Jacobians passed so far.
 */
static void test_variances_of_a_second_interface(void **state) {
    (void)state;
    const lq_model_interface one = {{0.1, 0.01}, {0.9, 0.02}, {0.2, 0.03}, {0.8, 0.04}, 1.5, 1 / 1.5};
    const lq_model_interface two = {{0.5, 0.05}, {0.5, 0.06}, {0.4, 0.07}, {0.6, 0.08}, 0.8, 1 / 0.8};
    lq_model_sum sum = lq_model_nothing();
    assert_near(lq_model_add(&sum, &one).variance, 0.01, 1e-15);
    assert_near(sum.t0i.variance, 0.02, 1e-15);
    assert_near(sum.ti0.variance, 0.04, 1e-15);
    assert_near(sum.ri0.variance, 0.03, 1e-15);
    const double again = 0.2 * 0.5 / (1 - 0.2 * 0.5), round = again * (0.05 + 0.03);
    const double inner = 0.6 * 0.2 * 0.5 / (1 - 0.2 * 0.5);
    const lq_flow lobe = lq_model_add(&sum, &two);
    assert_near(lobe.energy, 0.9 * 0.5 * 0.8 / (1 - 0.2 * 0.5), 1e-15);
    assert_near(lobe.variance, 0.04 + 1.5 * (0.02 + 0.05 + round), 1e-15);
    assert_near(sum.r0i.variance, (0.1 * 0.01 + lobe.energy * lobe.variance) / (0.1 + lobe.energy), 1e-15);
    assert_near(sum.t0i.variance, 0.8 * 0.02 + 0.06 + 0.8 * round, 1e-15);
    assert_near(sum.ti0.variance, 0.04 + 0.08 / 1.5 + round / 1.5, 1e-15);
    assert_near(sum.ri0.variance, (0.4 * 0.07 + inner * (0.06 + 0.8 * (0.08 + 0.03 + round))) / (0.4 + inner),
                1e-15);
    assert_near(sum.j0i, 1.5 * 0.8, 1e-15);
    assert_near(sum.ji0, 1 / (1.5 * 0.8), 1e-15);
}

/* The lobe behind the columns sin2, mean and across, against the exact solver's first hit of a rough mirror.
 */
static void test_moments_of_a_lobe(void **state) {
    (void)state;
    for (double mu = 0.4; mu <= 1.0; mu += 0.3) {
        const lq_stack_query query = {.mu = &mu, .mu_count = 1, .single = true, .tolerance = 1e-4};
        lq_stack_light light;
        solve(LAYERS(CONDUCTOR(0, 2, 0.3)), &query, &light);
        const lq_stack_lobe lobe = lq_spread_lobe(mu, 0.3);
        assert_near(lobe.sin2, light.reflected.sin2, 1e-3);
        assert_near(lobe.mean, light.reflected.mean, 1e-3);
        assert_near(lobe.across, light.reflected.across, 1e-3);
    }
}

/* ======================================================================================
 *                                     Media that scatter
 * ====================================================================================== */

/* A mirror under such a medium, without an interface: two crossings. */
static void test_two_crossings(void **state) {
    (void)state;
    const char *text =
        LAYERS("{\"dielectric\": {\"n\": 1, \"alpha\": 0}, \"medium\": {\"sigma_a\": 0.2, \"sigma_s\": 0.5, "
               "\"depth\": 0.4, \"g\": 0.9}}," CONDUCTOR(0, 1, 0));
    for (double mu = 0.25; mu <= 1.0; mu += 0.25)
        for (lq_model_variant v = LQ_MODEL_PAPER; v <= LQ_MODEL_RELEASED; v++) {
            lq_model_lobe lobes[LOBES];
            lobes_at(text, mu, v, LQ_MODEL_F_B18, lobes);
            const double once = 0.2 / mu, spread = pow(0.1 / 0.9, 0.8) / 1.9;
            const double crossing = (1.0 + once) * exp(-once - 0.08 / mu);
            assert_near(lobes[1].energy, crossing * crossing, 1e-6);
            const double share = v == LQ_MODEL_PAPER ? once / (1.0 + once) : 1.0;
            assert_near(lobes[1].variance, 2.0 * spread * share, 1e-12);
        }
}

/* Without scattering, a medium said by sigma is one said by tau, in both variants. */
static void test_medium_without_scattering(void **state) {
    (void)state;
    const char *sigma = LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}, \"medium\": {\"sigma_a\": 1, "
                               "\"depth\": 0.5, \"g\": 0.9}}," CONDUCTOR(0.2, 3.9, 0.05));
    char tau[200];
    snprintf(tau, sizeof tau,
             LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}, \"medium\": {\"tau\": %.17g}}," CONDUCTOR(
                 0.2, 3.9, 0.05)),
             exp(-0.5));
    for (lq_model_variant v = LQ_MODEL_PAPER; v <= LQ_MODEL_RELEASED; v++) {
        lq_model_lobe one[LOBES], other[LOBES];
        lobes_at(sigma, 0.6, v, LQ_MODEL_F_B18, one);
        lobes_at(tau, 0.6, v, LQ_MODEL_F_B18, other);
        assert_near(one[1].energy, other[1].energy, 1e-14);
        assert_near(one[1].variance, other[1].variance, 1e-14);
    }
}

/* sigma_g: B18's fit at its printed values, and the exact one spreads as its phase function. */
static void test_spread_of_a_phase_function(void **state) {
    (void)state;
    static const double g[] = {0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99};
    static const double fit[] = {5.27, 1.52, 0.667, 0.299, 0.183, 0.091, 0.0486, 0.0127};
    lq_model_mapping exact, b18_fit;
    lq_error error = {""};
    assert_int_equal(lq_model_mapping_make(&exact, LQ_MODEL_F_EXACT, &error), LQ_OK);
    assert_int_equal(lq_model_mapping_make(&b18_fit, LQ_MODEL_F_B18, &error), LQ_OK);
    for (int i = 0; i < 8; i++) {
        const double alpha = lq_model_roughness(&exact, lq_model_phase(&exact, g[i]));
        assert_near(lq_lobe_variance(lq_ndf_find("ggx"), alpha), lq_phase_variance(g[i], NULL), 1e-6);
        assert_near(lq_model_phase(&b18_fit, g[i]), fit[i], 0.006 * fit[i]);
    }
}

/* ======================================================================================
 *                                        Variants
 * ====================================================================================== */

static lq_model_interface dielectric(lq_model_variant variant, double mu) {
    lq_model_mapping mapping;
    lq_error error = {""};
    assert_int_equal(lq_model_mapping_make(&mapping, LQ_MODEL_F_B18, &error), LQ_OK);
    const lq_model_tables tables = {.variant = variant, .mapping = &mapping};
    lq_model_ray ray = {mu, 1.0};
    lq_model_interface interface;
    const double looked_up = lq_model_lookup_alpha(&tables, 0.1, 0.2);
    assert_near(looked_up, variant == LQ_MODEL_PAPER ? 0.2 : pow(1 - 1 / (1.1 + b18(0.2)), 1 / 1.1), 1e-12);
    assert_int_equal(lq_model_dielectric(&tables, &ray, 1.5, 0.2, looked_up, &interface, &error), LQ_OK);
    return interface;
}

static void test_released_departs(void **state) {
    (void)state;
    const lq_model_interface paper = dielectric(LQ_MODEL_PAPER, 0.5);
    const lq_model_interface released = dielectric(LQ_MODEL_RELEASED, 0.5);
    const lq_model_interface normal = dielectric(LQ_MODEL_PAPER, 1.0);
    assert_near(released.r21.energy, released.r12.energy, 0.0);
    assert_near(released.t21.energy, released.t12.energy, 0.0);
    assert_true(fabs(paper.r21.energy - paper.r12.energy) > 1e-2);
    assert_near(released.t12.variance, normal.t12.variance, 1e-15);
    assert_near(released.t21.variance, normal.t21.variance, 1e-15);
    assert_near(released.t12.variance, b18(0.5 * 0.2 * (1.0 - 1.0 / 1.5)), 1e-12);
    assert_near(released.t21.variance, b18(0.5 * 0.2 * 0.5), 1e-12);
    assert_true(fabs(paper.t21.variance - released.t21.variance) > 1e-2);
    assert_true(fabs(paper.r12.energy - released.r12.energy) > 1e-4);
}

/* ======================================================================================
 *                                  Limits, channels, refusals
 * ====================================================================================== */

static void test_hard_cases(void **state) {
    (void)state;
    static const char *const stacks[] = {
        LAYERS(DIELECTRIC(1.5, 1) "," COATING(1, 1, 0) "," CONDUCTOR(0.2, 3.9, 1)),
        LAYERS(DIELECTRIC(0.5, 0.3) "," DIELECTRIC(1.5, 0) "," DIELECTRIC(1.2, 0.5)),
        LAYERS(COATING(0.5, 0, 0.5) "," LAMBERTIAN(1)), LAYERS(DIELECTRIC(1, 0) "," COATING(1, 0.5, 0.1))};
    const double mu[] = {0.0, 1e-6, 0.3, 0.9};
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++)
        for (int v = 0; v < 8; v++) {
            lq_model_lobe lobes[LOBES];
            lobes_at(stacks[i], mu[v / 2], (lq_model_variant)(v % 2),
                     v > 0 ? LQ_MODEL_F_B18 : LQ_MODEL_F_EXACT, lobes);
            lq_stack *stack = parse(stacks[i]);
            double sum = 0.0;
            for (size_t k = 0; k < lq_model_lobe_count(stack); k++) {
                assert_true(lobes[k].energy >= 0.0 && lobes[k].alpha >= 0.0 && lobes[k].alpha <= 1.0);
                assert_true(lobes[k].variance >= 0.0 && isfinite(lobes[k].variance));
                sum += lobes[k].energy;
            }
            const lq_stack_light light = lq_model_light(stack, lobes);
            assert_true(sum <= 1.0 + 1e-4 && isfinite(light.reflected.sin2 + light.transmitted.mean));
            lq_stack_free(stack);
        }
}

static void test_channels_and_threads(void **state) {
    (void)state;
    const char *rgb = LAYERS(
        "{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}, \"medium\": {\"tau\": [1, 0.5, 0.2]}}," CONDUCTOR(
            0.2, 3.9, 0.05));
    const char *green = LAYERS(COATING(1.5, 0.2, 0.5) "," CONDUCTOR(0.2, 3.9, 0.05));
    const double mu[] = {0.8, 0.3};
    lq_model_lobe one[2 * 3 * 3], two[2 * 3 * 3], alone[3];
    lq_model_query query = {.mu = mu, .mu_count = 2, .threads = 1};
    run_model(rgb, &query, one);
    query.threads = 2;
    run_model(rgb, &query, two);
    assert_memory_equal(one, two, sizeof one);
    lobes_at(green, mu[1], LQ_MODEL_PAPER, LQ_MODEL_F_EXACT, alone);
    assert_memory_equal(one + (1 * 3 + 1) * 3, alone, sizeof alone);
}

/* Every table goes by the source, and its refusal ends the model. */
typedef struct seen {
    int fgd, dielectric, pass;
    bool refuse;
} seen;

static lq_status look(void *user, const lq_kind *kind, const double *point, double *values, lq_error *error) {
    seen *s = user;
    (void)point;
    if (s->refuse) {
        snprintf(error->text, sizeof error->text, "no %s here", kind->id);
        return LQ_BAD_INPUT;
    }
    if (strcmp(kind->id, "fgd") == 0) s->fgd++;
    else if (strcmp(kind->id, "fgd-dielectric") == 0) s->dielectric++;
    else if (strcmp(kind->id, "tir-pass") == 0) s->pass++;
    values[0] = 0.5;
    return LQ_OK;
}

static void test_tables_of_a_source(void **state) {
    (void)state;
    const double mu = 0.5;
    seen s = {0};
    const lq_model_source source = {&s, look};
    const lq_model_query query = {
        .mu = &mu, .mu_count = 1, .f = LQ_MODEL_F_B18, .source = &source, .threads = 1};
    lq_model_lobe lobes[LOBES];
    run_model(FROSTED, &query, lobes);
    assert_int_equal(s.dielectric, 2);
    assert_int_equal(s.fgd, 1);
    assert_int_equal(s.pass, 1);
    /* r21 = 1/2 + (1 - 1/2) 1/2, t21 = 1/4. */
    assert_near(lobes[0].energy, 0.5, 0.0);
    assert_near(lobes[1].energy, 0.5 * 0.5 * 0.25 / (1.0 - 0.75 * 0.5), 1e-15);
    s.refuse = true;
    lq_error error = {""};
    lq_stack *stack = parse(FROSTED);
    assert_int_equal(lq_model_solve(stack, &query, lobes, NULL, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "no fgd-dielectric here"));
    lq_stack_free(stack);
}

static void test_refused(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {LAYERS("{\"conductor\": {\"n\": 1, \"kappa\": 1, \"alpha\": {\"x\": 0.3, \"y\": 0.1}}}"),
         "layer 1 is anisotropic"},
        {LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0}, \"medium\": {\"sigma_a\": 0, \"sigma_s\": 1, "
                "\"depth\": 1, \"g\": -0.5}}"),
         "layer 1 scatters with g = -0.5"},
        {LAYERS(
             "{\"dielectric\": {\"n\": 1.5, \"alpha\": 0}, \"medium\": {\"sigma_s\": 1, \"depth\": 1, \"g\": "
             "0.5}}," LAMBERTIAN(1)),
         "layer 1 has a medium that scatters, over a lambertian base"},
        {LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.1, \"ndf\": \"beckmann\"}}"),
         "layer 1 has the NDF beckmann"},
        {VARNISHED, "a lambertian base under 2 coats"}};
    const double mu = 0.5, beyond = 1.5;
    lq_model_lobe lobes[LOBES];
    for (size_t i = 0; i <= sizeof cases / sizeof *cases; i++) {
        const bool last = i == sizeof cases / sizeof *cases;
        const lq_model_query query = {.mu = last ? &beyond : &mu, .mu_count = 1};
        lq_error error = {""};
        lq_stack *stack = parse(last ? FROSTED : cases[i][0]);
        assert_int_equal(lq_model_solve(stack, &query, lobes, NULL, &error), LQ_BAD_INPUT);
        if (!strstr(error.text, last ? "mu = 1.5" : cases[i][1])) fail_msg("%s", error.text);
        lq_stack_free(stack);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frosted_metal),
        cmocka_unit_test(test_smooth_is_fresnel),
        cmocka_unit_test(test_smooth_coat_counts_fresnel_twice),
        cmocka_unit_test(test_white_furnace),
        cmocka_unit_test(test_adding_conserves),
        cmocka_unit_test(test_coated_lambertian),
        cmocka_unit_test(test_interface_keeps_its_roughness),
        cmocka_unit_test(test_variance_of_a_coat),
        cmocka_unit_test(test_variances_of_a_second_interface),
        cmocka_unit_test(test_moments_of_a_lobe),
        cmocka_unit_test(test_two_crossings),
        cmocka_unit_test(test_medium_without_scattering),
        cmocka_unit_test(test_spread_of_a_phase_function),
        cmocka_unit_test(test_released_departs),
        cmocka_unit_test(test_hard_cases),
        cmocka_unit_test(test_channels_and_threads),
        cmocka_unit_test(test_tables_of_a_source),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
