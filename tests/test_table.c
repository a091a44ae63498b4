/* test_table.c - tables in memory: limits, facts, interpolation. */
#define _DEFAULT_SOURCE /* setrlimit */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "lacquer.h"

static void assert_contains(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("'%s' does not contain '%s'", text, part);
}

static void make(lq_axis *axis, const char *text, const char *name) {
    lq_error error;
    if (lq_axis_parse(axis, name, text, &error)) fail_msg("%s", error.text);
}

/* ------------------------------------------------------------------ creation */

static void test_create(void **state) {
    (void)state;
    lq_axis axes[4];
    const char *names[] = {"A", "B"};
    lq_table *table;
    make(&axes[0], "0:1:3", "mu");
    make(&axes[1], "0:1:4:sqrt", "alpha");
    make(&axes[2], "1.5", "n");
    make(&axes[3], "0,1,5", "kappa");
    assert_int_equal(lq_table_create(&table, axes, 4, names, 2, NULL), LQ_OK);
    for (int i = 0; i < 4; i++) lq_axis_free(&axes[i]); /* the table has copies */
    assert_int_equal(lq_table_entries(table), 3 * 4 * 1 * 3);
    assert_int_equal(lq_table_axis(table, "kappa"), 3);
    assert_int_equal(lq_table_axis(table, "mu"), 0);
    assert_int_equal(lq_table_axis(table, "eta"), -1);
    assert_string_equal(table->channel_names[1], "B");
    for (size_t i = 0; i < 36; i++) assert_true(table->channels[0][i] == 0 && table->channels[1][i] == 0);
    assert_true(table->axes[3].nodes[1] == 1);
    lq_table_free(table);
    lq_table_free(NULL);
}

static void refuse(const lq_axis *axes, int axis_count, const char *const *names, int channel_count,
                   const char *part) {
    lq_table *table = (lq_table *)1;
    lq_error error = {""};
    assert_int_equal(lq_table_create(&table, axes, axis_count, names, channel_count, &error), LQ_BAD_INPUT);
    assert_null(table);
    assert_contains(error.text, part);
    assert_contains(error.text, "accepted");
    assert_int_equal(lq_table_create(&table, axes, axis_count, names, channel_count, NULL), LQ_BAD_INPUT);
}

static void test_refused(void **state) {
    (void)state;
    lq_axis axes[5];
    const char *names[9] = {"a", "b", "c", "d", "e", "f", "g", "h", "i"};
    const char *twins[] = {"a", "b", "a"}, *empty[] = {""}, *plain[] = {"a b"};
    const char *axis_names[] = {"p", "q", "r", "s", "t"};
    for (int i = 0; i < 5; i++) make(&axes[i], "0:1:2", axis_names[i]);
    refuse(axes, 0, names, 1, "1 to 6");
    refuse(axes, 7, names, 1, "1 to 6");
    refuse(axes, -1, names, 1, "1 to 6");
    refuse(axes, 2, names, 0, "1 to 8");
    refuse(axes, 2, names, 9, "1 to 8");
    refuse(axes, 2, twins, 3, "two channels called 'a'");
    refuse(axes, 2, empty, 1, "channel without a name");
    refuse(axes, 2, plain, 1, "'a b'");
    strcpy(axes[1].name, "p");
    refuse(axes, 2, names, 1, "two axes called 'p'");
    for (int i = 0; i < 5; i++) lq_axis_free(&axes[i]);
    refuse(axes, 1, names, 1, "axis without a name");
}

/* 2^20 nodes an axis: 2^80 entries, past every integer. */
static void test_absurd_sizes(void **state) {
    (void)state;
    lq_axis axes[4];
    const char *names[] = {"a"}, *axis_names[] = {"p", "q", "r", "s"};
    for (int i = 0; i < 4; i++) make(&axes[i], "0:1:1048576", axis_names[i]);
    refuse(axes, 4, names, 1, "a table of 1208925819614629174706176 entries");
    refuse(axes, 3, names, 1, "a table of 1152921504606846976 entries");
    refuse(axes, 2, names, 1, "a table of 1099511627776 entries (4096.0 GiB); accepted are at most ");
    for (int i = 0; i < 4; i++) lq_axis_free(&axes[i]);
}

#ifndef __SANITIZE_ADDRESS__ /* which maps terabytes itself */
static void test_no_memory(void **state) {
    (void)state;
    lq_axis axis[2];
    const char *names[] = {"a", "b"};
    lq_table *table;
    lq_error error;
    struct rlimit old, low;
    make(&axis[0], "0:1:1000000", "x");
    make(&axis[1], "0:1:100", "y");
    assert_int_equal(getrlimit(RLIMIT_AS, &old), 0);
    low = old;
    low.rlim_cur = (rlim_t)700 << 20; /* one channel of 400 MB fits beside the program, two do not */
    assert_int_equal(setrlimit(RLIMIT_AS, &low), 0);
    lq_status status = lq_table_create(&table, axis, 2, names, 2, &error);
    assert_int_equal(setrlimit(RLIMIT_AS, &old), 0);
    assert_int_equal(status, LQ_NO_MEMORY);
    assert_null(table);
    assert_contains(error.text, "100000000 entries");
    lq_axis_free(&axis[0]);
    lq_axis_free(&axis[1]);
}
#endif

/* ------------------------------------------------------------------ facts */

static void test_facts(void **state) {
    (void)state;
    lq_axis axis;
    const char *names[] = {"a"};
    lq_table *table;
    lq_error error;
    make(&axis, "1", "x");
    assert_int_equal(lq_table_create(&table, &axis, 1, names, 1, NULL), LQ_OK);
    assert_null(lq_table_fact(table, "ndf"));
    assert_int_equal(lq_table_set_fact(table, "ndf", "beckmann", NULL), LQ_OK);
    assert_int_equal(lq_table_set_fact(table, "command", "", NULL), LQ_OK);
    assert_int_equal(lq_table_set_fact(table, "ndf", "ggx", NULL), LQ_OK);
    assert_int_equal(lq_table_set_fact(table, "ndf", lq_table_fact(table, "ndf"), NULL), LQ_OK);
    assert_int_equal(table->fact_count, 2);
    assert_string_equal(table->facts[0].key, "ndf");
    assert_string_equal(lq_table_fact(table, "ndf"), "ggx");
    assert_string_equal(lq_table_fact(table, "command"), "");
    assert_int_equal(lq_table_set_fact(table, "", "x", &error), LQ_BAD_INPUT);
    assert_int_equal(lq_table_set_fact(table, "a b", "x", &error), LQ_BAD_INPUT);
    assert_contains(error.text, "accepted");
    assert_int_equal(lq_table_set_fact(table, "c", NULL, &error), LQ_BAD_INPUT);
    assert_int_equal(table->fact_count, 2);
    lq_table_free(table);
    lq_axis_free(&axis);
}

/* ------------------------------------------------------------------ interpolation */

/* Multilinear in the node index; coefficients are small integers, so that floats hold it exactly. */
static double multilinear(const double *index, int count) {
    double value = 1;
    for (int i = 0; i < count; i++) value *= 1 + (i + 1) * index[i];
    return value - 7 * index[0];
}

static void fill(lq_table *table) {
    size_t entries = lq_table_entries(table);
    for (size_t k = 0; k < entries; k++) {
        double index[LQ_MAX_AXES];
        size_t rest = k;
        for (int i = 0; i < table->axis_count; i++) {
            index[i] = (double)(rest % table->axes[i].size);
            rest /= table->axes[i].size;
        }
        table->channels[0][k] = (float)multilinear(index, table->axis_count);
    }
}

static double next(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) * 0x1p-53;
}

static void check_lookup(const char *const *forms, int count) {
    lq_axis axes[LQ_MAX_AXES] = {0};
    const char *axis_names[] = {"p", "q", "r", "s"}, *names[] = {"a"};
    lq_table *table;
    for (int i = 0; i < count; i++) make(&axes[i], forms[i], axis_names[i]);
    assert_int_equal(lq_table_create(&table, axes, count, names, 1, NULL), LQ_OK);
    fill(table);
    uint64_t seed = 5;
    for (int k = 0; k < 2000; k++) {
        double point[LQ_MAX_AXES], index[LQ_MAX_AXES];
        for (int i = 0; i < count; i++) {
            double span = axes[i].max - axes[i].min;
            point[i] = axes[i].min + span * (1.2 * next(&seed) - 0.1); /* some are outside: clamped */
            if (k % 7 == 0) point[i] = axes[i].nodes[(size_t)(next(&seed) * (double)axes[i].size)];
            index[i] = lq_axis_locate(&axes[i], point[i]);
        }
        double expected = multilinear(index, count);
        assert_true(fabs(lq_table_lookup(table, 0, point) - expected) <= 1e-12 * (1 + fabs(expected)));
    }
    lq_table_free(table);
    for (int i = 0; i < count; i++) lq_axis_free(&axes[i]);
}

static void test_lookup(void **state) {
    (void)state;
    const char *four[] = {"0:1:5", "0:1:4:sqrt", "-1,0,0.5,9", "0:4:6:power2.5"};
    const char *single[] = {"0.5", "0:1:3", "2"};
    for (int count = 1; count <= 4; count++) check_lookup(four, count);
    check_lookup(single, 3);
    check_lookup(single, 1);
}

/* Linear in the value on a linear axis. */
static void test_lookup_linear_axis(void **state) {
    (void)state;
    lq_axis axes[2];
    const char *names[] = {"a"};
    lq_table *table;
    make(&axes[0], "0:2:3", "x");
    make(&axes[1], "-1:1:5", "y");
    assert_int_equal(lq_table_create(&table, axes, 2, names, 1, NULL), LQ_OK);
    for (size_t j = 0; j < 5; j++)
        for (size_t i = 0; i < 3; i++)
            table->channels[0][i + 3 * j] = (float)(axes[0].nodes[i] + 10 * axes[1].nodes[j]);
    const double point[] = {1.25, 0.3}, corner[] = {2, 1}, outside[] = {-5, 7};
    assert_true(fabs(lq_table_lookup(table, 0, point) - 4.25) < 1e-14);
    assert_true(lq_table_lookup(table, 0, corner) == 12);
    assert_true(lq_table_lookup(table, 0, outside) == 10);
    lq_table_free(table);
    for (int i = 0; i < 2; i++) lq_axis_free(&axes[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_create),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_absurd_sizes),
#ifndef __SANITIZE_ADDRESS__
        cmocka_unit_test(test_no_memory),
#endif
        cmocka_unit_test(test_facts),
        cmocka_unit_test(test_lookup),
        cmocka_unit_test(test_lookup_linear_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
