/* However many judgements a certificate has, all are kept, judged and reported; one that could not be kept
 * has failed. */
#include "failing_malloc.h"

#include "expect.h"
#include "scratch.h"

#include "system/input.h"
#include "validate/certificate_checks.h"
#include "validate/report.h"

enum { MANY = 200 };

static lq_certified certified_of(int count, int failing) {
    lq_certified certified = {.check_count = 0};
    for (int i = 0; i < count; i++) {
        char name[32];
        snprintf(name, sizeof name, "judgement %d", i);
        lq_check_add(&certified, name, i == failing ? 2.0 : 0.5, 1.0, "%g", 0.25 * i);
    }
    return certified;
}

static void test_all_are_kept(void **state) {
    (void)state;
    for (int failing = 0; failing < MANY; failing += 33) {
        lq_certified certified = certified_of(MANY, failing);
        assert_int_equal(certified.check_count, MANY);
        assert_false(certified.check_lost);
        for (int i = 0; i < MANY; i++) {
            char name[32];
            snprintf(name, sizeof name, "judgement %d", i);
            assert_string_equal(certified.checks[i].name, name);
            assert_int_equal(certified.checks[i].outcome, i == failing ? LQ_FAILED : LQ_PASSED);
        }
        assert_ptr_equal(lq_certified_failure(&certified), &certified.checks[failing]);
        free(certified.checks);
    }
}

static void expect_junit(const lq_certified *certified, const char *want) {
    char *text;
    size_t size;
    const lq_report report = {.name = "all", .date = "", .count = 1, .list = certified};
    assert_int_equal(lq_report_junit(&report, at("junit.xml"), NULL), LQ_OK);
    assert_int_equal(lq_input_read(at("junit.xml"), &text, &size, NULL), LQ_OK);
    if (!strstr(text, want)) fail_msg("no '%s' in %.300s", want, text);
    free(text);
    unlink(at("junit.xml"));
}

static void test_all_are_reported(void **state) {
    (void)state;
    lq_certified certified = certified_of(MANY, MANY - 1);
    expect_junit(&certified, "tests=\"200\" failures=\"1\"");
    expect_junit(&certified, "judgement 199");
    free(certified.checks);
}

/* Without the mend: 48 were kept, and the rest passed. */
static void test_one_that_is_lost_has_failed(void **state) {
    (void)state;
    if (!can_fail()) skip();
    lq_certified certified = certified_of(32, -1); /* as many as there is room for at first */
    assert_null(lq_certified_failure(&certified));
    countdown = 0;
    lq_check_add(&certified, "one more", 0.5, 1.0, NULL);
    countdown = -1;
    assert_true(certified.check_lost);
    assert_non_null(lq_certified_failure(&certified));
    assert_string_equal(lq_certified_failure(&certified)->name, "judgements lost");
    expect_junit(&certified, "tests=\"33\" failures=\"1\"");
    lq_check_add(&certified, "and one", 0.5, 1.0, NULL); /* there is memory again */
    assert_int_equal(certified.check_count, 33);
    assert_non_null(lq_certified_failure(&certified));
    free(certified.checks);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_are_kept),
        cmocka_unit_test(test_all_are_reported),
        cmocka_unit_test(test_one_that_is_lost_has_failed),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
