/* The transmitted lobe over alpha, eta and incidence: measured, by B18 eq. 10, and what the projected disc
 * makes of a lobe that crosses (B18 eq. 13). */
#include "fit/transmission.h"
#include "microfacet/lobe.h"
#include "program/fit/bounces.h"
#include "program/message.h"

#include <math.h>

static const double etas[] = {0.5, 1 / 1.5, 1 / 1.33, 1.33, 1.5, 2.0};
static const double cosines[] = {1.0, 0.8, 0.6, 0.4, 0.2};
static const double alphas[] = {0.02, 0.1, 0.3, 0.6};
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

static json_t *lobe_row(const fit_job *job, double eta, double mu, double alpha) {
    double passed, estimate;
    const double v = lq_transmitted_variance(job->ndf, alpha, eta, mu, &passed, &estimate);
    const double scale = lq_transmission_scale(eta, mu, NULL);
    const double narrow = lq_lobe_variance(job->ndf, fmin(scale * alpha, 1.0));
    printf("%6.4f  %4.2f  %4.2f  %6.4f  %.4e +- %.0e", eta, mu, alpha, passed, v, estimate);
    if (isfinite(scale)) printf("   %.4e %+8.1f %%\n", narrow, 100.0 * (narrow / v - 1.0));
    else printf("   total reflection\n");
    return json_pack("{s:f, s:f, s:f, s:o, s:o, s:o, s:o}", "eta", eta, "mu", mu, "alpha", alpha, "passed",
                     lq_json_number(passed), "variance", lq_json_number(v), "error-estimate",
                     lq_json_number(estimate), "equation-10", lq_json_number(isfinite(scale) ? narrow : NAN));
}

/* A lobe of alpha = 0.1 through a smooth interface. */
static json_t *disc_row(const fit_job *job, double eta) {
    const double beta = 0.1, before = lq_lobe_variance(job->ndf, beta);
    double estimate;
    const double after = lq_transmitted_lobe_variance(job->ndf, beta, 0.0, eta, &estimate);
    printf("%6.4f  %.6f +- %.0e   %.6f   %.6f\n", eta, after / before, estimate / before, 1.0 / (eta * eta),
           eta);
    return json_pack("{s:f, s:o, s:o, s:f, s:f}", "eta", eta, "scale-of-variance",
                     lq_json_number(after / before), "error-estimate", lq_json_number(estimate / before),
                     "eta12-squared", 1.0 / (eta * eta), "equation-13", eta);
}

json_t *fit_transmitted(const fit_job *job) {
    json_t *rows = json_array();
    printf("Transmitted lobes of %s, F = 0, G = 1: variance in the projected disc, and v1 of the roughness "
           "of B18\n"
           "eq. 10\n   eta    mu  alpha  passed  variance              eq. 10\n",
           lq_ndf_text(job->ndf));
    for (int e = 0; e < COUNT(etas); e++)
        for (int m = 0; m < COUNT(cosines); m++)
            for (int a = 0; a < COUNT(alphas); a++)
                lq_json_append(&rows, lobe_row(job, etas[e], cosines[m], alphas[a]));
    printf("A lobe of alpha = 0.1 through a smooth interface: what its variance is scaled by, the disc's "
           "eta12^2,\n"
           "and B18 eq. 13's 1/eta12\n   eta  measured              eta12^2    1/eta12\n");
    for (int e = COUNT(etas) / 2; e < COUNT(etas); e++) lq_json_append(&rows, disc_row(job, etas[e]));
    if (!rows) cli_message("no memory for the rows");
    return rows;
}
