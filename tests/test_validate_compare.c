/* What a comparison says: the metrics of known errors, scores of known noise, false alarms as rare as stated;
 * the points that are drawn; the origin that a table's facts tell. */
#include "tables/origin.h"
#include "validate/compare.h"
#include "validate/draw.h"
#include "validate/stream.h"
#include "validate/walk_kind.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void test_metrics(void **state) {
    (void)state;
    lq_compared points[200];
    for (int i = 0; i < 200; i++) points[i] = (lq_compared){0.5 + 1e-3, 0.5, INFINITY, 0.0};
    points[17].value = 0.5 - 0.1;
    points[18].value = 0.5 + 0.05;
    lq_comparison r;
    assert_int_equal(lq_compare(points, 200, 200, &r, NULL), LQ_OK);
    assert_int_equal(r.worst, 17);
    assert_true(fabs(r.max - 0.1) < 1e-15);
    assert_true(fabs(r.p99 - 1e-3) < 1e-12);
    assert_true(fabs(r.mean - (198 * 1e-3 - 0.1 + 0.05) / 200) < 1e-12);
    assert_true(fabs(r.rms - sqrt((198 * 1e-6 + 0.01 + 0.0025) / 200)) < 1e-12);
    assert_true(r.explained && r.z_max == 0.0);
    assert_int_equal(lq_compare(points, 0, 1, &r, NULL), LQ_BAD_INPUT);
}

static void test_scores(void **state) {
    (void)state;
    lq_compared points[3] = {{0.5, 0.5, 0.0, 1e-3}, {0.504, 0.5, 1e-3, 1e-3}, {0.5, 0.51, 0.0, 1e-3}};
    lq_comparison r;
    assert_int_equal(lq_compare(points, 2, 2, &r, NULL), LQ_OK);
    assert_true(fabs(r.z_max - 3.0) < 1e-9 && r.z_worst == 1 && r.explained);
    assert_int_equal(lq_compare(points, 3, 3, &r, NULL), LQ_OK);
    assert_true(fabs(r.z_max - 10.0) < 1e-9 && r.z_worst == 2 && r.beyond4 == 1 && !r.explained);
    /* Without noise the allowance is everything; a value that is no number is never explained. */
    points[0] = (lq_compared){0.5, 0.5 + 2e-6, 1e-6, 0.0};
    assert_int_equal(lq_compare(points, 1, 1, &r, NULL), LQ_OK);
    assert_false(r.explained);
    points[0].value = NAN;
    assert_int_equal(lq_compare(points, 2, 2, &r, NULL), LQ_OK);
    assert_true(isinf(r.max) && !r.explained);
}

/* Two-sided normal quantiles at 1e-4, 1e-6 and 1e-8. */
static void test_limit(void **state) {
    (void)state;
    assert_true(fabs(lq_z_limit(1) - 3.8905919) < 1e-6);
    assert_true(fabs(lq_z_limit(100) - 4.8916385) < 1e-6);
    assert_true(fabs(lq_z_limit(10000) - 5.7307289) < 1e-6);
}

/* A bias of half a standard error hides in every single point and shows in the sum. */
static void test_bias_shows(void **state) {
    (void)state;
    enum { COUNT = 400 };
    lq_compared points[COUNT];
    for (uint64_t i = 0; i < COUNT; i++) {
        lq_stream stream = lq_stream_open(1, 2, i);
        double normal = -6.0;
        for (int k = 0; k < 12; k++) normal += lq_stream_uniform(&stream);
        points[i] = (lq_compared){0.5 + 1e-3 * normal, 0.5, 0.0, 1e-3};
    }
    lq_comparison r;
    assert_int_equal(lq_compare(points, COUNT, COUNT, &r, NULL), LQ_OK);
    assert_true(r.explained && fabs(r.z2 - 1.0) < 0.3 && fabs(r.z_bias) < 4.0);
    for (size_t i = 0; i < COUNT; i++) points[i].value += 5e-4;
    assert_int_equal(lq_compare(points, COUNT, COUNT, &r, NULL), LQ_OK);
    assert_true(!r.explained && r.z_max < r.z_limit && r.z_bias > 5.0);
}

static void make_table(lq_table **table, lq_axis *axes) {
    const char *channel = "albedo";
    assert_int_equal(lq_axis_make(&axes[0], "mu", 0.0, 1.0, 21, LQ_MAP_LINEAR, 1.0, NULL), LQ_OK);
    assert_int_equal(lq_axis_make(&axes[1], "alpha", 0.0, 1.0, 11, LQ_MAP_LINEAR, 1.0, NULL), LQ_OK);
    assert_int_equal(lq_table_create(table, axes, 2, &channel, 1, NULL), LQ_OK);
}

static void test_draw(void **state) {
    (void)state;
    enum { COUNT = 900 };
    lq_axis axes[2];
    lq_table *table;
    make_table(&table, axes);
    int low_mu = 0, low_alpha = 0, low_between = 0;
    for (size_t i = 0; i < COUNT; i++) {
        const lq_drawn entry = lq_draw_entry(axes, 2, 7, i), again = lq_draw_entry(axes, 2, 7, i);
        const lq_drawn between = lq_draw_between(axes, 2, 7, i);
        assert_memory_equal(&entry, &again, sizeof entry);
        assert_int_equal(entry.entry, entry.index[0] + 21 * entry.index[1]);
        assert_true(entry.at[0] == axes[0].nodes[entry.index[0]] && entry.entry < 21 * 11);
        assert_true(between.at[0] > 0.0 && between.at[0] < 1.0 && between.at[1] < 1.0);
        low_mu += entry.at[0] <= 0.1;
        low_alpha += entry.at[1] <= 0.1;
        low_between += between.at[0] <= 0.1 && between.at[1] <= 0.1;
    }
    assert_true(low_mu >= COUNT / 3 && low_alpha >= COUNT / 3 && low_between >= COUNT / 9);
    lq_table_free(table);
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
}

static void test_origin(void **state) {
    (void)state;
    lq_axis axes[2];
    lq_table *table;
    lq_origin origin;
    lq_error error;
    make_table(&table, axes);
    assert_int_equal(lq_origin_of(table, NULL, &origin, &error), LQ_FORMAT);
    static const char *const facts[][2] = {
        {"table", "albedo"}, {"ndf", "ggx"}, {"masking", "separable"}, {"tolerance", "1e-06"}};
    for (size_t i = 0; i < 4; i++) {
        assert_int_not_equal(lq_origin_of(table, NULL, &origin, &error), LQ_OK);
        assert_int_equal(lq_table_set_fact(table, facts[i][0], facts[i][1], NULL), LQ_OK);
    }
    assert_int_equal(lq_origin_of(table, NULL, &origin, &error), LQ_OK);
    assert_string_equal(origin.kind->id, "albedo");
    assert_true(origin.settings.masking == LQ_SEPARABLE && origin.settings.tolerance == 1e-6);
    char text[128];
    lq_origin_describe(origin.kind, &origin.settings, text, sizeof text);
    assert_string_equal(text, "albedo, ggx, separable masking");
    assert_int_equal(lq_table_set_fact(table, "masking", "sideways", NULL), LQ_OK);
    assert_int_equal(lq_origin_of(table, NULL, &origin, &error), LQ_FORMAT);
    assert_non_null(strstr(error.text, "sideways"));
    assert_int_equal(lq_table_set_fact(table, "table", "fgd", NULL), LQ_OK);
    assert_int_equal(lq_origin_of(table, NULL, &origin, &error), LQ_FORMAT);
    lq_table_free(table);
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
}

static void test_compare_tables(void **state) {
    (void)state;
    lq_axis axes[2], more[2];
    lq_table *a, *b;
    lq_comparison r;
    make_table(&a, axes);
    make_table(&b, more);
    a->channels[0][40] = 0.25f;
    assert_int_equal(lq_compare_tables(a, b, 0, &r, NULL), LQ_OK);
    assert_true(r.max == 0.25 && r.worst == 40 && r.count == 21 * 11);
    assert_int_equal(lq_compare_tables(a, b, 1, &r, NULL), LQ_BAD_INPUT);
    b->axes[0].nodes[3] += 1e-9;
    assert_int_equal(lq_compare_tables(a, b, 0, &r, NULL), LQ_BAD_INPUT);
    lq_table_free(a);
    lq_table_free(b);
    for (int i = 0; i < 2; i++) {
        lq_axis_free(&axes[i]);
        lq_axis_free(&more[i]);
    }
}

/* Every kind of the catalogue has a walk; and at alpha 1, mu 1 they give numbers known from H16. */
static void test_kinds_have_walks(void **state) {
    (void)state;
    const lq_walk_run run = {.samples = 20000, .seed = 3, .threads = 1};
    for (size_t i = 0; i < lq_kind_count(); i++) assert_true(lq_walk_knows(lq_kind_at(i)));
    const lq_settings settings = lq_settings_default();
    const double point[2] = {1.0, 1.0};
    lq_walk_mean values[LQ_MAX_CHANNELS], a, average;
    assert_int_equal(lq_walk_kind(lq_kind_find("dfg", NULL), &settings, point, &run, values, NULL), LQ_OK);
    assert_int_equal(lq_walk_kind(lq_kind_find("albedo", NULL), &settings, point, &run, &a, NULL), LQ_OK);
    assert_true(fabs(values[0].mean + values[1].mean - a.mean) < 1e-12);
    assert_true(fabs(a.mean - (1.0 - log(2.0))) < 4.0 * a.error);
    const double alpha = 1.0;
    assert_int_equal(
        lq_walk_kind(lq_kind_find("albedo-average", NULL), &settings, &alpha, &run, &average, NULL), LQ_OK);
    assert_true(fabs(average.mean - 4.0 * (1.0 - log(2.0)) / 3.0) < 4.0 * average.error);
    const double outside[2] = {1.5, 1.0};
    assert_int_equal(lq_walk_kind(lq_kind_find("albedo", NULL), &settings, outside, &run, &a, NULL),
                     LQ_BAD_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_metrics),        cmocka_unit_test(test_scores),
        cmocka_unit_test(test_limit),          cmocka_unit_test(test_bias_shows),
        cmocka_unit_test(test_draw),           cmocka_unit_test(test_origin),
        cmocka_unit_test(test_compare_tables), cmocka_unit_test(test_kinds_have_walks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
