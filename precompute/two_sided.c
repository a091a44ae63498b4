/* Energies of one interface, refined: see two_sided.h. */
#include "precompute/two_sided.h"

#include "precompute/first_bounce.h"
#include "precompute/series.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------- refinement */

/* Every level is at least 2.5 times as good as the one before, so that 1.25 of what has changed is twice what
 * is left. Seen from the denser side energies step at the critical angle, and the factor is 2 in places; a
 * step narrower than the nodes are apart can look alike on two levels by accident. */
static double caution(double alpha, double eta) {
    if (eta > 1.0) return 1.25;
    return alpha < 0.05 ? 6.0 : 2.0;
}

lq_status lq_refine(lq_rough *rough, double eta, double tolerance, lq_level_values *evaluate,
                    const void *asked, size_t count, double *values, double *estimate, lq_error *error) {
    double *now = malloc(count * sizeof *now);
    if (!now) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", count);
    lq_status status = LQ_OK;
    /* Levels 0 and 1 have the same angles between ray and facet, and from the denser side these tell. */
    const int first = lq_dielectric_is_nearly_matched(rough, eta) ? 2 : eta < 1.0 ? 1 : 0;
    *estimate = 1.0;
    /* Until a level settles, nothing is known but that energies lie between 0 and 1. */
    for (size_t i = 0; i < count; i++) values[i] = 0.5;
    for (int level = first; level < LQ_DIELECTRIC_LEVELS; level++) {
        if (*estimate <= tolerance) break;
        status = evaluate(rough, eta, level, asked, now, error);
        if (status != LQ_OK) break;
        double change = 0.0;
        for (size_t i = 0; level > first && i < count; i++) change = fmax(change, fabs(now[i] - values[i]));
        if (level > first) *estimate = fmax(caution(rough->alpha, eta) * change, 0.1 * tolerance);
        memcpy(values, now, count * sizeof *now);
    }
    free(now);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* --------------------------------------------------------------------------- transmittances */

lq_tau_nodes lq_tau_nodes_choose(const double *tau, size_t count, int level) {
    static const size_t nodes[LQ_DIELECTRIC_LEVELS] = {16, 24, 24, 32, 32, 32, 32};
    lq_tau_nodes t = {.count = count, .direct = count <= nodes[level]};
    if (!t.direct) t.count = nodes[level];
    for (size_t k = 0; k < t.count; k++) {
        const double v = 0.5 - 0.5 * cos(3.14159265358979323846 * (double)k / (double)(t.count - 1));
        t.tau[k] = t.direct ? tau[k] : v * v;
    }
    return t;
}

void lq_tau_weights(const lq_tau_nodes *t, size_t index, double tau, double *weight) {
    const double v = sqrt(tau);
    double sum = 0.0;
    for (size_t k = 0; k < t->count; k++) weight[k] = 0.0;
    for (size_t k = 0; k < t->count; k++) {
        const double gap = v - sqrt(t->tau[k]);
        if (t->direct ? k == index : fabs(gap) < 1e-14) {
            for (size_t l = 0; l < t->count; l++) weight[l] = l == k ? 1.0 : 0.0;
            return;
        }
        if (t->direct) continue;
        const double end = k == 0 || k + 1 == t->count ? 0.5 : 1.0;
        weight[k] = (k % 2 ? -end : end) / gap;
        sum += weight[k];
    }
    for (size_t k = 0; k < t->count; k++) weight[k] /= sum;
}

/* ------------------------------------------------------------------- directional: R01 and T01 */

/* The estimate of a smooth interface, whose energies are exact at alpha = 0 and off by what masking and the
 * critical angle move over cosines of a few alpha otherwise. */
static double smooth_estimate(double alpha) {
    return 1e-15 + 30.0 * alpha;
}

/* values[t * mu_count + m] */
static lq_status directional_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                                    lq_error *error) {
    const lq_directional *d = asked;
    if (lq_dielectric_is_closed(rough, eta)) {
        /* tau^(1/mu) straight through matched media is all but a step at grazing: no interpolation holds it.
         */
        const lq_question q = {0,           d->reward_side, d->scattering, d->mu,
                               d->mu_count, d->tau,         d->tau_count,  values};
        return lq_dielectric_answer(rough, eta, level, &q, 1, error);
    }
    const lq_tau_nodes nodes = lq_tau_nodes_choose(d->tau, d->tau_count, level);
    double *answer = malloc(nodes.count * d->mu_count * sizeof *answer);
    if (!answer) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", d->mu_count);
    const lq_question q = {0,           d->reward_side, d->scattering, d->mu,
                           d->mu_count, nodes.tau,      nodes.count,   answer};
    const lq_status status = lq_dielectric_answer(rough, eta, level, &q, 1, error);
    for (size_t t = 0; status == LQ_OK && t < d->tau_count; t++) {
        double weight[LQ_TAUS_MAX];
        lq_tau_weights(&nodes, t, d->tau[t], weight);
        for (size_t m = 0; m < d->mu_count; m++) {
            double sum = 0.0;
            for (size_t k = 0; k < nodes.count; k++) sum += weight[k] * answer[k * d->mu_count + m];
            values[t * d->mu_count + m] = fmin(fmax(sum, 0.0), 1.0);
        }
    }
    free(answer);
    return status;
}

/* Cosines watched besides those asked for, so that two levels do not agree by accident. */
enum { PROBES = 8 };

/* Solved as it is: wide[t * all + m], `all` cosines of which the first are those asked for. */
static lq_status watched_solve(lq_rough *rough, double eta, double tolerance, const lq_directional *d,
                               double *values, double *estimate, lq_error *error) {
    const double probes[PROBES] = {0.3 * rough->alpha, rough->alpha, 0.05, 0.2, 0.45, 0.7, 0.9, 1.0};
    const size_t all = d->mu_count < 2 * PROBES ? d->mu_count + PROBES : d->mu_count;
    double *mu = malloc(all * sizeof *mu), *wide = malloc(all * d->tau_count * sizeof *wide);
    lq_status status = LQ_NO_MEMORY;
    if (mu && wide) {
        lq_directional watched = *d;
        memcpy(mu, d->mu, d->mu_count * sizeof *mu);
        if (all > d->mu_count) memcpy(mu + d->mu_count, probes, sizeof probes);
        watched.mu = mu;
        watched.mu_count = all;
        status = lq_refine(rough, eta, tolerance, directional_values, &watched, all * d->tau_count, wide,
                           estimate, error);
        for (size_t t = 0; t < d->tau_count; t++)
            memcpy(values + t * d->mu_count, wide + t * all, d->mu_count * sizeof *values);
    } else {
        lq_fail(error, status, "no memory for %zu cosines", all);
    }
    free(mu);
    free(wide);
    return status;
}

/* -------------------------------------------------------------------------- many cosines */

/* From the rarer side energies are smooth functions of x = asinh(mu / alpha): the nearest singularities, of
 * masking at mu = i alpha and of Fresnel's reflectance at mu = i sqrt(eta^2 - 1), lie pi / 2 off the real
 * axis. */
static double position_of(const lq_rough *rough, double mu) {
    return asinh(mu / rough->alpha);
}

/* No nodes where there is no such interpolation, or where it does not pay. */
static lq_series plan(const lq_rough *rough, double eta, const lq_directional *d) {
    lq_series s = {.from = INFINITY, .to = -INFINITY};
    if (eta < lq_dielectric_regular_from(rough) || rough->alpha < LQ_SMOOTH_ALPHA) return s;
    for (size_t m = 0; m < d->mu_count; m++) {
        s.from = fmin(s.from, position_of(rough, d->mu[m]));
        s.to = fmax(s.to, position_of(rough, d->mu[m]));
    }
    const size_t nodes = (size_t)ceil(20.0 + 4.0 * (s.to - s.from));
    if (nodes <= LQ_SERIES_MAX && 3 * nodes <= d->mu_count) s.nodes = nodes;
    return s;
}

static void interpolate(const lq_series *s, const lq_rough *rough, const lq_directional *d,
                        const double *at_node, double *values) {
    double weight[LQ_SERIES_MAX];
    for (size_t m = 0; m < d->mu_count; m++) {
        lq_series_weights(s, position_of(rough, d->mu[m]), weight);
        for (size_t t = 0; t < d->tau_count; t++) {
            double sum = 0.0;
            for (size_t k = 0; k < s->nodes; k++) sum += weight[k] * at_node[t * s->nodes + k];
            values[t * d->mu_count + m] = fmin(fmax(sum, 0.0), 1.0);
        }
    }
}

/* Solved at few cosines and interpolated to the others where these are many and the series says that it
 * holds; otherwise at each. */
static lq_status many_solve(lq_rough *rough, double eta, double tolerance, const lq_directional *d,
                            double *values, double *estimate, lq_error *error) {
    const lq_series s = plan(rough, eta, d);
    if (s.nodes == 0) return watched_solve(rough, eta, tolerance, d, values, estimate, error);
    double mu[LQ_SERIES_MAX], *at_node = malloc(s.nodes * d->tau_count * sizeof *at_node);
    if (!at_node) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", s.nodes);
    for (size_t k = 0; k < s.nodes; k++)
        mu[k] = fmin(fmax(rough->alpha * sinh(lq_series_node(&s, k)), 0.0), 1.0);
    lq_directional few = *d;
    few.mu = mu;
    few.mu_count = s.nodes;
    lq_status status = watched_solve(rough, eta, tolerance * 2.0 / 3.0, &few, at_node, estimate, error);
    const double missing =
        status == LQ_OK ? lq_series_truncation(&s, at_node, 1, s.nodes, d->tau_count) : INFINITY;
    const bool holds = missing <= tolerance / 3.0;
    if (status == LQ_OK && holds) interpolate(&s, rough, d, at_node, values);
    if (status == LQ_OK && holds) *estimate += missing;
    free(at_node);
    return status == LQ_OK && !holds ? watched_solve(rough, eta, tolerance, d, values, estimate, error)
                                     : status;
}

/* ------------------------------------------------------------------------ nearly matched media */

/* What so many facets do without turning anything back: all is reflected below the critical cosine, and
 * nothing above it. tau^(1/mu_t) of the light that crosses. */
static double limit_value(const lq_directional *d, const lq_similar *near, double mu, double tau) {
    const double beyond =
        near->denser ? mu * mu - near->critical * near->critical : mu * mu + near->critical * near->critical;
    const bool reflects = beyond < 0.0, asked = d->reward_side == 0;
    if (reflects != asked) return 0.0;
    const double cosine = reflects ? mu : sqrt(beyond);
    return tau == 1.0 ? 1.0 : tau > 0.0 && cosine > 0.0 ? exp(log(tau) / cosine) : 0.0;
}

/* Near the step its width rules, which goes like sqrt(ln N / N): half a dozen facets in a row may turn light
 * the same way, and the few that it meets at grazing turn it most. Where the similar interface is as many
 * widths from its step: mu / mu_c. */
static double at_step(const lq_similar *near, double ratio) {
    const double narrower =
        sqrt(near->facets / log(near->facets) * log(LQ_SIMILAR_FACETS) / LQ_SIMILAR_FACETS);
    return fmax(1.0 + (ratio - 1.0) * narrower, 0.0);
}

static bool is_at_step(const lq_similar *near, double ratio) {
    return near->denser && fabs(ratio - 1.0) < 6.0 / sqrt(near->facets);
}

/* What the similar interface reflects at the same mu / mu_c, and as many widths from its step. */
typedef struct similar_pair {
    double same, widths;
} similar_pair;

/* One value from the limit and what the similar interface reflects beyond its own. At the step departures lie
 * between none and the larger of the two rules', give or take a fifth. Only energy is corrected: of
 * attenuated light all that the facets turn may be missing, or tau of it be there where the limit has none.
 */
static double similar_value(const lq_directional *d, const lq_similar *near, double mu, double tau,
                            similar_pair reflected, double *estimate) {
    const lq_directional energy = {.reward_side = 0};
    const double flat = limit_value(&energy, near, mu, 1.0), value = limit_value(d, near, mu, tau);
    const double widest = reflected.widths - flat;
    double excess = (reflected.same - flat) * LQ_SIMILAR_FACETS / near->facets, missing = 0.5 * fabs(excess);
    if (is_at_step(near, mu / near->critical)) {
        missing = 0.6 * fmax(fabs(excess), fabs(widest));
        excess = copysign(missing, widest);
    }
    const double added = d->reward_side == 0 ? excess : -excess, pays = value > 0.0 ? 1.0 : tau;
    *estimate = fmax(*estimate, tau == 1.0 ? missing : pays * (fabs(excess) + missing));
    return fmin(fmax(value + (tau == 1.0 ? added : 0.0), 0.0), 1.0);
}

static lq_status similar_solve(lq_rough *rough, const lq_similar *near, double tolerance,
                               const lq_directional *d, double *values, double *estimate, lq_error *error) {
    static const double energy = 1.0;
    const size_t count = d->mu_count;
    double *scaled = malloc(4 * count * sizeof *scaled);
    if (!scaled) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    double *reflected = scaled + 2 * count, missing = 0.0;
    const double share = LQ_SIMILAR_FACETS / near->facets, unit = near->critical / share;
    for (size_t m = 0; m < count; m++) {
        scaled[m] = fmin(d->mu[m] / share, 1.0);
        scaled[count + m] = fmin(at_step(near, d->mu[m] / near->critical) * unit, 1.0);
    }
    const lq_directional asked = {d->scattering, 0, scaled, 2 * count, &energy, 1};
    const lq_status status =
        watched_solve(rough, near->eta, fmin(tolerance / share, 1e-3), &asked, reflected, estimate, error);
    for (size_t i = 0; status == LQ_OK && i < count * d->tau_count; i++) {
        const size_t m = i % count;
        const similar_pair pair = {reflected[m], reflected[count + m]};
        values[i] = similar_value(d, near, d->mu[m], d->tau[i / count], pair, &missing);
    }
    *estimate = fmin(*estimate * share + missing, 1.0);
    free(scaled);
    return status;
}

lq_status lq_directional_solve(lq_rough *rough, double eta, double tolerance, const lq_directional *d,
                               double *values, double *estimate, lq_error *error) {
    const lq_similar near = lq_dielectric_similar(rough, eta);
    lq_status status = LQ_OK;
    *estimate = 1.0;
    if (near.eta > 0.0 && d->scattering == LQ_MULTIPLE)
        status = similar_solve(rough, &near, tolerance, d, values, estimate, error);
    const bool solvable =
        near.eta == 0.0 || d->scattering == LQ_SINGLE || !lq_dielectric_is_matched(rough, eta);
    if (status == LQ_OK && *estimate > tolerance && solvable)
        status = many_solve(rough, eta, tolerance, d, values, estimate, error);
    if (rough->alpha < LQ_SMOOTH_ALPHA) *estimate = smooth_estimate(rough->alpha);
    return status;
}

/* --------------------------------------------------------------------------------------- means */

/* Against solved means of alpha = 1 and N = 45 to 100 the smooth ones are off by 0.33 |eta - 1|: partial
 * reflection near grazing, which so many facets do not have. */
static double matched_mean_estimate(double eta) {
    return fabs(eta - 1.0);
}

lq_status lq_mean_solve(lq_rough *rough, double eta, double tolerance, lq_level_values *evaluate,
                        const void *asked, size_t count, double *values, double *estimate, lq_error *error) {
    if (!lq_dielectric_is_matched(rough, eta))
        return lq_refine(rough, eta, tolerance, evaluate, asked, count, values, estimate, error);
    lq_rough smooth = lq_rough_start(rough->ndf, 0.0);
    const lq_status status =
        lq_refine(&smooth, eta, tolerance, evaluate, asked, count, values, estimate, error);
    *estimate += matched_mean_estimate(eta);
    return status;
}
