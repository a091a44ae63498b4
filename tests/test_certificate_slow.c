/* test_certificate_slow.c - certificates of tables that are damaged or made otherwise than they say. */
#include "tests/expect.h"

#include <stdlib.h>
#include <string.h>

#include "validate/certificate_checks.h"

/* --------------------------------------------------------------------- a table that is damaged */

static lq_table *loss_table(size_t size) {
    const lq_kind *kind = lq_kind_find("tir-loss", NULL);
    const lq_settings settings = lq_settings_default();
    lq_axis axes[3];
    for (int a = 0; a < 3; a++)
        assert_int_equal(lq_axis_make(&axes[a], kind->axes[a].name, 0.0, 1.0, size, LQ_MAP_LINEAR, 1.0, NULL),
                         LQ_OK);
    lq_table *table;
    assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &table, NULL), LQ_OK);
    for (int a = 0; a < 3; a++) lq_axis_free(&axes[a]);
    return table;
}

static const lq_check *check_named(const lq_certified *certified, const char *name) {
    for (int i = 0; i < certified->check_count; i++)
        if (strcmp(certified->checks[i].name, name) == 0) return &certified->checks[i];
    static const lq_check none;
    fail_msg("no check '%s'", name);
    return &none;
}

static void certify(lq_certified *certified, lq_table *table, size_t points) {
    lq_judging options = {.points = points, .seed = 1};
    memset(certified, 0, sizeof *certified);
    certified->subject.table = table;
    assert_int_equal(lq_origin_of(table, NULL, &certified->subject.origin, NULL), LQ_OK);
    assert_int_equal(lq_ranges_parse(&options.rule, "mu=0.05:1,alpha=0.1:1", NULL), LQ_OK);
    assert_int_equal(lq_budget_parse(&options.rule.budget, "max=0.2,p99=0.05", NULL), LQ_OK);
    assert_int_equal(lq_certified_make(certified, &options, NULL, NULL), LQ_OK);
}

/* One of 35937 entries off by 2 %, at four places of the table, a corner among steps included: too little to
 * exceed the budget, and seen.
 */
static void test_one_entry_of_many_is_caught(void **state) {
    (void)state;
    lq_certified *certified = malloc(sizeof *certified);
    certify(certified, loss_table(33), 500);
    assert_null(lq_certified_failure(certified));
    const double before = check_named(certified, "stored entries")->value;
    assert_true(before <= 1e-5);
    lq_table *table = certified->subject.table;
    const size_t places[] = {5, 33 * 33 * 16 + 33 * 16 + 16, 33 * 33 * 3 + 33 * 30 + 2,
                             33 * 33 * 31 + 33 * 9 + 1};
    certified->subject.table = NULL;
    lq_certified_free(certified);
    for (size_t i = 0; i < 4; i++) {
        float *entry = &table->channels[0][places[i]], kept = *entry;
        if (kept < 0.01f) fail_msg("entry %zu is too small to tell", places[i]);
        *entry = 1.02f * kept;
        certify(certified, table, 500);
        const lq_check *stored = check_named(certified, "stored entries");
        if (stored->outcome != LQ_FAILED)
            fail_msg("entry %zu of value %g: %.3g; %s", places[i], (double)kept, stored->value,
                     stored->detail);
        assert_near(stored->value, 0.02 * (double)kept, 1e-5);
        *entry = kept;
        certified->subject.table = NULL;
        lq_certified_free(certified);
    }
    table->channels[0][77] = NAN;
    certify(certified, table, 500);
    assert_int_equal(check_named(certified, "range stored")->outcome, LQ_FAILED);
    lq_certified_free(certified);
    free(certified);
}

/* A hole of zeros, and values that fall where the exact ones rise. */
static void test_physics_is_checked(void **state) {
    (void)state;
    lq_certified *certified = malloc(sizeof *certified);
    lq_table *table = loss_table(17);
    for (size_t i = 0; i < 17; i++)
        for (size_t k = 4; k < 7; k++)
            for (size_t m = 2; m < 9; m++) table->channels[0][m + 17 * (i + 17 * k)] = 0.0f;
    certify(certified, table, 2000);
    assert_int_equal(check_named(certified, "false zeros")->outcome, LQ_FAILED);
    assert_int_equal(check_named(certified, "monotony")->outcome, LQ_FAILED);
    assert_int_equal(check_named(certified, "banding")->outcome, LQ_FAILED);
    assert_int_equal(check_named(certified, "budget max")->outcome, LQ_FAILED);
    lq_certified_free(certified);
    free(certified);
}

/* A table made with separable masking that says it is correlated. */
static void test_wrong_masking_is_named(void **state) {
    (void)state;
    const lq_kind *kind = lq_kind_find("albedo", NULL);
    lq_settings settings = lq_settings_default();
    lq_certified *certified = calloc(1, sizeof *certified);
    lq_judging options = {.points = 1000, .seed = 1};
    lq_axis axes[2];
    settings.masking = LQ_SEPARABLE;
    assert_int_equal(lq_axis_parse(&axes[0], "mu", "0.05:1:33", NULL), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[1], "alpha", "0.1:1:17", NULL), LQ_OK);
    assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &certified->subject.table, NULL), LQ_OK);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    assert_int_equal(lq_table_set_fact(certified->subject.table, "masking", "correlated", NULL), LQ_OK);
    assert_int_equal(lq_origin_of(certified->subject.table, NULL, &certified->subject.origin, NULL), LQ_OK);
    assert_int_equal(lq_budget_parse(&options.rule.budget, "max=1e-2", NULL), LQ_OK);
    assert_int_equal(lq_certified_make(certified, &options, NULL, NULL), LQ_OK);
    assert_int_equal(check_named(certified, "budget max")->outcome, LQ_FAILED);
    assert_int_equal(check_named(certified, "stored entries")->outcome, LQ_FAILED);
    const lq_check *named = check_named(certified, "looks like");
    assert_non_null(strstr(named->detail, "separable masking"));
    assert_true(named->value < 1e-5);
    lq_certified_free(certified);
    free(certified);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_entry_of_many_is_caught),
        cmocka_unit_test(test_physics_is_checked),
        cmocka_unit_test(test_wrong_masking_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
