/* What the files of `lacquer fit` share: the request, the points of a mapping, the fit. */
#ifndef LACQUER_PROGRAM_FIT_FIT_H
#define LACQUER_PROGRAM_FIT_FIT_H

#include "fit/curve.h"
#include "fit/family.h"
#include "fit/least_squares.h"

#include <stdbool.h>

typedef enum fit_table { FIT_NO_TABLE, FIT_BOUNCES, FIT_ANISOTROPIC, FIT_TRANSMITTED } fit_table;

typedef struct fit_request {
    lq_mapping mapping;
    fit_table table;                                 /* instead of the fit of the mapping */
    size_t samples;                                  /* of a table; 0: the default */
    bool has_mapping, smallest_rms, pole_ends_range; /* the last: no --range was given */
    const char *family_name, *ndf_text, *output, *report, *texture, *snippet;
    double range[2]; /* as given */
    int norm;        /* of the option: max, rms */
    double low, high, loss;
    size_t points;
    int family;
} fit_request;

/* How well coefficients do on the points, relative. */
typedef struct fit_errors {
    double rms, max, max_at;
} fit_errors;

typedef struct fit_job {
    fit_request request;
    const lq_ndf *ndf;
    lq_curve curve; /* variance and hg */
    size_t count;
    double *x, *y;
    lq_fit_answer answer;
    fit_errors errors;
    int published; /* family with the paper's constants, or -1 */
    double published_p[LQ_FAMILY_PARAMETERS];
    fit_errors published_errors;
} fit_job;

/* The points of the mapping over the range. False: a line was printed. */
bool fit_measure(fit_job *job);
fit_errors fit_errors_of(const fit_job *job, int family, const double *p);
/* Runs lacquer-fit. False: a line was printed. */
bool fit_run_engine(const lq_fit_problem *problem, lq_fit_answer *answer);

/* The files; false: a line was printed. */
bool fit_write_json(const fit_job *job);
bool fit_write_report(const fit_job *job);
bool fit_write_snippet(const fit_job *job);
bool fit_write_texture(const fit_job *job);

#endif
