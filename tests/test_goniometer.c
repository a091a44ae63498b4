/* The virtual goniophotometer: energies against the exact solver, known slices, independence of the threads.
 */
#include "validate/goniometer.h"

#include "microfacet/ndf.h"
#include "validate/slice_model.h"

#include <stdlib.h>
#include <string.h>

#include "tests/expect.h"

#define TINTED                                                                                               \
    "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}, \"medium\": {\"tau\": [0.8, 0.5, 0.3]}},"  \
    "{\"conductor\": {\"n\": [0.14, 0.43, 1.38], \"kappa\": [3.7, 2.5, 1.9], \"alpha\": 0.05}}]}"
#define APART                                                                                                \
    "{\"layers\": [{\"dielectric\": {\"n\": [1.3, 1.5, 2], \"alpha\": 0.3}},"                                \
    "{\"lambertian\": {\"rho\": [0.9, 0.5, 0]}}]}"
#define SLAB                                                                                                 \
    "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.1}, \"medium\": {\"tau\": [0.7, 1, 0.2]}},"    \
    "{\"dielectric\": {\"n\": 1, \"alpha\": 0.3}}]}"
#define MATTE  "{\"layers\": [{\"lambertian\": {\"rho\": 0.5}}]}"
#define MIRROR "{\"layers\": [{\"conductor\": {\"n\": 0, \"kappa\": 3, \"alpha\": 0}}]}"

enum { SAMPLES = 100000, SEED = 5 };

static lq_stack *parse(const char *text) {
    lq_stack *stack;
    lq_error error = {""};
    if (lq_stack_parse(&stack, text, "stack", 0, &error) != LQ_OK) fail_msg("%s", error.text);
    return stack;
}

static lq_gonio measure(const char *text, double mu, bool single, int threads) {
    lq_stack *stack = parse(text);
    lq_error error = {""};
    lq_gonio gonio;
    const lq_stack_query query = {.mu = &mu, .mu_count = 1, .single = single, .threads = threads};
    if (lq_gonio_measure(&gonio, stack, &query, LQ_SLICE_LAYOUTS, SAMPLES, SEED, NULL, &error) != LQ_OK)
        fail_msg("%s", error.text);
    lq_stack_free(stack);
    return gonio;
}

/* ======================================================================================
 *                                       Energies
 * ====================================================================================== */

static void expect_energy(const lq_gonio *g, int side, int order, int channel, const lq_stack_light *exact,
                          const char *text) {
    const lq_gonio_part part = {.side = side, .from = order, .to = order, .channel = channel};
    const double want = side ? exact->transmitted.energy : exact->reflected.energy;
    for (int layout = 0; layout < LQ_SLICE_LAYOUTS; layout++) {
        double noise;
        const double got = lq_gonio_energy(g, (lq_slice_layout)layout, &part, &noise);
        if (!(fabs(got - want) <= 5.0 * hypot(noise, 3.0 / SAMPLES) + exact->error))
            fail_msg("%s, side %d, order %d, channel %d: %.6f +- %.1e, exact %.6f", text, side, order,
                     channel, got, noise, want);
    }
}

static void expect_solved(const char *text, double mu, bool single) {
    const lq_stack_query query = {.mu = &mu, .mu_count = 1, .single = single, .paths = LQ_GONIO_ORDERS};
    lq_stack_light exact[LQ_STACK_CHANNELS * LQ_GONIO_ORDERS];
    lq_stack *stack = parse(text);
    lq_gonio g = measure(text, mu, single, 0);
    assert_int_equal(lq_stack_solve(stack, &query, exact, NULL, NULL), LQ_OK);
    assert_int_equal(g.sides, strcmp(text, SLAB) == 0 ? 2 : 1);
    for (int side = 0; side < g.sides; side++)
        for (int c = 0; c < g.channels; c++)
            for (int order = 0; order < LQ_GONIO_ORDERS; order++)
                expect_energy(&g, side, order, c, &exact[c * LQ_GONIO_ORDERS + order], text);
    lq_gonio_free(&g);
    lq_stack_free(stack);
}

static void test_energies(void **state) {
    (void)state;
    expect_solved(TINTED, 0.5, false);
    expect_solved(TINTED, 0.9, true);
    expect_solved(APART, 0.3, false);
    expect_solved(SLAB, 0.7, false);
}

/* Nothing absorbs: every ray comes back whole. */
static void test_white(void **state) {
    (void)state;
    static const char *const texts[] = {
        "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.3}}, {\"lambertian\": {\"rho\": 1}}]}",
        "{\"layers\": [{\"dielectric\": {\"n\": 1.3, \"alpha\": 0.2}}, {\"dielectric\": {\"n\": 2, "
        "\"alpha\": 0.6}}, {\"conductor\": {\"n\": 0, \"kappa\": 3, \"alpha\": [0.1, 0.1, 0.1]}}]}"};
    for (size_t i = 0; i < 2; i++) {
        lq_gonio g = measure(texts[i], 0.4, false, 0);
        for (int c = 0; c < g.channels; c++) {
            const lq_gonio_part all = {.to = LQ_GONIO_ORDERS - 1, .channel = c};
            assert_near(lq_gonio_energy(&g, LQ_SLICE_CLASSIC, &all, NULL), 1.0, 1e-12);
        }
        assert_true(lq_gonio_lost(&g) == 0.0);
        lq_gonio_free(&g);
    }
}

/* ======================================================================================
 *                                        Slices
 * ====================================================================================== */

/* rho cos theta / pi everywhere, in either layout: the squared deviations are as large as the noise says. */
static void test_matte(void **state) {
    (void)state;
    static double solid[LQ_SLICE_CELLS];
    static float value[LQ_SLICE_CELLS], noise[LQ_SLICE_CELLS];
    lq_gonio g = measure(MATTE, 0.6, false, 0);
    const lq_gonio_part part = {.side = 0};
    for (int layout = 0; layout < LQ_SLICE_LAYOUTS; layout++) {
        double deviation = 0.0, variance = 0.0, solids = 0.0;
        lq_slice_solids((lq_slice_layout)layout, g.mu, solid);
        lq_gonio_slice(&g, (lq_slice_layout)layout, &part, solid, value, noise);
        for (size_t cell = 0; cell < LQ_SLICE_CELLS; cell++) {
            double want = 0.0;
            lq_slice_point points[LQ_SLICE_POINTS];
            lq_slice_points((lq_slice_layout)layout, g.mu, cell, points);
            for (int i = 0; i < LQ_SLICE_POINTS; i++)
                want += 0.5 / 3.14159265358979 * fmax(points[i].z, 0.0) * points[i].solid;
            const double off = value[cell] * solid[cell] - want, sigma = noise[cell] * solid[cell];
            deviation += off * off;
            variance += sigma * sigma;
            solids += solid[cell];
        }
        assert_near(deviation / variance, 1.0, 0.05);
        /* The hemisphere; or of the sphere what half vectors of the upper hemisphere lead to. */
        assert_near(solids / (2.0 * 3.14159265358979 * (layout == LQ_SLICE_CLASSIC ? 1.0 : 1.0 + g.mu)), 1.0,
                    1e-4);
    }
    lq_gonio_free(&g);
}

static void test_mirror(void **state) {
    (void)state;
    lq_gonio g = measure(MIRROR, cos(40.5 * 3.14159265358979 / 180.0), false, 0);
    assert_int_equal(lq_slice_cell(LQ_SLICE_CLASSIC, g.mu, lq_sine(g.mu), 1e-9, g.mu), 40 * LQ_SLICE_PHI);
    assert_int_equal(lq_slice_cell(LQ_SLICE_HALF, g.mu, lq_sine(g.mu) + 1e-6, 1e-9, g.mu), 0);
    static double solid[LQ_SLICE_CELLS];
    static float value[LQ_SLICE_CELLS];
    lq_slice_solids(LQ_SLICE_CLASSIC, g.mu, solid);
    lq_gonio_slice(&g, LQ_SLICE_CLASSIC, &(lq_gonio_part){.side = 0}, solid, value, NULL);
    const size_t peak = 40 * LQ_SLICE_PHI;
    assert_near(value[peak] * solid[peak], 1.0, 1e-6);
    lq_gonio_free(&g);
}

/* A direction lies in the cell whose point it is, in both layouts. */
static void test_cells_and_points(void **state) {
    (void)state;
    for (int layout = 0; layout < LQ_SLICE_LAYOUTS; layout++)
        for (size_t cell = 3; cell < LQ_SLICE_CELLS; cell += 17) {
            lq_slice_point points[LQ_SLICE_POINTS];
            lq_slice_points((lq_slice_layout)layout, 0.7, cell, points);
            for (int i = 0; i < LQ_SLICE_POINTS; i++) {
                const lq_slice_point *p = &points[i];
                if (!(p->z > 0.0 && p->solid > 0.0)) continue;
                assert_near(p->x * p->x + p->y * p->y + p->z * p->z, 1.0, 1e-12);
                assert_int_equal(lq_slice_cell((lq_slice_layout)layout, 0.7, p->x, p->y, p->z), cell);
            }
        }
}

/* What noise adds is taken off: of a true model nothing is left, of one that is off by as much everywhere
 * that much; and the light that was inside is apart from the direct. */
static void test_rmse(void **state) {
    (void)state;
    enum { OFF = 1 };
    static double solid[LQ_SLICE_CELLS];
    static lq_slice_pair measured, model;
    lq_gonio g = measure(MATTE, 0.6, false, 0);
    lq_slice_solids(LQ_SLICE_CLASSIC, g.mu, solid);
    lq_slice_fold(&g, 0, false, LQ_SLICE_CLASSIC, solid, &measured);
    for (size_t i = 0; i < LQ_FOLDED_CELLS; i++) {
        lq_slice_point points[LQ_SLICE_POINTS];
        double flux = 0.0;
        const size_t cell = i / LQ_FOLDED_PHI * LQ_SLICE_PHI + i % LQ_FOLDED_PHI;
        lq_slice_points(LQ_SLICE_CLASSIC, g.mu, cell, points);
        for (int k = 0; k < LQ_SLICE_POINTS; k++)
            flux += 0.5 / 3.14159265358979 * points[k].z * points[k].solid;
        model.value[LQ_PART_DIRECT][0][i] = (float)(flux / solid[cell]);
    }
    const lq_slice_error right = lq_slice_compare(&model, &measured, 1, true);
    assert_true(right.noise > 0.01 && right.rmse < 0.25 * right.noise);
    for (size_t i = 0; i < LQ_FOLDED_CELLS; i++) model.value[LQ_PART_DIRECT][0][i] += OFF;
    assert_near(lq_slice_compare(&model, &measured, 1, true).rmse, OFF, 0.01);
    assert_near(lq_slice_compare(&model, &measured, 1, false).rmse, 0.0, 0.0);
    lq_slice_fold(&g, 0, true, LQ_SLICE_CLASSIC, solid, &measured);
    assert_true(lq_slice_compare(&model, &measured, 1, false).rmse > 0.05);
    lq_gonio_free(&g);
}

static void test_threads(void **state) {
    (void)state;
    lq_gonio one = measure(SLAB, 0.7, false, 1), three = measure(SLAB, 0.7, false, 3);
    const size_t size = (size_t)LQ_SLICE_CELLS * 3 * 2 * LQ_GONIO_ORDERS * LQ_SLICE_LAYOUTS * 2;
    assert_memory_equal(one.sums, three.sums, size * sizeof *one.sums);
    lq_gonio_free(&one);
    lq_gonio_free(&three);
}

static void test_refusals(void **state) {
    (void)state;
    const double mu = 0.5;
    lq_stack *stack = parse(MATTE);
    lq_gonio g;
    lq_error error = {""};
    const lq_stack_query below = {.mu = &mu, .mu_count = 1, .from_below = true};
    assert_int_equal(lq_gonio_measure(&g, stack, &below, LQ_SLICE_LAYOUTS, SAMPLES, SEED, NULL, &error),
                     LQ_BAD_INPUT);
    lq_gonio_free(&g);
    const lq_stack_query query = {.mu = &mu, .mu_count = 1};
    assert_int_equal(lq_gonio_measure(&g, stack, &query, LQ_SLICE_LAYOUTS, 1, SEED, NULL, &error),
                     LQ_BAD_INPUT);
    lq_gonio_free(&g);
    lq_stack_free(stack);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energies),
        cmocka_unit_test(test_white),
        cmocka_unit_test(test_matte),
        cmocka_unit_test(test_mirror),
        cmocka_unit_test(test_cells_and_points),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_rmse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
