/* normal.c - small systems of normal equations. */
#include "pca/normal.h"

#include <math.h>

#include "pca/stream.h"

static const double RIDGE = 1e-5; /* of the diagonal: what the samples do not tell apart stays where it is */

/* step <- full^-1 step by the Cholesky factors of the upper triangle of `full`, which they replace. A few
 * hundred thousand systems of ten unknowns a sweep: LAPACK's call costs more than its work there. */
static bool cholesky_solve(double *full, size_t n, double *step) {
    for (size_t a = 0; a < n; a++) {
        double *row = full + a * n;
        if (!(row[a] > 0.0)) return false;
        const double root = 1.0 / sqrt(row[a]);
        for (size_t b = a; b < n; b++) row[b] *= root;
        step[a] *= root;
        for (size_t b = a + 1; b < n; b++) {
            step[b] -= row[b] * step[a];
            for (size_t c = b; c < n; c++) full[b * n + c] -= row[b] * row[c];
        }
    }
    for (size_t a = n; a-- > 0;) {
        for (size_t b = a + 1; b < n; b++) step[a] -= full[a * n + b] * step[b];
        step[a] /= full[a * n + a];
    }
    return true;
}

/* Scaled to a unit diagonal first: bases differ in size by orders of magnitude, and single precision sums
 * hold each entry to some 1e-6 of the diagonal entries it belongs to. */
bool lq_normal_solve(const float *packed, size_t n, double *full, double *step) {
    double unit[LQ_MAX_BASES * LQ_MAX_PAIRS];
    const float *entry = packed;
    bool any = false;
    for (size_t a = 0; a < n; entry += n - a, a++) {
        unit[a] = *entry > 0.0f ? 1.0 / sqrt((double)*entry) : 0.0;
        any = any || *entry > 0.0f;
    }
    if (!any) return false; /* nothing depends on it */
    for (size_t a = 0; a < n; a++) {
        step[a] *= unit[a];
        for (size_t b = a; b < n; b++) full[a * n + b] = (double)*packed++ * unit[a] * unit[b];
        full[a * n + a] = 1.0 + RIDGE;
    }
    if (!cholesky_solve(full, n, step)) return false;
    for (size_t a = 0; a < n; a++) step[a] *= unit[a];
    return true;
}
