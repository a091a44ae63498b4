/* `albedo`, `albedo-average`, `dfg`: first-bounce tables that every renderer needs.
 *
 * albedo           E(mu, alpha): FGD at F = 1, single scattering
 * albedo-average   2 integral E mu dmu
 * dfg              the split sum of Schlick's Fresnel, FGD = F0 A + F90 B (Karis 2013)
 */
#include "precompute/first_bounce.h"
#include "precompute/kinds.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>

enum { MU, ALPHA };

static double clamp(double x) {
    return fmin(fmax(x, 0.0), 1.0);
}

/* -------------------------------------------------------------------------------- albedo */

static lq_status albedo_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                              double *estimate, lq_error *error) {
    (void)state;
    (void)error;
    const double alpha = job->nodes[ALPHA][index];
    if (alpha < LQ_SMOOTH_ALPHA) {
        for (size_t m = 0; m < job->size[MU]; m++) values[0][m] = 1.0;
        *estimate = lq_smooth_masking_error(alpha, job->nodes[MU], job->size[MU]);
        return LQ_OK;
    }
    lq_curves curves;
    lq_curves_none(&curves);
    *estimate = lq_first_bounce_converged(job->ndf, alpha, job->masking, job->nodes[MU], job->size[MU],
                                          &curves, job->tolerance, values[0]);
    for (size_t m = 0; m < job->size[MU]; m++) values[0][m] = clamp(values[0][m]);
    return LQ_OK;
}

const lq_evaluator lq_evaluate_albedo = {"albedo", ALPHA, 1.0, NULL, albedo_slice, NULL};

/* ------------------------------------------------------------------------ albedo-average */

/* Nodes of the outer integral, from coarse to fine. E goes like mu log mu at grazing over mu ~ alpha, so the
 * axis is split at alpha 4^k and the nodes crowd quadratically towards 0. */
static const int mu_nodes[] = {8, 12, 16, 24, 32};

static lq_status average_at(const lq_job *job, double alpha, int count, double *average, double *estimate,
                            lq_error *error) {
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, count);
    lq_panels_start(&panels, 0.0, 1.0);
    panels.singular[0] = true;
    for (double at = alpha; at < 1.0; at *= 4.0) lq_panels_add(&panels, at, false);
    const size_t points = (size_t)(panels.count - 1) * (size_t)count;
    double *mu = malloc(3 * points * sizeof *mu);
    if (!mu) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", points);
    double *weight = mu + points, *energy = weight + points;
    for (size_t i = 0; i < points; i++) {
        double slope;
        const int q = (int)(i % (size_t)count);
        mu[i] = lq_panels_map(&panels, (int)(i / (size_t)count), rule.node[q], &slope);
        weight[i] = 2.0 * mu[i] * rule.weight[q] * slope;
    }
    lq_curves curves;
    lq_curves_none(&curves);
    *estimate = lq_first_bounce_converged(job->ndf, alpha, job->masking, mu, points, &curves,
                                          0.5 * job->tolerance, energy);
    *average = 0.0;
    for (size_t i = 0; i < points; i++) *average += weight[i] * energy[i];
    free(mu);
    return LQ_OK;
}

static lq_status average_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                               double *estimate, lq_error *error) {
    (void)state;
    const double alpha = job->nodes[0][index];
    values[0][0] = 1.0;
    *estimate = 2.0 * alpha; /* a tenth at most over cosines of a few alpha */
    if (alpha < LQ_SMOOTH_ALPHA) return LQ_OK;
    double before = 0.0;
    for (size_t level = 0; level < sizeof mu_nodes / sizeof mu_nodes[0]; level++) {
        double now, inner;
        const lq_status status = average_at(job, alpha, mu_nodes[level], &now, &inner, error);
        if (status != LQ_OK) return status;
        *estimate = inner + fabs(now - before);
        values[0][0] = clamp(now);
        before = now;
        if (level > 0 && *estimate <= job->tolerance) break;
    }
    return LQ_OK;
}

const lq_evaluator lq_evaluate_albedo_average = {"albedo-average", 0, 1.0, NULL, average_slice, NULL};

/* ----------------------------------------------------------------------------------- dfg */

/* Schlick's curve is 1 - (1-c)^5, so its integral is A itself and B is the rest of the albedo. */
static lq_status dfg_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                           double *estimate, lq_error *error) {
    (void)state;
    const double alpha = job->nodes[ALPHA][index];
    const size_t count = job->size[MU];
    double *both = malloc(2 * count * sizeof *both);
    if (!both) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    lq_curves curves;
    lq_curves_schlick(&curves);
    *estimate = lq_smooth_masking_error(alpha, job->nodes[MU], count) + 1e-15;
    if (alpha >= LQ_SMOOTH_ALPHA)
        *estimate = 2.0 * lq_first_bounce_converged(job->ndf, alpha, job->masking, job->nodes[MU], count,
                                                    &curves, 0.5 * job->tolerance, both);
    else
        for (size_t m = 0; m < count; m++) lq_curves_at(&curves, job->nodes[MU][m], both + 2 * m);
    for (size_t m = 0; m < count; m++) {
        values[0][m] = clamp(both[2 * m + 1]);
        values[1][m] = clamp(both[2 * m] - both[2 * m + 1]);
    }
    free(both);
    return LQ_OK;
}

const lq_evaluator lq_evaluate_dfg = {"dfg", ALPHA, 1.0, NULL, dfg_slice, NULL};
