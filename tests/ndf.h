/* What the tests of NDFs share: open one, ask for a value, compare it with a walk, expect a refusal. */
#ifndef LACQUER_TESTS_NDF_H
#define LACQUER_TESTS_NDF_H

#include "tests/expect.h"
#include "validate/walk_kind.h"

#include <string.h>

static inline const lq_ndf *open_ndf(const char *text) {
    const lq_ndf *ndf;
    lq_error error = {""};
    if (lq_ndf_open(&ndf, text, &error) != LQ_OK) fail_msg("%s: %s", text, error.text);
    return ndf;
}

/* At a tolerance; 0: that of the kind. */
static inline double value_within(const char *kind, const char *ndf, const double *point, double tolerance,
                                  double *estimate) {
    lq_settings settings = lq_settings_default();
    lq_error error = {""};
    double values[LQ_MAX_CHANNELS];
    settings.ndf = ndf;
    settings.tolerance = tolerance;
    if (lq_eval(lq_kind_find(kind, NULL), &settings, point, values, estimate, &error) != LQ_OK)
        fail_msg("%s, %s: %s", kind, ndf, error.text);
    return values[0];
}

static inline double value_of(const char *kind, const char *ndf, const double *point, double *estimate) {
    return value_within(kind, ndf, point, 0.0, estimate);
}

/* Solver against a random walk that shares the NDF and Fresnel code alone. */
static inline void expect_walk_agrees(const char *kind, const char *ndf, const double *point,
                                      double tolerance) {
    const lq_walk_run run = {.samples = 8000, .seed = 7, .threads = 1};
    lq_settings settings = lq_settings_default();
    lq_walk_mean mean[LQ_MAX_CHANNELS];
    lq_error error = {""};
    double estimate;
    settings.ndf = ndf;
    const double value = value_within(kind, ndf, point, tolerance, &estimate);
    if (lq_walk_kind(lq_kind_find(kind, NULL), &settings, point, &run, mean, &error) != LQ_OK)
        fail_msg("%s", error.text);
    if (!(fabs(value - mean[0].mean) <= 4.0 * lq_walk_noise(mean[0], run.samples) + estimate))
        fail_msg("%s, %s: %.6f, walk %.6f +- %.6f", kind, ndf, value, mean[0].mean, mean[0].error);
}

static inline void expect_refused(const char *text, lq_status status, const char *part) {
    const lq_ndf *ndf;
    lq_error error = {""};
    assert_int_equal(lq_ndf_open(&ndf, text, &error), status);
    assert_null(ndf);
    if (!strstr(error.text, part)) fail_msg("'%s' does not say '%s'", error.text, part);
    assert_null(strchr(error.text, '\n'));
}

#endif
