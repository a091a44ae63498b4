/* The C face of Ceres: fit the logarithm of a family to that of measured values. */
#ifndef LACQUER_FIT_LEAST_SQUARES_H
#define LACQUER_FIT_LEAST_SQUARES_H

#include "fit/family.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lq_fit_problem {
    int family;
    size_t count;
    const double *x; /* LQ_FAMILY_COORDINATES a point */
    const double *y; /* > 0 */
    double loss;     /* > 0: scale of a Cauchy loss on the relative residual; 0: squares */
    int rounds;      /* > 0: Lawson's reweighting towards the smallest largest residual */
} lq_fit_problem;

typedef struct lq_fit_answer {
    double p[LQ_FAMILY_PARAMETERS];
    /* residual variance times (J^T J)^-1 of relative residuals, unweighted; row after row; NaN: singular */
    double covariance[LQ_FAMILY_PARAMETERS * LQ_FAMILY_PARAMETERS];
    int iterations;
} lq_fit_answer;

/* 0, or -1 and one line in `message` (size bytes). */
int lq_fit_solve(const lq_fit_problem *problem, lq_fit_answer *answer, char *message, size_t size);

#ifdef __cplusplus
}
#endif
#endif
