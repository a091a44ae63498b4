/* test_tables_memory.c - every allocation of a table's life fails once: an error each time, no crash. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "lacquer.h"
#include "tests/failing_malloc.h"

static lq_status make_table(lq_table **table, lq_error *error) {
    lq_axis axes[2];
    const char *channels[] = {"b", "a"};
    *table = NULL;
    lq_status status = lq_axis_parse(&axes[0], "mu", "0:1:4:sqrt", error);
    if (status) return status;
    status = lq_axis_parse(&axes[1], "alpha", "0,0.5,1", error);
    if (status == LQ_OK) status = lq_table_create(table, axes, 2, channels, 2, error);
    if (status == LQ_OK) status = lq_table_set_fact(*table, "ndf", "ggx", error);
    if (status == LQ_OK) status = lq_table_set_fact(*table, "ndf", "beckmann", error);
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
    return status;
}

static lq_status live(const char *path, lq_error *error) {
    lq_table *table, *back = NULL;
    lq_status status = make_table(&table, error);
    if (status == LQ_OK) status = lq_table_write_npy(table, path, error);
    if (status == LQ_OK) status = lq_table_write_exr(table, path, error);
    if (status == LQ_OK) status = lq_table_read_exr(&back, path, error);
    if (status == LQ_OK) assert_memory_equal(table->channels[1], back->channels[1], 12 * sizeof(float));
    lq_table_free(table);
    lq_table_free(back);
    return status;
}

static void test_every_allocation_fails(void **state) {
    (void)state;
    char path[] = "/tmp/lacquer-test-memory-XXXXXX";
    lq_error error;
    int file, failures = 0;
    if (!can_fail()) skip();
    file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(live(path, &error),
                     LQ_OK); /* the OpenMP runtime, which exits without memory, is ready */
    for (long n = 0;; n++) {
        strcpy(error.text, "");
        countdown = n;
        lq_status status = live(path, &error);
        bool reached = countdown < 0;
        countdown = -1;
        if (!reached) break;
        if (status == LQ_OK) continue; /* one that a library can do without */
        failures++;
        if (!*error.text) fail_msg("allocation %ld: status %d without a message", n, (int)status);
    }
    unlink(path);
    assert_true(failures > 50);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_allocation_fails)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
