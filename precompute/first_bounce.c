/* First bounce: one facet integral a cosine, refined as a whole until it no longer moves. */
#include "precompute/first_bounce.h"

#include "precompute/kernels.h"

#include <math.h>

/* What is added up over the fans of one cosine. */
typedef struct sums {
    const lq_ndf *ndf;
    const lq_curves *curves;
    const lq_solver_kernels *kernels;
    double alpha;
    double area_in, mu_in; /* of the incident direction, as G wants them */
    double total;          /* of all weights: sigma(v) */
    double *escaping, *remaining;
} sums;

static void add_fan(void *user, const lq_fan *fan) {
    sums *s = user;
    double curve[LQ_CURVES_MAX], area[LQ_FAN_MAX];
    const size_t up = (size_t)fan->up;
    s->ndf->areas_below(s->ndf, s->alpha, up, fan->mirror, area);
    const double leaves = s->kernels->escaping(s->area_in, s->mu_in, up, fan->mirror, area, fan->weight);
    double all = 0.0;
    for (int i = 0; i < fan->count; i++) all += fan->weight[i];
    s->total += all;
    lq_curves_at(s->curves, fan->cos_d, curve);
    for (int k = 0; k < s->curves->count; k++) {
        s->escaping[k] += curve[k] * leaves;
        s->remaining[k] += curve[k] * (all - leaves);
    }
}

void lq_first_bounce(const lq_ndf *ndf, double alpha, lq_masking masking, double mu, const lq_curves *curves,
                     const lq_facet_rule *rule, double *escaping, double *remaining) {
    const double sine = lq_sine(mu);
    sums s = {ndf, curves, lq_solver_kernels_get(), alpha, 1.0, 1.0, 0.0, escaping, remaining};
    if (masking == LQ_CORRELATED) {
        s.area_in = lq_area_above(ndf, alpha, mu, sine);
        s.mu_in = mu;
    }
    for (int k = 0; k < curves->count; k++) escaping[k] = remaining[k] = 0.0;
    lq_facets_visit(ndf, alpha, mu, sine, rule, &curves->panels, add_fan, &s);
    for (int k = 0; k < curves->count; k++) {
        escaping[k] /= s.total;
        remaining[k] /= s.total;
    }
}

/* Nodes per panel of d, and per piece of azimuth, from coarse to fine. Both grow from row to row, or the
 * error of one would not show in the difference. */
static const int resolutions[][2] = {{6, 8}, {8, 12}, {12, 16}, {16, 24}, {24, 32}, {32, 48}, {48, 64}};
enum { RESOLUTIONS = sizeof resolutions / sizeof resolutions[0] };

double lq_first_bounce_converged(const lq_ndf *ndf, double alpha, lq_masking masking, const double *mu,
                                 size_t count, const lq_curves *curves, double tolerance, double *escaping) {
    double estimate = INFINITY;
    for (int level = 0; level < RESOLUTIONS && estimate > tolerance; level++) {
        lq_facet_rule rule;
        lq_facet_rule_make(&rule, resolutions[level][0], resolutions[level][1]);
        double change = 0.0;
        for (size_t m = 0; m < count; m++) {
            double now[LQ_CURVES_MAX], remaining[LQ_CURVES_MAX];
            lq_first_bounce(ndf, alpha, masking, mu[m], curves, &rule, now, remaining);
            for (int k = 0; k < curves->count; k++) {
                double *kept = escaping + m * (size_t)curves->count + k;
                if (level > 0) change = fmax(change, fabs(now[k] - *kept));
                *kept = now[k];
            }
        }
        if (level > 0) estimate = fmax(2.0 * change, 0.1 * tolerance);
    }
    return estimate;
}

double lq_smooth_masking_error(double alpha, const double *mu, size_t count) {
    double worst = 0.0;
    for (size_t i = 0; i < count; i++)
        if (alpha > 0.0)
            worst = fmax(worst, mu[i] > 0.0 ? fmin(alpha / mu[i] * (alpha / mu[i]), 0.12) : 0.12);
    return worst;
}
