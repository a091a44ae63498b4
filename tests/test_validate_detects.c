/* `lacquer validate` finds what is wrong with a table: a false fact, a bias, entries that are no numbers. */
#include "lacquer.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[] = "/tmp/lacquer-detects-XXXXXX";
static char path[64];

static int make_folder(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/table.exr", folder);
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    unlink(path);
    return rmdir(folder);
}

/* The albedo table over mu x alpha in [0.3, 1]. */
static lq_table *make_table(void) {
    const lq_kind *kind = lq_kind_find("albedo", NULL);
    const lq_settings settings = lq_settings_default();
    lq_axis axes[2];
    lq_table *table = NULL;
    assert_int_equal(lq_axis_make(&axes[0], "mu", 0.1, 1.0, 7, LQ_MAP_LINEAR, 1.0, NULL), LQ_OK);
    assert_int_equal(lq_axis_make(&axes[1], "alpha", 0.3, 1.0, 5, LQ_MAP_LINEAR, 1.0, NULL), LQ_OK);
    assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &table, NULL), LQ_OK);
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
    return table;
}

/* The exit code of the program on this table; its report goes to `report`. The table is freed. */
static int validate(lq_table *table, const char *options, char *report, size_t size) {
    const char *program = getenv("LACQUER");
    char command[1024];
    if (!program) skip();
    assert_int_equal(lq_table_write_exr(table, path, NULL), LQ_OK);
    lq_table_free(table);
    snprintf(command, sizeof command, "'%s' validate %s --points 40 --format json %s", program, path,
             options);
    FILE *out = popen(command, "r");
    assert_non_null(out);
    report[fread(report, 1, size - 1, out)] = '\0';
    const int status = pclose(out);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static char report[65536];
static const char walks[] = "--against walk --samples 20000";

static void test_good_table(void **state) {
    (void)state;
    assert_int_equal(validate(make_table(), walks, report, sizeof report), 0);
    assert_non_null(strstr(report, "\"complaint\": null"));
}

static void test_false_fact(void **state) {
    (void)state;
    lq_table *table = make_table();
    assert_int_equal(lq_table_set_fact(table, "masking", "separable", NULL), LQ_OK);
    assert_int_equal(validate(table, walks, report, sizeof report), 2);
    /* The walk alone would have found it. */
    const char *list = strstr(report, "\"stored_walk\"");
    assert_non_null(list);
    const char *verdict = strstr(list, "\"explained\"");
    assert_non_null(verdict);
    assert_true(strncmp(verdict, "\"explained\": false", 18) == 0);
}

static void test_bias(void **state) {
    (void)state;
    lq_table *table = make_table();
    for (size_t i = 0; i < lq_table_entries(table); i++) table->channels[0][i] += 5e-6f;
    assert_int_equal(validate(table, "", report, sizeof report), 2);
    assert_non_null(strstr(report, "tolerance they state"));
}

static void test_not_a_number(void **state) {
    (void)state;
    lq_table *table = make_table();
    for (size_t i = 0; i < lq_table_entries(table); i++) table->channels[0][i] = NAN;
    assert_int_equal(validate(table, walks, report, sizeof report), 2);
}

static void test_no_origin(void **state) {
    (void)state;
    lq_table *table = make_table();
    assert_int_equal(lq_table_set_fact(table, "table", "nonsense", NULL), LQ_OK);
    assert_int_equal(validate(table, "2>&1", report, sizeof report), 1);
    assert_non_null(strstr(report, "nonsense"));
}

/* One entry of 64 x 64, of which the default looks up 128: no sample may be needed to see it. */
static void one_entry_among_many(void **state) {
    (void)state;
    const struct {
        float value;
        const char *says;
    } planted[] = {{NAN, "is nan"}, {-1e30f, "is -1e+30"}, {INFINITY, "is inf"}, {0.5f, "is 0.5"}};
    const lq_kind *kind = lq_kind_find("albedo", NULL);
    const lq_settings settings = lq_settings_default();
    lq_axis axes[2];
    assert_int_equal(lq_kind_axes(kind, axes, NULL), LQ_OK);
    for (size_t i = 0; i <= sizeof planted / sizeof *planted; i++) {
        const bool sound = i == sizeof planted / sizeof *planted;
        lq_table *table = NULL;
        assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &table, NULL), LQ_OK);
        if (!sound) table->channels[0][40 * 64 + 37] = planted[i].value;
        assert_int_equal(validate(table, "", report, sizeof report), sound ? 0 : 2);
        if (!sound && (!strstr(report, planted[i].says) || !strstr(report, "entry mu=0.5873 alpha=0.63492")))
            fail_msg("planted %g: %s", (double)planted[i].value, report);
    }
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good_table), cmocka_unit_test(test_false_fact),
        cmocka_unit_test(test_bias),       cmocka_unit_test(test_not_a_number),
        cmocka_unit_test(test_no_origin),  cmocka_unit_test(one_entry_among_many),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
