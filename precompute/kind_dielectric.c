/* `fgd-dielectric` and `transmission` (D22 sec. 3-4): energies of every cosine. */
#include "precompute/eta_curve.h"
#include "precompute/kinds.h"
#include "precompute/two_sided.h"
#include "system/status.h"

#include <stdlib.h>
#include <string.h>

static const double no_loss = 1.0;

/* What is solved of one roughness at one index after the other. */
typedef struct rough_directional {
    lq_rough *rough;
    lq_directional asked;
} rough_directional;

static lq_status solve_directional_at(const void *user, double eta, double tolerance, double *values,
                                      double *estimate, lq_error *error) {
    const rough_directional *r = user;
    return lq_directional_solve(r->rough, eta, tolerance, &r->asked, values, estimate, error);
}

/* fgd-dielectric: mu, alpha, eta. transmission: mu, alpha, eta, tau. */
static lq_status directional_slice(const lq_job *job, size_t index, int reward_side, const double *tau,
                                   size_t tau_count, double *values, double *estimate, lq_error *error) {
    enum { MU, ALPHA, ETA };
    const size_t mus = job->size[MU], etas = job->size[ETA], count = mus * tau_count;
    lq_rough rough = lq_rough_start(job->ndf, job->nodes[ALPHA][index]);
    const rough_directional r = {&rough, {job->scattering, reward_side, job->nodes[MU], mus, tau, tau_count}};
    const lq_eta_curve curve = {solve_directional_at, &r, count, lq_dielectric_regular_from(&rough),
                                job->tolerance};
    double *all = malloc(etas * count * sizeof *all);
    lq_status status = all ? lq_eta_sweep(&curve, job->nodes[ETA], etas, all, estimate, error)
                           : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", etas * count);
    for (size_t e = 0; status == LQ_OK && e < etas; e++)
        for (size_t t = 0; t < tau_count; t++)
            memcpy(values + (t * etas + e) * mus, all + e * count + t * mus, mus * sizeof *values);
    free(all);
    lq_rough_free(&rough);
    return status;
}

static lq_status fgd_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                           double *estimate, lq_error *error) {
    (void)state;
    return directional_slice(job, index, 0, &no_loss, 1, values[0], estimate, error);
}

static lq_status transmission_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                                    double *estimate, lq_error *error) {
    (void)state;
    return directional_slice(job, index, 1, job->nodes[3], job->size[3], values[0], estimate, error);
}

const lq_evaluator lq_evaluate_fgd_dielectric = {"fgd-dielectric", 1, 20.0, NULL, fgd_slice, NULL};
const lq_evaluator lq_evaluate_transmission = {"transmission", 1, 30.0, NULL, transmission_slice, NULL};
