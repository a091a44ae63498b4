/* Random walks through stacks: published values, identities, independence of the threads, and the exact
 * solver. */
#include "lacquer.h"

#include <string.h>

#include "tests/expect.h"

#define FROSTED                                                                                              \
    "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}},"                                          \
    "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": 0.05}}]}"
#define VARNISH                                                                                              \
    "{\"layers\": [{\"dielectric\": {\"n\": 1.3, \"alpha\": 0.1}, \"medium\": {\"tau\": 0.9}},"              \
    "{\"dielectric\": {\"n\": 1.8, \"alpha\": 0.4}, \"medium\": {\"tau\": 0.7}},"                            \
    "{\"lambertian\": {\"rho\": 0.7}}]}"
#define SLAB                                                                                                 \
    "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.1}, \"medium\": {\"tau\": 0.7}},"              \
    "{\"dielectric\": {\"n\": 1, \"alpha\": 0.3}}]}"
#define PANE(n) "{\"dielectric\": {\"n\": " n ", \"alpha\": 0.2}},"
#define LOSSLESS                                                                                             \
    "{\"layers\": [" PANE("1.3") PANE("1") PANE("1.3") PANE("1")                                             \
        PANE("1.3") "{\"conductor\": {\"n\": 0, \"kappa\": 3, \"alpha\": 0}}]}"

enum { SAMPLES = 200000, COSINES = 3, SEED = 11 };
static const double mu[COSINES] = {1.0, 0.6, 0.15};

static lq_stack *parse(const char *text) {
    lq_stack *stack;
    lq_error error = {""};
    if (lq_stack_parse(&stack, text, "stack", 0, &error) != LQ_OK) fail_msg("%s", error.text);
    return stack;
}

static void walk(const char *text, const lq_stack_query *query, size_t samples, lq_stack_walked *walked) {
    lq_stack *stack = parse(text);
    lq_error error = {""};
    if (lq_stack_walk(stack, query, samples, SEED, walked, NULL, &error) != LQ_OK) fail_msg("%s", error.text);
    lq_stack_free(stack);
}

/* Within five standard errors and what the other states itself. Events that fewer than a few of the samples
 * met are missing from the standard error of an energy: `rare` stands for them. */
static void assert_agrees(double got, double noise, double rare, double want, double want_error,
                          const char *what, const char *text, double at) {
    if (!(fabs(got - want) <= 5.0 * hypot(noise, rare) + want_error))
        fail_msg("%s of %s at %g: %.6f +- %.1e, expected %.6f +- %.1e", what, text, at, got, noise, want,
                 want_error);
}

/* Walks of 4e6 by other code; their own standard errors are those of the energies, and 5e-4 of sin2 and mean.
 */
static void test_published(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double reflected[COSINES], noise[COSINES], sin2[COSINES], mean[COSINES];
        double transmitted[COSINES];
    } values[] = {{FROSTED,
                   {.915303, .858651, .814363},
                   {4e-5, 7e-5, 8e-5},
                   {.16106, .59837, .71115},
                   {0.0, .61600, .64033},
                   {0}},
                  {VARNISH,
                   {.107233, .115720, .302440},
                   {9e-5, 1e-4, 2e-4},
                   {.40691, .53345, .84668},
                   {0.0, .26799, .79257},
                   {0}},
                  {SLAB,
                   {.061473, .096334, .332007},
                   {1e-4, 1e-4, 2e-4},
                   {.23455, .62635, .88463},
                   {0.0, .64862, .89774},
                   {.585676, .402038, .155681}}};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        const lq_stack_query query = {.mu = mu, .mu_count = COSINES};
        const char *text = values[i].text;
        lq_stack_walked w[COSINES];
        walk(text, &query, SAMPLES, w);
        for (int m = 0; m < COSINES; m++) {
            const lq_stack_lobe *r = &w[m].light.reflected, *noise = &w[m].reflected_noise;
            const double five = 5.0 * values[i].noise[m], moments = 5.0 * 5e-4;
            assert_agrees(r->energy, noise->energy, 0.0, values[i].reflected[m], five, "energy", text, mu[m]);
            assert_agrees(r->sin2, noise->sin2, 0.0, values[i].sin2[m], moments, "sin2", text, mu[m]);
            assert_agrees(r->mean, noise->mean, 0.0, values[i].mean[m], moments, "mean", text, mu[m]);
            assert_agrees(w[m].light.transmitted.energy, w[m].transmitted_noise.energy, 0.0,
                          values[i].transmitted[m], five, "transmitted", text, mu[m]);
        }
    }
}

/* Nothing absorbs: every path comes back, and all of it, however long it takes. */
static void test_lossless(void **state) {
    (void)state;
    const lq_stack_query query = {.mu = mu, .mu_count = COSINES};
    lq_stack_walked w[COSINES];
    walk(LOSSLESS, &query, 50000, w);
    for (int m = 0; m < COSINES; m++) {
        assert_near(w[m].light.reflected.energy, 1.0, 1e-12);
        assert_true(w[m].light.error == 0.0);
    }
    assert_agrees(w[0].light.reflected.sin2, w[0].reflected_noise.sin2, 0.0, .22480, 2.5e-3, "sin2", LOSSLESS,
                  1.0);
    walk("{\"layers\": [" PANE("1.5") "{\"dielectric\": {\"n\": 1, \"alpha\": 0}}]}", &query, 50000, w);
    for (int m = 0; m < COSINES; m++)
        assert_near(w[m].light.reflected.energy + w[m].light.transmitted.energy, 1.0, 1e-12);
}

/* Without microsurfaces there is one path and a geometric series: the azimuth and the sines are exact. */
static void test_smooth(void **state) {
    (void)state;
    static const char text[] =
        "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0}, \"medium\": {\"tau\": 0.5}},"
        "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": 0}}]}";
    const lq_stack_query query = {.mu = mu, .mu_count = COSINES, .paths = 2};
    lq_stack_walked w[2 * COSINES];
    walk(text, &query, SAMPLES, w);
    for (int m = 0; m < 2 * COSINES; m++) {
        const lq_stack_lobe *r = &w[m].light.reflected;
        const double sine2 = 1.0 - mu[m / 2] * mu[m / 2];
        assert_near(r->sin2, sine2, 1e-9);
        assert_near(r->mean, sqrt(sine2), 1e-9);
        assert_near(r->across, 0.0, 1e-12);
    }
    assert_agrees(w[0].light.reflected.energy, w[0].reflected_noise.energy, 0.0, 0.04, 0.0, "first path",
                  text, 1.0);
}

/* Light from below crosses the last medium on its way in, and once more where it turns back. */
static void test_absorbed_from_below(void **state) {
    (void)state;
    static const char text[] =
        "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0}, \"medium\": {\"tau\": 0.5}}]}";
    const lq_stack_query query = {.mu = mu, .mu_count = 1, .from_below = true};
    lq_stack_walked w[1];
    walk(text, &query, SAMPLES, w);
    assert_agrees(w[0].light.reflected.energy, w[0].reflected_noise.energy, 0.0, 0.04 * 0.25, 0.0,
                  "reflected", text, 1.0);
    assert_agrees(w[0].light.transmitted.energy, w[0].transmitted_noise.energy, 0.0, 0.96 * 0.5, 0.0,
                  "transmitted", text, 1.0);
}

static void test_threads_do_not_matter(void **state) {
    (void)state;
    lq_stack_query query = {.mu = mu, .mu_count = COSINES, .paths = 3, .threads = 1};
    lq_stack_walked one[3 * COSINES], three[3 * COSINES];
    walk(SLAB, &query, 12345, one);
    query.threads = 3;
    walk(SLAB, &query, 12345, three);
    assert_memory_equal(one, three, sizeof one);
}

/* ======================================================================================
 *                                    Against the solver
 * ====================================================================================== */

static void expect_lobe(const lq_stack_lobe *got, const lq_stack_lobe *noise, const lq_stack_lobe *want,
                        double estimate, const char *text, double at) {
    const double rare = 3.0 / SAMPLES;
    assert_agrees(got->energy, noise->energy, rare, want->energy, estimate, "energy", text, at);
    if (!(got->energy > 0.0)) return;
    assert_agrees(got->sin2, noise->sin2, rare / got->energy, want->sin2, estimate, "sin2", text, at);
    assert_agrees(got->mean, noise->mean, rare / got->energy, want->mean, estimate, "mean", text, at);
    assert_agrees(got->across, noise->across, rare / got->energy, want->across, estimate, "across", text, at);
}

static void expect_solved(const char *text, bool from_below, bool single, size_t paths) {
    static const double cosines[] = {1.0, 0.45, 0.08};
    const lq_stack_query query = {
        .mu = cosines, .mu_count = 3, .from_below = from_below, .single = single, .paths = paths};
    lq_stack_light exact[3 * LQ_STACK_CHANNELS * LQ_STACK_WALK_PATHS];
    lq_stack_walked w[3 * LQ_STACK_CHANNELS * LQ_STACK_WALK_PATHS];
    lq_error error = {""};
    lq_stack *stack = parse(text);
    const size_t per_cosine = (size_t)lq_stack_channels(stack) * (paths ? paths : 1);
    const lq_status status = lq_stack_solve(stack, &query, exact, NULL, &error);
    lq_stack_free(stack);
    if (status != LQ_OK) fail_msg("%s: %s", text, error.text);
    walk(text, &query, SAMPLES, w);
    for (size_t i = 0; i < 3 * per_cosine; i++) {
        const double at = cosines[i / per_cosine];
        expect_lobe(&w[i].light.reflected, &w[i].reflected_noise, &exact[i].reflected, exact[i].error, text,
                    at);
        expect_lobe(&w[i].light.transmitted, &w[i].transmitted_noise, &exact[i].transmitted, exact[i].error,
                    text, at);
    }
}

static void test_solver(void **state) {
    (void)state;
    expect_solved(FROSTED, false, false, 3);
    expect_solved(FROSTED, false, true, 0);
    expect_solved(SLAB, true, false, 2);
    expect_solved(SLAB, true, true, 0);
    expect_solved(VARNISH, false, true, 0);
    expect_solved(
        "{\"layers\": [{\"dielectric\": {\"n\": [1.3, 1.5, 2], \"alpha\": 0.5}, \"medium\": {\"tau\": [0.8, "
        "0, 1]}}, {\"conductor\": {\"n\": 1.45, \"kappa\": 1, \"alpha\": [0.4, 0, 1]}}]}",
        false, false, 0);
    expect_solved("{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.3, \"ndf\": \"beckmann\"}},"
                  "{\"dielectric\": {\"n\": 0.7, \"alpha\": 0}, \"medium\": {\"tau\": 0.9}}]}",
                  true, false, 0);
}

/* ======================================================================================
 *                                        Refusals
 * ====================================================================================== */

/* In the solver's own words. */
static void expect_refused(const char *text, const lq_stack_query *query) {
    lq_error walked = {""}, solved = {""};
    lq_stack_light light[COSINES];
    lq_stack_walked w[COSINES];
    lq_stack *stack;
    assert_int_equal(lq_stack_parse(&stack, text, "stack", LQ_STACK_RANGES, NULL), LQ_OK);
    assert_int_equal(lq_stack_walk(stack, query, SAMPLES, SEED, w, NULL, &walked), LQ_BAD_INPUT);
    assert_int_equal(lq_stack_solve(stack, query, light, NULL, &solved), LQ_BAD_INPUT);
    assert_string_equal(walked.text, solved.text);
    lq_stack_free(stack);
}

static void test_refusals(void **state) {
    (void)state;
    const double beyond = 1.5;
    const lq_stack_query query = {.mu = mu, .mu_count = COSINES};
    expect_refused("{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": {\"min\": 0.1, \"max\": 0.6}}}]}",
                   &query);
    expect_refused("{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": {\"x\": 0.1, \"y\": 0.6}}}]}",
                   &query);
    expect_refused("{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0}, \"medium\": {\"sigma_s\": 1, "
                   "\"depth\": 1}}]}",
                   &query);
    expect_refused(FROSTED, &(lq_stack_query){.mu = mu, .mu_count = COSINES, .from_below = true});
    expect_refused(FROSTED, &(lq_stack_query){.mu = &beyond, .mu_count = 1});
    lq_stack *stack = parse(FROSTED);
    lq_stack_walked w[COSINES];
    assert_int_equal(lq_stack_walk(stack, &query, 1, SEED, w, NULL, NULL), LQ_BAD_INPUT);
    assert_int_equal(
        lq_stack_walk(stack, &(lq_stack_query){.mu = mu, .mu_count = 1, .paths = 5}, 10, SEED, w, NULL, NULL),
        LQ_BAD_INPUT);
    lq_stack_free(stack);
}

/* Corners: grazing, nearly smooth, matched, opaque media, a mirror that holds light below total reflection.
 */
static void test_hard_cases(void **state) {
    (void)state;
    static const char *const texts[] = {
        "{\"layers\": [{\"dielectric\": {\"n\": 1, \"alpha\": 0.5}}, {\"conductor\": {\"n\": 0, \"kappa\": "
        "3, \"alpha\": 0}}]}",
        "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.001}, \"medium\": {\"tau\": 0}},"
        "{\"lambertian\": {\"rho\": 1}}]}",
        "{\"layers\": [{\"dielectric\": {\"n\": 4, \"alpha\": 0}}, {\"conductor\": {\"n\": 0, \"kappa\": 3, "
        "\"alpha\": 0.01}}]}"};
    static const double corners[COSINES] = {0.0, 1e-6, 1.0};
    const lq_stack_query query = {.mu = corners, .mu_count = COSINES};
    lq_stack_walked w[COSINES];
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        walk(texts[i], &query, 500, w);
        for (int m = 0; m < COSINES; m++) {
            const lq_stack_light *light = &w[m].light;
            assert_true(light->reflected.energy >= 0.0 && light->reflected.energy <= 1.0 + 1e-12);
            assert_true(isfinite(light->reflected.mean) && isfinite(w[m].reflected_noise.across));
            if (i != 1) assert_near(light->reflected.energy + light->error, 1.0, 1e-12);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_published),
        cmocka_unit_test(test_lossless),
        cmocka_unit_test(test_smooth),
        cmocka_unit_test(test_absorbed_from_below),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_solver),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_hard_cases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
