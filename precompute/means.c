/* Cosine-weighted means of one interface, seen from the side where they converge: see two_sided.h. */
#include "microfacet/panels.h"
#include "precompute/two_sided.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>

void lq_mean_make(lq_mean_rule *mean, double alpha, double index, int level) {
    static const int nodes[LQ_DIELECTRIC_LEVELS] = {5, 7, 10, 14, 18, 22, 26};
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, nodes[level]);
    lq_panels_start(&panels, 0.0, 1.0);
    panels.singular[0] = true;
    if (index < 1.0) {
        const double critical = sqrt((1.0 - index) * (1.0 + index));
        lq_panels_add(&panels, critical, true);
        lq_panels_grade(&panels, critical, fmax(alpha * index, 1e-3), 5.0);
    }
    lq_panels_grade(&panels, 0.0, fmax(alpha, 1e-3), 5.0);
    mean->count = 0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule.count && mean->count < LQ_MEAN_MAX; i++, mean->count++) {
            double slope;
            const double mu = lq_panels_map(&panels, p, rule.node[i], &slope);
            mean->mu[mean->count] = mu;
            mean->weight[mean->count] = 2.0 * mu * rule.weight[i] * slope;
        }
}

/* Energies seen from one side at the cosines of a mean, for the tau nodes and for tau = 1. */
typedef struct view {
    lq_mean_rule mean;
    lq_tau_nodes nodes;
    size_t one, asked; /* which is tau = 1; nodes in all */
    double *answer;    /* [k * mean.count + q] */
} view;

static view *view_make(double alpha, double index, int level, const double *tau, size_t tau_count) {
    view *v = malloc(sizeof *v);
    if (!v) return NULL;
    lq_mean_make(&v->mean, alpha, index, level);
    v->nodes = lq_tau_nodes_choose(tau, tau_count, level);
    v->one = v->nodes.count - 1;
    if (v->nodes.tau[v->one] != 1.0) v->nodes.tau[++v->one] = 1.0;
    v->asked = v->one + 1;
    v->answer = malloc(v->asked * v->mean.count * sizeof *v->answer);
    if (v->answer) return v;
    free(v);
    return NULL;
}

static void view_free(view *v) {
    if (v) free(v->answer);
    free(v);
}

static lq_question ask_view(const view *v, int side) {
    return (lq_question){side, 1, LQ_MULTIPLE, v->mean.mu, v->mean.count, v->nodes.tau, v->asked, v->answer};
}

static double mean_at_node(const view *v, size_t k) {
    double sum = 0.0;
    for (size_t q = 0; q < v->mean.count; q++) sum += v->mean.weight[q] * v->answer[k * v->mean.count + q];
    return sum;
}

/* Mean over incidence. */
static double mean_of(const view *v, size_t t, double tau) {
    double weight[LQ_TAUS_MAX], sum = 0.0;
    lq_tau_weights(&v->nodes, t, tau, weight);
    for (size_t k = 0; k < v->nodes.count; k++)
        sum += weight[k] == 0.0 ? 0.0 : weight[k] * mean_at_node(v, k);
    return sum;
}

/* Mean over light that was attenuated by tau^(1/mu) on its way to the surface. */
static double mean_after_crossing(const view *v, double tau, const double *weight, size_t nodes,
                                  const double *answer) {
    double sum = 0.0;
    const double depth = tau > 0.0 ? log(tau) : -INFINITY;
    for (size_t q = 0; q < v->mean.count; q++) {
        double energy = 0.0;
        for (size_t k = 0; k < nodes; k++) energy += weight[k] * answer[k * v->mean.count + q];
        sum += v->mean.weight[q] * (tau < 1.0 ? exp(depth / v->mean.mu[q]) : 1.0) * energy;
    }
    return sum;
}

static double reflected_mean(const view *v, size_t t, double tau) {
    double weight[LQ_TAUS_MAX];
    lq_tau_weights(&v->nodes, t, tau, weight);
    return mean_after_crossing(v, tau, weight, v->nodes.count, v->answer);
}

static double clamped(double energy) {
    return fmin(fmax(energy, 0.0), 1.0);
}

/* A denser coating: T10mean(tau) = T01mean(tau) / eta^2 from outside, where no critical angle is. R10mean has
 * two crossings and must be seen from inside; its scale comes from R10mean = 1 - T01mean / eta^2 at tau = 1,
 * so that light is conserved over both. */
static lq_status denser_coating(lq_rough *rough, double eta, int level, const lq_diffuse *d, double *values,
                                lq_error *error) {
    static const double one = 1.0;
    view *out = view_make(rough->alpha, eta, level, d->transmitted ? d->tau : &one,
                          d->transmitted ? d->tau_count : 1);
    view *in = d->reflected ? view_make(rough->alpha, 1.0 / eta, level, d->tau, d->tau_count) : NULL;
    lq_status status = out && (in || !d->reflected)
                           ? LQ_OK
                           : lq_fail(error, LQ_NO_MEMORY, "no memory for %d cosines", LQ_MEAN_MAX);
    if (status == LQ_OK) {
        lq_question q[2] = {ask_view(out, 0)};
        if (in) q[1] = ask_view(in, 1);
        status = lq_dielectric_answer(rough, eta, level, q, in ? 2 : 1, error);
    }
    if (status == LQ_OK) {
        for (size_t t = 0; d->transmitted && t < d->tau_count; t++)
            *values++ = clamped(mean_of(out, t, d->tau[t]) / (eta * eta));
        const double back = in ? mean_at_node(in, in->one) : 0.0;
        const double scale = back > 0.0 ? (1.0 - mean_at_node(out, out->one) / (eta * eta)) / back : 1.0;
        for (size_t t = 0; in && t < d->tau_count; t++)
            *values++ = clamped(scale * reflected_mean(in, t, d->tau[t]));
    }
    view_free(out);
    view_free(in);
    return status;
}

/* A rarer coating: both from inside, T10(mu) = 1 - R10(mu). */
static lq_status rarer_coating(lq_rough *rough, double eta, int level, const lq_diffuse *d, double *values,
                               lq_error *error) {
    static const double one = 1.0, all[1] = {1.0};
    view *in = view_make(rough->alpha, 1.0 / eta, level, d->reflected ? d->tau : &one,
                         d->reflected ? d->tau_count : 1);
    lq_status status = in ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %d cosines", LQ_MEAN_MAX);
    if (status == LQ_OK) {
        const lq_question q = ask_view(in, 1);
        status = lq_dielectric_answer(rough, eta, level, &q, 1, error);
    }
    if (status == LQ_OK) {
        const size_t cosines = in->mean.count;
        double through[LQ_MEAN_MAX];
        for (size_t q = 0; q < cosines; q++) through[q] = 1.0 - in->answer[in->one * cosines + q];
        for (size_t t = 0; d->transmitted && t < d->tau_count; t++)
            *values++ = clamped(mean_after_crossing(in, d->tau[t], all, 1, through));
        for (size_t t = 0; d->reflected && t < d->tau_count; t++)
            *values++ = clamped(reflected_mean(in, t, d->tau[t]));
    }
    view_free(in);
    return status;
}

lq_status lq_diffuse_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                            lq_error *error) {
    return eta >= 1.0 ? denser_coating(rough, eta, level, asked, values, error)
                      : rarer_coating(rough, eta, level, asked, values, error);
}
