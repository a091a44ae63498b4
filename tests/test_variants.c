/* What is planted in a table is named: another definition, nodes half a cell off, one wrong entry, a false
 * zero. */
#include "tests/expect.h"
#include "tests/uniform.h"

#include "validate/pattern.h"
#include "validate/variants.h"

#include <stdlib.h>
#include <string.h>

enum { MUS = 24, ALPHAS = 12, ETAS = 6 };

static const lq_kind *kind_of(const char *id) {
    lq_error error = {""};
    const lq_kind *kind = lq_kind_find(id, &error);
    if (!kind) fail_msg("%s", error.text);
    return kind;
}

static void make_axes(const lq_kind *kind, lq_axis *axes) {
    for (int a = 0; a < kind->axis_count; a++) {
        const lq_axis_info *info = &kind->axes[a];
        const bool eta = strcmp(info->name, "eta") == 0;
        const size_t size = strcmp(info->name, "mu") == 0 ? MUS : eta ? ETAS : ALPHAS;
        assert_int_equal(lq_axis_make(&axes[a], info->name, eta ? 0.3 : 0.0, eta ? 0.9 : 1.0, size,
                                      LQ_MAP_LINEAR, 0.0, NULL),
                         LQ_OK);
    }
}

static lq_table *compute(const char *id, const lq_settings *settings, const lq_axis *axes) {
    lq_table *table = NULL;
    lq_error error = {""};
    const lq_kind *kind = kind_of(id);
    lq_axis own[LQ_MAX_AXES] = {{.size = 0}};
    if (!axes) make_axes(kind, own);
    if (lq_precompute(kind, settings, axes ? axes : own, NULL, &table, &error) != LQ_OK)
        fail_msg("%s", error.text);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&own[a]);
    return table;
}

/* What `table` looks like when it is said to be `id` with the default settings; "" where nothing fits better.
 */
static void expect_variant(lq_table *table, const char *id, const char *what) {
    lq_variants found;
    lq_error error = {""};
    const lq_settings settings = lq_settings_default();
    if (lq_variants_try(table, kind_of(id), &settings, NULL, &found, &error) != LQ_OK)
        fail_msg("%s", error.text);
    if (found.other != (what[0] != '\0') || (what[0] && strcmp(found.list[0].what, what) != 0))
        fail_msg("looks like '%s' (rms %g), not '%s'; as stated %g", found.list[0].what, found.list[0].rms,
                 what, found.stated);
    assert_true(found.count > 2);
    if (what[0]) assert_true(found.list[0].rms < 1e-4 && found.stated > 1e-3);
    else assert_true(found.stated < 1e-4);
    lq_table_free(table);
}

static void test_what_is_right_stays(void **state) {
    (void)state;
    const lq_settings settings = lq_settings_default();
    expect_variant(compute("albedo", &settings, NULL), "albedo", "");
    expect_variant(compute("tir-loss", &settings, NULL), "tir-loss", "");
}

static void test_other_physics(void **state) {
    (void)state;
    lq_settings settings = lq_settings_default();
    settings.masking = LQ_SEPARABLE;
    expect_variant(compute("albedo", &settings, NULL), "albedo", "separable masking");
    settings = lq_settings_default();
    settings.ndf = "beckmann";
    expect_variant(compute("dfg", &settings, NULL), "dfg", "the NDF beckmann");
    settings = lq_settings_default();
    settings.scattering = LQ_SINGLE;
    lq_axis axes[4];
    static const char *const nodes[] = {"0.05:1:6", "0.1:1:5", "0.2:2:3", "1:4:3"};
    for (int a = 0; a < 4; a++)
        assert_int_equal(lq_axis_parse(&axes[a], kind_of("fgd")->axes[a].name, nodes[a], NULL), LQ_OK);
    expect_variant(compute("fgd", &settings, axes), "fgd", "single scattering, correlated masking");
    settings.masking = LQ_SEPARABLE;
    expect_variant(compute("fgd", &settings, axes), "fgd", "single scattering, separable masking");
    for (int a = 0; a < 4; a++) lq_axis_free(&axes[a]);
}

static void complement(lq_table *table) {
    for (size_t i = 0; i < lq_table_entries(table); i++) table->channels[0][i] = 1.0f - table->channels[0][i];
}

static void test_other_conventions(void **state) {
    (void)state;
    const lq_settings settings = lq_settings_default();
    lq_table *table = compute("albedo", &settings, NULL);
    complement(table);
    expect_variant(table, "albedo", "the complement, 1 - x");
    table = compute("tir-loss", &settings, NULL);
    expect_variant(table, "tir-pass", "the convention tir-loss");
    table = compute("tir-loss", &settings, NULL);
    complement(table);
    expect_variant(table, "tir-pass", "1 - tir-loss");
    table = compute("dfg", &settings, NULL);
    float *first = table->channels[0];
    table->channels[0] = table->channels[1];
    table->channels[1] = first;
    expect_variant(table, "dfg", "its two channels are swapped");
}

/* The albedo at transformed nodes, under the names of the untransformed ones. */
static lq_table *relabelled(double (*mu)(double u), double (*alpha)(double u)) {
    lq_axis plain[2], there[2];
    double nodes[MUS];
    make_axes(kind_of("albedo"), plain);
    for (int a = 0; a < 2; a++) {
        for (size_t i = 0; i < plain[a].size; i++) nodes[i] = (a ? alpha : mu)(plain[a].nodes[i]);
        assert_int_equal(lq_axis_make_custom(&there[a], plain[a].name, nodes, plain[a].size, NULL), LQ_OK);
    }
    const lq_settings settings = lq_settings_default();
    lq_table *table = compute("albedo", &settings, there);
    for (int a = 0; a < 2; a++) {
        lq_axis_free(&table->axes[a]);
        lq_axis_free(&there[a]);
        table->axes[a] = plain[a];
    }
    return table;
}

static double same(double u) {
    return u;
}
static double squared(double u) {
    return u * u;
}
static double of_angle(double u) {
    return sin(1.57079632679489661923 * u);
}
static double centre_mu(double u) {
    return (u * (MUS - 1) + 0.5) / MUS;
}
static double centre_alpha(double u) {
    return (u * (ALPHAS - 1) + 0.5) / ALPHAS;
}

static void test_other_axes(void **state) {
    (void)state;
    expect_variant(relabelled(same, squared), "albedo", "its alpha is r with alpha = r^2");
    expect_variant(relabelled(of_angle, same), "albedo", "its mu is 1 - 2 theta / pi, linear in angle");
}

static lq_pattern pattern_of(const lq_table *table, const lq_table *exact) {
    lq_pattern pattern;
    assert_int_equal(lq_pattern_of(table, exact, 0, 2e-6, &pattern, NULL), LQ_OK);
    return pattern;
}

static void test_half_a_cell(void **state) {
    (void)state;
    const lq_settings settings = lq_settings_default();
    lq_table *exact = compute("albedo", &settings, NULL), *table = relabelled(centre_mu, same);
    lq_pattern pattern = pattern_of(table, exact);
    assert_int_equal(pattern.verdict, LQ_MISPLACED);
    assert_int_equal(pattern.best_axis, 0);
    assert_int_equal(pattern.best_sampling, LQ_SAMPLED_CENTRES);
    lq_table_free(table);
    table = relabelled(same, centre_alpha);
    pattern = pattern_of(table, exact);
    assert_int_equal(pattern.verdict, LQ_MISPLACED);
    assert_int_equal(pattern.best_axis, 1);
    assert_int_equal(pattern.best_sampling, LQ_SAMPLED_CENTRES);
    lq_table_free(table);
    lq_table_free(exact);
}

static void test_single_entries(void **state) {
    (void)state;
    const lq_settings settings = lq_settings_default();
    lq_table *exact = compute("albedo", &settings, NULL), *table = compute("albedo", &settings, NULL);
    assert_int_equal(pattern_of(table, exact).verdict, LQ_AGREES);
    table->channels[0][137] *= 1.02f;
    lq_pattern pattern = pattern_of(table, exact);
    assert_int_equal(pattern.verdict, LQ_SPOTS);
    assert_int_equal(pattern.spots, 1);
    assert_int_equal(pattern.zeros, 0);
    table->channels[0][200] = 0.0f;
    pattern = pattern_of(table, exact);
    assert_int_equal(pattern.verdict, LQ_SPOTS);
    assert_true(pattern.spots == 2 && pattern.zeros == 1 && pattern.zero_at == 200);
    /* noise everywhere is no spot */
    for (size_t i = 0; i < lq_table_entries(table); i++)
        table->channels[0][i] =
            exact->channels[0][i] +
            (float)(1e-3 * (uniform(3 * i) + uniform(3 * i + 1) + uniform(3 * i + 2) - 1.5));
    pattern = pattern_of(table, exact);
    assert_int_equal(pattern.verdict, LQ_NOISE);
    assert_int_equal(pattern.spots, 0);
    lq_table_free(table);
    lq_table_free(exact);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_right_stays), cmocka_unit_test(test_other_physics),
        cmocka_unit_test(test_other_conventions),   cmocka_unit_test(test_other_axes),
        cmocka_unit_test(test_half_a_cell),         cmocka_unit_test(test_single_entries),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
