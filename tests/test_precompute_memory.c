/* test_precompute_memory.c - every allocation of a computation fails once: an error or the right values. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lacquer.h"
#include "tests/failing_malloc.h"

/* What is asked of the library; `values` has room for ORDERS. */
typedef lq_status ask(double *values, lq_error *error);

enum { ORDERS = 5 };

static lq_status ask_orders(double *values, lq_error *error) {
    const lq_settings settings = lq_settings_default();
    const double point[] = {0.5, 0.3, 0.2, 3.9};
    return lq_eval_orders(&settings, point, ORDERS, values, error);
}

static lq_status ask_kind(const char *id, const double *point, double *values, lq_error *error) {
    lq_settings settings = lq_settings_default();
    double estimate;
    settings.tolerance = 1e-3;
    return lq_eval(lq_kind_find(id, NULL), &settings, point, values, &estimate, error);
}

static lq_status ask_fgd(double *values, lq_error *error) {
    return ask_kind("fgd", (const double[]){0.5, 0.3, 0.2, 3.9}, values, error);
}

static lq_status ask_dfg(double *values, lq_error *error) {
    return ask_kind("dfg", (const double[]){0.5, 0.3}, values, error);
}

static lq_status ask_average(double *values, lq_error *error) {
    return ask_kind("albedo-average", (const double[]){0.3}, values, error);
}

static lq_status ask_tir(double *values, lq_error *error) {
    return ask_kind("tir-pass", (const double[]){0.5, 0.3, 0.7}, values, error);
}

static lq_status ask_dielectric(double *values, lq_error *error) {
    return ask_kind("fgd-dielectric", (const double[]){0.5, 0.3, 1.5}, values, error);
}

static lq_status ask_coated(double *values, lq_error *error) {
    return ask_kind("coated-lambertian", (const double[]){0.5, 0.3, 1.5, 0.9, 0.5}, values, error);
}

/* Returns how many allocations there were to fail. */
static int fail_each(ask *question) {
    double right[ORDERS] = {0.0};
    lq_error error;
    int failures = 0;
    assert_int_equal(question(right, &error), LQ_OK);
    for (long n = 0;; n++) {
        double values[ORDERS] = {0.0};
        strcpy(error.text, "");
        countdown = n;
        const lq_status status = question(values, &error);
        const bool reached = countdown < 0;
        countdown = -1;
        if (!reached) return failures;
        for (int i = 0; status == LQ_OK && i < ORDERS; i++)
            if (!(fabs(values[i] - right[i]) <= 2e-3)) fail_msg("allocation %ld: a wrong value", n);
        failures += status != LQ_OK;
        if (status != LQ_OK && !*error.text) fail_msg("allocation %ld: no message", n);
    }
}

static void every_allocation_fails(void **state) {
    (void)state;
    ask *const all[] = {ask_orders, ask_fgd, ask_dfg, ask_average, ask_tir, ask_dielectric, ask_coated};
    int failures = 0;
    if (!can_fail()) skip();
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) failures += fail_each(all[i]);
    assert_true(failures > 50);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation_fails)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
