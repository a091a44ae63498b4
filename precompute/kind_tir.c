/* `tir-pass`, `tir-loss`: what the lobe of the base loses at the coating's upper side (B18 sec. 5.1).
 *
 * tir-pass   mean of 1 - F(cos theta, eta) over the lobe: partial Fresnel reflection included
 * tir-loss   fraction of the lobe beyond the critical angle: sin theta > eta
 *
 * One lobe (lobe.h) serves every eta. The loss is read off its integral. The pass is an integral over the
 * angles below the critical one, where 1 - F starts like a square root: there the cosine of refraction is the
 * variable.
 */
#include "microfacet/fresnel.h"
#include "precompute/angle_lobe.h"
#include "precompute/curves.h"
#include "precompute/first_bounce.h"
#include "precompute/kinds.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MU, ALPHA, ETA };

static const double half_pi = 1.57079632679489661923;

/* What one eta needs, made once: the largest angle that passes, and the break points of its Fresnel curve. */
typedef struct outside {
    double eta, end;
    lq_panels panels;
} outside;

/* Terms of the lobe's series and nodes of its rings; the pass takes as many nodes a panel as there are terms.
 * All grow from row to row by a third or more, or the error of one would not show in the difference: rings of
 * 8 and 10 nodes were off alike, by 1e-5, where Student-t's lobe lies along the horizon. */
static const int resolutions[][2] = {{8, 8}, {12, 12}, {16, 16}, {24, 24}, {32, 32}, {48, 48}};
enum { RESOLUTIONS = sizeof resolutions / sizeof resolutions[0] };

typedef struct resolution {
    lq_angle_lobe_rule lobe;
    lq_gauss pass;
} resolution;

typedef struct tir_state {
    resolution at[RESOLUTIONS];
    outside etas[]; /* of every node of the axis */
} tir_state;

static double critical_angle(double eta) {
    return eta < 1.0 ? atan2(eta, sqrt((1.0 - eta) * (1.0 + eta))) : half_pi;
}

static bool counts_fresnel(const lq_job *job) {
    return strcmp(job->kind->id, "tir-pass") == 0;
}

static lq_status prepare(const lq_job *job, void **state, lq_error *error) {
    const size_t count = job->size[ETA];
    tir_state *s = malloc(sizeof *s + count * sizeof s->etas[0]);
    if (!s) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu indices", count);
    for (int i = 0; i < RESOLUTIONS; i++) {
        lq_angle_lobe_rule_make(&s->at[i].lobe, resolutions[i][0], resolutions[i][1]);
        lq_gauss_make(&s->at[i].pass, resolutions[i][0]);
    }
    lq_curves curves;
    for (size_t e = 0; e < count; e++) {
        const double eta = job->nodes[ETA][e];
        s->etas[e].eta = eta;
        s->etas[e].end = critical_angle(eta);
        if (!counts_fresnel(job) || eta == 0.0) continue;
        lq_curves_conductor(&curves, eta, 0.0);
        s->etas[e].panels = curves.panels;
    }
    *state = s;
    return LQ_OK;
}

/* ---------------------------------------------------------------------------- the integrals */

static double clamp(double x) {
    return fmin(fmax(x, 0.0), 1.0);
}

static double loss(const lq_angle_lobe *lobe, double end) {
    return clamp(1.0 - lq_angle_lobe_below(lobe, end) / lq_angle_lobe_total(lobe));
}

/* Break points of the lobe and of the Fresnel curve up to the critical angle. A break of the lobe just below
 * that angle is left out: it would cut off the panel of the square root. */
static void pass_panels(const lq_angle_lobe *lobe, const outside *o, lq_panels *panels) {
    lq_panels_start(panels, 0.0, o->end);
    panels->singular[1] = o->eta < 1.0;
    lq_panels_add(panels, 0.5 * o->end, false);
    for (int i = 1; i < lobe->panels; i++) {
        const double room = 0.03 * (lobe->at[i] - lobe->at[i - 1]);
        if (o->eta >= 1.0 || lobe->at[i] < o->end - room) lq_panels_add(panels, lobe->at[i], false);
    }
    for (int i = 0; i < o->panels.count; i++)
        if (!o->panels.singular[i]) lq_panels_add(panels, o->panels.at[i], false);
    if (o->eta < 1.0) lq_panels_separate(panels);
}

/* 1 - F, the same from both sides; `cosine` on the side of the lower index, so that neither the critical
 * angle nor the horizon cancels. */
static double passed(double cosine, double eta) {
    return 1.0 - lq_fresnel_dielectric(cosine, eta < 1.0 ? 1.0 / eta : eta, NULL);
}

/* From angle `from` to the critical one in t: sin theta = eta sqrt(1 - t^2). There 1 - F is analytic but for
 * poles near t = -eta (r_p) and |t| = sqrt(1 - eta^2) (the horizon). */
static double pass_near_critical(const lq_angle_lobe *lobe, const outside *o, double from,
                                 const lq_gauss *rule) {
    const double eta = o->eta, gap = (1.0 - eta) * (1.0 + eta), s_from = sin(from);
    const double t_max = sqrt(fmax((eta - s_from) * (eta + s_from), 0.0)) / eta;
    const int first = lq_angle_lobe_panel(lobe, from, 0);
    lq_panels panels;
    lq_panels_start(&panels, 0.0, t_max);
    for (double t = fmin(eta, sqrt(gap)); t < t_max; t *= 4.0) lq_panels_add(&panels, t, false);
    double sum = 0.0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int q = 0; q < rule->count; q++) {
            double slope;
            const double t = lq_panels_map(&panels, p, rule->node[q], &slope);
            const double s = eta * sqrt((1.0 - t) * (1.0 + t)), c = sqrt(gap + eta * eta * t * t);
            const double theta = atan2(s, c);
            const int at = lq_angle_lobe_panel(lobe, theta, first);
            sum += rule->weight[q] * slope * eta * eta * t / (s * c) * passed(t, eta) *
                   lq_angle_lobe_density(lobe, at, theta);
        }
    return sum;
}

static double pass_panel(const lq_angle_lobe *lobe, const outside *o, const lq_panels *panels, int p,
                         const lq_gauss *rule, int *at) {
    double sum = 0.0;
    for (int q = 0; q < rule->count; q++) {
        double slope;
        const double theta = lq_panels_map(panels, p, rule->node[q], &slope), s = sin(theta);
        const double t = sqrt(fmax((o->eta - s) * (o->eta + s), 0.0)) / o->eta;
        const double through = passed(o->eta < 1.0 ? t : cos(theta), o->eta);
        *at = lq_angle_lobe_panel(lobe, theta, *at);
        sum += rule->weight[q] * slope * through * lq_angle_lobe_density(lobe, *at, theta);
    }
    return sum;
}

static double pass(const lq_angle_lobe *lobe, const outside *o, const lq_gauss *rule) {
    if (o->eta == 0.0) return 0.0;
    if (o->eta == 1.0) return 1.0;
    lq_panels panels;
    pass_panels(lobe, o, &panels);
    const int last = panels.count - 2;
    double sum = 0.0;
    for (int p = 0, at = 0; p <= last; p++)
        sum += o->eta < 1.0 && p == last ? pass_near_critical(lobe, o, panels.at[p], rule)
                                         : pass_panel(lobe, o, &panels, p, rule, &at);
    return clamp(sum / lq_angle_lobe_total(lobe));
}

/* ---------------------------------------------------------------------------------- slices */

/* Without roughness the lobe is one direction. What a roughness of no more than LQ_SMOOTH_ALPHA could still
 * change is its distance to the nearest kink of the result, the critical angle or the horizon, in lobe
 * widths. */
static void smooth(const lq_job *job, const tir_state *s, double alpha, double mu, double *values,
                   size_t stride, double *estimate) {
    const double theta = atan2(lq_sine(mu), mu);
    for (size_t e = 0; e < job->size[ETA]; e++) {
        const outside *o = &s->etas[e];
        const double gap = fmin(fabs(theta - o->end), half_pi - theta);
        if (counts_fresnel(job)) {
            values[e * stride] = o->eta == 0.0 ? 0.0 : 1.0 - lq_fresnel_dielectric(mu, o->eta, NULL);
        } else {
            values[e * stride] = o->eta == 0.0 || lq_sine(mu) > o->eta ? 1.0 : 0.0;
        }
        if (alpha > 0.0 && o->eta != 1.0 && o->eta != 0.0)
            *estimate = fmax(*estimate, gap > 8.0 * alpha ? 8.0 * alpha / gap : 1.0);
    }
}

static double value_at(const lq_job *job, const tir_state *s, int level, const lq_angle_lobe *lobe,
                       size_t e) {
    if (counts_fresnel(job)) return pass(lobe, &s->etas[e], &s->at[level].pass);
    return s->etas[e].eta == 0.0 ? 1.0 : loss(lobe, s->etas[e].end);
}

/* What each panel of the lobe holds of the whole, and how much that has changed since the level before: where
 * few eta are asked for, their own values can agree by chance (first_bounce.c says more). The panels are
 * those of every level. */
static double change_of_lobe(const lq_angle_lobe *lobe, double *shares) {
    double change = 0.0;
    for (int p = 0; p < lobe->panels; p++) {
        const double share = (lobe->below[p + 1] - lobe->below[p]) / lq_angle_lobe_total(lobe);
        change += fabs(share - shares[p]);
        shares[p] = share;
    }
    return change;
}

/* Every eta of one lobe, refined until the error estimate, which is returned, is at most the tolerance. */
static double converge(const lq_job *job, const tir_state *s, double alpha, double mu, lq_angle_lobe *lobe,
                       double *values, size_t stride) {
    double estimate = INFINITY, older = 0.0, shares[LQ_ANGLE_LOBE_PANELS] = {0.0};
    for (int level = 0; level < RESOLUTIONS && estimate > job->tolerance; level++) {
        lq_angle_lobe_make(lobe, job->ndf, alpha, mu, &s->at[level].lobe);
        double change = change_of_lobe(lobe, shares);
        for (size_t e = 0; e < job->size[ETA]; e++) {
            const double now = value_at(job, s, level, lobe, e);
            if (level > 0) change = fmax(change, fabs(now - values[e * stride]));
            values[e * stride] = now;
        }
        if (level == 0) continue;
        estimate = fmax(lq_first_bounce_estimate(change, older), 0.1 * job->tolerance);
        older = change;
    }
    return estimate;
}

static lq_status slice(const lq_job *job, const void *state, size_t index, double *const *values,
                       double *estimate, lq_error *error) {
    const tir_state *s = state;
    const double alpha = job->nodes[ALPHA][index];
    const size_t count = job->size[MU];
    lq_angle_lobe *lobe = malloc(sizeof *lobe);
    if (!lobe) return lq_fail(error, LQ_NO_MEMORY, "no memory for a lobe");
    *estimate = 1e-15;
    for (size_t m = 0; m < count; m++) {
        const double mu = job->nodes[MU][m];
        if (alpha < LQ_SMOOTH_ALPHA) smooth(job, s, alpha, mu, values[0] + m, count, estimate);
        else *estimate = fmax(*estimate, converge(job, s, alpha, mu, lobe, values[0] + m, count));
    }
    free(lobe);
    return LQ_OK;
}

static void release(void *state) {
    free(state);
}

const lq_evaluator lq_evaluate_tir_pass = {"tir-pass", ALPHA, 1.0, prepare, slice, release};
const lq_evaluator lq_evaluate_tir_loss = {"tir-loss", ALPHA, 1.0, prepare, slice, release};
