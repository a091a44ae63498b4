/* `coated-lambertian`: the albedo of a diffuse base under a rough coating (D22 eq. 3). */
#include "precompute/kinds.h"
#include "precompute/two_sided.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Albedo of one coated base at every cosine and base albedo (D22 eq. 3): R01 + T01 rho/(1 - rho R10mean)
 * T10mean. */
typedef struct pieces {
    double *t01;       /* [tau * mus + mu]; a row more for tau = 1 */
    double *r01;       /* [mu] */
    double *t10, *r10; /* [tau], one behind the other */
    double error;
} pieces;

static lq_status solve_pieces(const lq_job *job, lq_rough *rough, double eta, double tolerance, pieces *p,
                              lq_error *error) {
    enum { MU, ALPHA, ETA, TAU };
    const size_t taus = job->size[TAU], mus = job->size[MU];
    const lq_diffuse d = {job->nodes[TAU], taus, true, true};
    double *tau = malloc((taus + 1) * sizeof *tau), estimate[2] = {0.0};
    if (!tau) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu transmittances", taus);
    memcpy(tau, d.tau, taus * sizeof *tau);
    tau[taus] = 1.0;
    const lq_directional in = {LQ_MULTIPLE, 1, job->nodes[MU], mus, tau, taus + 1};
    lq_status status = lq_directional_solve(rough, eta, tolerance, &in, p->t01, &estimate[0], error);
    for (size_t m = 0; m < mus; m++) p->r01[m] = 1.0 - p->t01[taus * mus + m];
    if (status == LQ_OK)
        status = lq_mean_solve(rough, eta, tolerance, lq_diffuse_values, &d, 2 * taus, p->t10, &estimate[1],
                               error);
    free(tau);
    p->error = fmax(estimate[0], estimate[1]);
    return status;
}

/* One interface into the slice; returns the largest error. d albedo = dR + g T10 dT + g T dT10 + g^2 T T10
 * dR10 with g = rho / (1 - rho R10). */
static double combine_pieces(const lq_job *job, const pieces *p, size_t e, double *values) {
    enum { MU, ALPHA, ETA, TAU, RHO };
    const size_t mus = job->size[MU], etas = job->size[ETA], taus = job->size[TAU];
    double worst = 0.0;
    for (size_t r = 0; r < job->size[RHO]; r++)
        for (size_t t = 0; t < taus; t++)
            for (size_t m = 0; m < mus; m++) {
                const double rho = job->nodes[RHO][r], through = p->t01[t * mus + m], out = p->t10[t];
                const double gain = rho / (1.0 - rho * p->r10[t]);
                const double albedo = p->r01[m] + through * gain * out;
                const double slope = 1.0 + gain * out + gain * through + gain * gain * through * out;
                values[((r * taus + t) * etas + e) * mus + m] = fmin(fmax(albedo, 0.0), 1.0);
                worst = fmax(worst, slope * p->error);
            }
    return worst;
}

static lq_status coated_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                              double *estimate, lq_error *error) {
    (void)state;
    enum { MU, ALPHA, ETA, TAU };
    const size_t mus = job->size[MU], taus = job->size[TAU];
    lq_rough rough = lq_rough_start(job->ndf, job->nodes[ALPHA][index]);
    double *block = malloc((2 * mus + mus * taus + 2 * taus) * sizeof *block);
    lq_status status = block ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mus);
    pieces p = {.t01 = block,
                .r01 = block + mus * (taus + 1),
                .t10 = block + mus * (taus + 2),
                .r10 = block + mus * (taus + 2) + taus};
    *estimate = 0.0;
    for (size_t e = 0; status == LQ_OK && e < job->size[ETA]; e++) {
        double worst = INFINITY;
        /* How much the product amplifies the errors of its factors is known only afterwards. */
        for (int attempt = 0; status == LQ_OK && attempt < 2 && worst > job->tolerance; attempt++) {
            const double tolerance =
                attempt == 0 ? 0.25 * job->tolerance : 0.8 * p.error * job->tolerance / worst;
            status = solve_pieces(job, &rough, job->nodes[ETA][e], tolerance, &p, error);
            if (status == LQ_OK) worst = combine_pieces(job, &p, e, values[0]);
        }
        *estimate = fmax(*estimate, worst);
    }
    free(block);
    lq_rough_free(&rough);
    return status;
}

const lq_evaluator lq_evaluate_coated_lambertian = {"coated-lambertian", 1, 3.0, NULL, coated_slice, NULL};
