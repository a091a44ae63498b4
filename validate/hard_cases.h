/* The cases at which tables go wrong: ends of axes, limits, singular points; each with the limit it must
 * have. */
#ifndef LACQUER_VALIDATE_HARD_CASES_H
#define LACQUER_VALIDATE_HARD_CASES_H

#include "lacquer.h"

typedef struct lq_hard_result {
    const char *group;  /* "alpha = 0" */
    char asked[160];    /* table, point, and where the limit comes from */
    double least, most; /* of the values found; equal where it is one */
    double low, high;   /* what they must lie between */
    bool passed;        /* false for a NaN */
} lq_hard_result;

/* What is examined: lq_eval and lq_precompute, or a test's damaged ones. */
typedef struct lq_hard_source {
    lq_status (*eval)(const lq_kind *kind, const lq_settings *settings, const double *point, double *values,
                      double *estimate, lq_error *error);
    lq_status (*precompute)(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                            const lq_progress *progress, lq_table **table, lq_error *error);
} lq_hard_source;

typedef struct lq_hard_run {
    lq_hard_source source;
    const char *ndf; /* limits that hold for GGX only are left out for others */
    int threads;
    void (*report)(void *user, const lq_hard_result *result);
    void *user;
    const lq_progress *progress; /* or NULL */
} lq_hard_run;

/* Every single case, then every kind over the grid of all hard values of its axes: each value must be in
 * range, and where two kinds share the flux they must add up to 1. */
lq_status lq_hard_cases(const lq_hard_run *run, lq_error *error);

/* Part of it: the roughness mapping of the NDF and the phase function, at their ends. */
lq_status lq_hard_mappings(const lq_hard_run *run, lq_error *error);

#endif
