/* Each sort of damage is caught by the hard cases where it was done. (test_hard_cases_long.sh runs them on
 * the solver.) */
#include "tests/expect.h"

#include "validate/hard_cases.h"
#include "validate/smooth_limit.h"

#include <stdio.h>
#include <string.h>

typedef struct tally {
    size_t rows, failed;
    char first[160], group[64]; /* of the first that failed */
} tally;

static void count(void *user, const lq_hard_result *row) {
    tally *t = user;
    t->rows++;
    if (row->passed) return;
    if (t->failed++ > 0) return;
    snprintf(t->first, sizeof t->first, "%s", row->asked);
    snprintf(t->group, sizeof t->group, "%s", row->group);
}

/* Closed forms stand for the solver, and none is asked what has no closed form. */
static lq_status smooth_eval(const lq_kind *kind, const lq_settings *settings, const double *point,
                             double *values, double *estimate, lq_error *error) {
    (void)settings;
    (void)error;
    *estimate = 0.0;
    for (int c = 0; c < kind->channel_count; c++) values[c] = 0.0;
    lq_smooth_limit(kind, point, values);
    return LQ_OK;
}

/* A grid of halves: in range, and two of them make 1. */
static float planted = 0.5f;
static const char *planted_in = "";

static lq_status half_precompute(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                                 const lq_progress *progress, lq_table **table, lq_error *error) {
    (void)settings;
    (void)progress;
    const lq_status status =
        lq_table_create(table, axes, kind->axis_count, kind->channels, kind->channel_count, error);
    for (int c = 0; status == LQ_OK && c < kind->channel_count; c++)
        for (size_t i = 0; i < lq_table_entries(*table); i++) (*table)->channels[c][i] = 0.5f;
    if (status == LQ_OK && strcmp(kind->id, planted_in) == 0)
        (*table)->channels[0][lq_table_entries(*table) - 1] = planted;
    return status == LQ_OK ? lq_table_set_fact(*table, "error", "1e-7", error) : status;
}

static tally run(lq_status (*eval)(const lq_kind *kind, const lq_settings *settings, const double *point,
                                   double *values, double *estimate, lq_error *error),
                 const char *ndf) {
    tally t = {.rows = 0};
    const lq_hard_run all = {
        .source = {eval, half_precompute}, .ndf = ndf, .threads = 1, .report = count, .user = &t};
    lq_error error = {""};
    if (lq_hard_cases(&all, &error) != LQ_OK) fail_msg("%s", error.text);
    return t;
}

/* A solver that takes every surface for smooth fails, and not where it should be smooth. */
static void test_a_smooth_solver_fails(void **state) {
    (void)state;
    const tally t = run(smooth_eval, "ggx");
    assert_true(t.failed >= 3);
    assert_string_not_equal(t.group, "alpha = 0");
}

static lq_status nan_eval(const lq_kind *kind, const lq_settings *settings, const double *point,
                          double *values, double *estimate, lq_error *error) {
    const lq_status status = smooth_eval(kind, settings, point, values, estimate, error);
    if (strcmp(kind->id, "diffuse-reflection") == 0 && point[2] == 0.0) values[0] = NAN;
    return status;
}

static void test_a_nan_fails(void **state) {
    (void)state;
    assert_int_equal(run(nan_eval, "ggx").failed, run(smooth_eval, "ggx").failed + 1);
}

static void expect_planted(const char *kind, float value, const char *group) {
    planted_in = "";
    const size_t before = run(smooth_eval, "beckmann").failed;
    planted_in = kind;
    planted = value;
    const tally t = run(smooth_eval, "beckmann");
    assert_true(t.failed > before);
    if (before == 0) assert_string_equal(t.group, group);
}

static void test_grids(void **state) {
    (void)state;
    expect_planted("variance", 1.01f, "range");
    expect_planted("fgd", -1e-6f, "range");
    expect_planted("tir-pass", NAN, "range");
    expect_planted("transmission", 0.51f, "R + T = 1");
    expect_planted("diffuse-reflection", 0.51f, "R + T = 1");
}

static bool stop(void *user, double fraction) {
    *(double *)user = fraction;
    return fraction < 0.5;
}

static void test_cancel(void **state) {
    (void)state;
    double seen = 0.0;
    tally t = {.rows = 0};
    const lq_progress progress = {stop, &seen};
    const lq_hard_run all = {.source = {smooth_eval, half_precompute},
                             .ndf = "ggx",
                             .report = count,
                             .user = &t,
                             .progress = &progress};
    lq_error error = {""};
    assert_int_equal(lq_hard_cases(&all, &error), LQ_CANCELLED);
    assert_true(seen >= 0.5 && seen < 0.6);
}

/* The closed forms against numbers of other hands: Walsh's reflectance and D22's pair at eta 1.5. */
static void test_smooth_limits(void **state) {
    (void)state;
    double value;
    lq_smooth_limit(lq_kind_find("diffuse-transmission", NULL), (const double[]){1.5, 0.0, 0.9}, &value);
    assert_near(value, 0.35806443, 1e-8);
    lq_smooth_limit(lq_kind_find("diffuse-reflection", NULL), (const double[]){1.5, 0.0, 0.9}, &value);
    assert_near(value, 0.37406352, 1e-8);
    lq_smooth_limit(lq_kind_find("diffuse-transmission", NULL), (const double[]){4.0, 0.0, 1.0}, &value);
    assert_near(value, (1.0 - 0.3666380565) / 16.0, 1e-9);
    double both[2];
    lq_smooth_limit(lq_kind_find("variance", NULL), (const double[]){1.0 / 1.5, 0.0}, both);
    assert_near(both[0], 0.212600, 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_smooth_solver_fails),
        cmocka_unit_test(test_a_nan_fails),
        cmocka_unit_test(test_grids),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_smooth_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
