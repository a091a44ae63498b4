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
    double *shares; /* of `escaping`, SHARES a curve, and of `total`, behind them; NULL: not wanted */
    int panel_fans, fans;
} sums;

/* The integral is kept in parts, that of panel p of d in part p % SHARES: differences between two levels that
 * cancel in the sum show in the parts. */
enum { SHARES = 32 };

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
    const int part = s->fans / s->panel_fans % SHARES;
    for (int k = 0; k < s->curves->count; k++) {
        s->escaping[k] += curve[k] * leaves;
        s->remaining[k] += curve[k] * (all - leaves);
        if (s->shares) s->shares[k * SHARES + part] += curve[k] * leaves;
    }
    if (s->shares) s->shares[s->curves->count * SHARES + part] += all;
    s->fans++;
}

static void integrate(const lq_ndf *ndf, double alpha, lq_masking masking, double mu, const lq_curves *curves,
                      const lq_facet_rule *rule, double *escaping, double *remaining, double *shares) {
    const double sine = lq_sine(mu);
    sums s = {ndf,       curves, lq_solver_kernels_get(), alpha, 1.0, 1.0, 0.0, escaping,
              remaining, shares, rule->outer.count,       0};
    if (masking == LQ_CORRELATED) {
        s.area_in = lq_area_above(ndf, alpha, mu, sine);
        s.mu_in = mu;
    }
    for (int k = 0; k < curves->count; k++) escaping[k] = remaining[k] = 0.0;
    const int parts = shares ? (curves->count + 1) * SHARES : 0;
    for (int i = 0; i < parts; i++) shares[i] = 0.0;
    lq_facets_visit(ndf, alpha, mu, sine, rule, &curves->panels, add_fan, &s);
    for (int k = 0; k < curves->count; k++) {
        escaping[k] /= s.total;
        remaining[k] /= s.total;
    }
    for (int i = 0; i < parts; i++) shares[i] /= s.total;
}

void lq_first_bounce(const lq_ndf *ndf, double alpha, lq_masking masking, double mu, const lq_curves *curves,
                     const lq_facet_rule *rule, double *escaping, double *remaining) {
    integrate(ndf, alpha, masking, mu, curves, rule, escaping, remaining, NULL);
}

/* Nodes per panel of d, and per piece of azimuth, from coarse to fine. Both grow from row to row, or the
 * error of one would not show in the difference. */
static const int resolutions[][2] = {{6, 8}, {8, 12}, {12, 16}, {16, 24}, {24, 32}, {32, 48}, {48, 64}};
enum { RESOLUTIONS = sizeof resolutions / sizeof resolutions[0] };

/* The changes of the parts of one integral between two levels, added up without their signs. */
static double change_of_parts(const double *shares, const double *before, int integral) {
    double change = 0.0;
    for (int p = integral * SHARES; p < (integral + 1) * SHARES; p++) change += fabs(shares[p] - before[p]);
    return change;
}

/* The largest change of a curve. Every value is divided by the total, whose error comes from facets that send
 * no light out too, and shows in no part of what leaves: at alpha = 0.91, mu = 0.84 the total of Beckmann was
 * off by 1.3e-4 and 1.1e-4 on two levels in a row, its parts by ten times the difference. */
static double change_of(const double *shares, const double *before, const double *escaping, int curves) {
    const double total = change_of_parts(shares, before, curves);
    double most = 0.0;
    for (int k = 0; k < curves; k++)
        most = fmax(most, change_of_parts(shares, before, k) + escaping[k] * total);
    return most;
}

/* The difference of two totals is no measure: it changes sign along mu and alpha, and near a zero of it said
 * nothing (of 5,000 points of Beckmann 55 were off by more than twice the difference, one by 44 times). Parts
 * do not cancel; where the azimuth alone is not resolved they may still agree by chance, which the older
 * change guards, and at the first level, that has none, a larger factor. Distributions whose tails are not
 * GGX's, for which the azimuth is mapped, need both. */
double lq_first_bounce_estimate(double change, double older) {
    return older > 0.0 ? fmax(2.0 * change, 0.2 * older) : 6.0 * change;
}

/* The rules of the levels that some cosine needed: the finest cost as much as a coarse integral. */
typedef struct ladder {
    int made;
    lq_facet_rule rules[RESOLUTIONS];
} ladder;

static const lq_facet_rule *rule_at(ladder *l, int level) {
    for (; l->made <= level; l->made++)
        lq_facet_rule_make(&l->rules[l->made], resolutions[l->made][0], resolutions[l->made][1]);
    return &l->rules[level];
}

static double converge(const lq_ndf *ndf, double alpha, lq_masking masking, double mu,
                       const lq_curves *curves, double tolerance, ladder *rules, double *escaping) {
    /* Half, for parts of the total are in the change as well; not along the horizon, where levels converge so
     * slowly that half was short by up to an eighth. */
    const double share = mu < 1e-4 ? 1.0 : 0.5;
    double shares[2][(LQ_CURVES_MAX + 1) * SHARES], remaining[LQ_CURVES_MAX], estimate = INFINITY,
                                                                              older = 0.0;
    for (int level = 0; level < RESOLUTIONS && estimate > tolerance; level++) {
        double *now = shares[level % 2], *before = shares[1 - level % 2];
        integrate(ndf, alpha, masking, mu, curves, rule_at(rules, level), escaping, remaining, now);
        if (level == 0) continue;
        const double change = change_of(now, before, escaping, curves->count);
        estimate = fmax(share * lq_first_bounce_estimate(change, older), 0.1 * tolerance);
        older = change;
    }
    return estimate;
}

double lq_first_bounce_converged(const lq_ndf *ndf, double alpha, lq_masking masking, const double *mu,
                                 size_t count, const lq_curves *curves, double tolerance, double *escaping) {
    double estimate = 0.0;
    ladder rules = {.made = 0};
    for (size_t m = 0; m < count; m++)
        estimate = fmax(estimate, converge(ndf, alpha, masking, mu[m], curves, tolerance, &rules,
                                           escaping + m * (size_t)curves->count));
    return estimate;
}

double lq_smooth_masking_error(double alpha, const double *mu, size_t count) {
    double worst = 0.0;
    for (size_t i = 0; i < count; i++)
        if (alpha > 0.0)
            worst = fmax(worst, mu[i] > 0.0 ? fmin(alpha / mu[i] * (alpha / mu[i]), 0.12) : 0.12);
    return worst;
}
