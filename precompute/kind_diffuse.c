/* `diffuse-transmission`, `diffuse-reflection` and `variance` (D22 sec. 3-4): cosine-weighted means.
 *
 * sigma^2 = mean of (1 - mu^2) T01 / mean of T01, by the reciprocity of two_sided.h; its roughness is solved
 * for, and interpolated between indices, beside it. */
#include "microfacet/lobe.h"
#include "precompute/eta_curve.h"
#include "precompute/kinds.h"
#include "precompute/two_sided.h"
#include "system/status.h"

#include <stdlib.h>
#include <string.h>

static const double no_loss = 1.0;

static lq_status variance_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                                 lq_error *error) {
    (void)asked;
    lq_mean_rule mean;
    double answer[LQ_MEAN_MAX], flux = 0.0, moment = 0.0;
    lq_mean_make(&mean, rough->alpha, eta, level);
    const lq_question question = {0, 1, LQ_MULTIPLE, mean.mu, mean.count, &no_loss, 1, answer};
    const lq_status status = lq_dielectric_answer(rough, eta, level, &question, 1, error);
    for (size_t q = 0; status == LQ_OK && q < mean.count; q++) {
        flux += mean.weight[q] * answer[q];
        moment += mean.weight[q] * answer[q] * (1.0 - mean.mu[q]) * (1.0 + mean.mu[q]);
    }
    values[0] = flux > 0.0 ? moment / flux : 0.0;
    values[1] = lq_lobe_roughness(rough->ndf, values[0]);
    return status;
}

typedef struct rough_diffuse {
    lq_rough *rough;
    lq_level_values *evaluate;
    lq_diffuse asked;
    size_t count; /* values at one index */
} rough_diffuse;

static lq_status solve_diffuse_at(const void *user, double eta, double tolerance, double *values,
                                  double *estimate, lq_error *error) {
    const rough_diffuse *r = user;
    return lq_mean_solve(r->rough, eta, tolerance, r->evaluate, &r->asked, r->count, values, estimate, error);
}

/* Kinds over eta, alpha(, tau): the slice is the roughness, the second axis. `taus`: values at one index. */
static lq_status diffuse_slice(const lq_job *job, double tolerance, size_t index, lq_level_values *evaluate,
                               bool transmitted, size_t taus, double *values, double *estimate,
                               lq_error *error) {
    enum { ETA, ALPHA, TAU };
    const size_t etas = job->size[ETA];
    lq_rough rough = lq_rough_start(job->ndf, job->nodes[ALPHA][index]);
    const lq_diffuse asked = {job->kind->axis_count > TAU ? job->nodes[TAU] : &no_loss, taus, transmitted,
                              !transmitted};
    const rough_diffuse r = {&rough, evaluate, asked, taus};
    const lq_eta_curve curve = {solve_diffuse_at, &r, taus, lq_dielectric_regular_from(&rough), tolerance};
    double *all = malloc(etas * taus * sizeof *all);
    lq_status status = all ? lq_eta_sweep(&curve, job->nodes[ETA], etas, all, estimate, error)
                           : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", etas * taus);
    for (size_t e = 0; status == LQ_OK && e < etas; e++)
        for (size_t t = 0; t < taus; t++) values[t * etas + e] = all[e * taus + t];
    free(all);
    lq_rough_free(&rough);
    return status;
}

static lq_status diffuse_transmission_slice(const lq_job *job, const void *state, size_t index,
                                            double *const *values, double *estimate, lq_error *error) {
    (void)state;
    return diffuse_slice(job, job->tolerance, index, lq_diffuse_values, true, job->size[2], values[0],
                         estimate, error);
}

static lq_status diffuse_reflection_slice(const lq_job *job, const void *state, size_t index,
                                          double *const *values, double *estimate, lq_error *error) {
    (void)state;
    return diffuse_slice(job, job->tolerance, index, lq_diffuse_values, false, job->size[2], values[0],
                         estimate, error);
}

/* The roughness moves dalpha/dv1 times as much as the variance, no more than this where these variances lie.
 */
static const double ROUGHNESS_SLOPE = 2.5;

static lq_status variance_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                                double *estimate, lq_error *error) {
    enum { BOTH = 2 };
    (void)state;
    const size_t etas = job->size[0];
    double *both = malloc(BOTH * etas * sizeof *both);
    if (!both) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", BOTH * etas);
    const lq_status status = diffuse_slice(job, job->tolerance / ROUGHNESS_SLOPE, index, variance_values,
                                           true, BOTH, both, estimate, error);
    for (int c = 0; status == LQ_OK && c < BOTH; c++)
        memcpy(values[c], both + (size_t)c * etas, etas * sizeof *both);
    *estimate *= ROUGHNESS_SLOPE;
    free(both);
    return status;
}

const lq_evaluator lq_evaluate_diffuse_transmission = {"diffuse-transmission",     1,   0.3, NULL,
                                                       diffuse_transmission_slice, NULL};
const lq_evaluator lq_evaluate_diffuse_reflection = {"diffuse-reflection",     1,   1.0, NULL,
                                                     diffuse_reflection_slice, NULL};
const lq_evaluator lq_evaluate_variance = {"variance", 1, 0.1, NULL, variance_slice, NULL};
