/* Tables of rough dielectrics: `fgd-dielectric`, `transmission`, `diffuse-transmission`,
 * `diffuse-reflection`, `variance` and `coated-lambertian` (D22 sec. 3-4), all answers of the two-sided
 * solver.
 *
 * Diffuse quantities are cosine-weighted means over incidence. What leaves the coating comes from the outside
 * view by reciprocity, mu0 t01(mu0 -> mu) = mu t10(mu -> mu0) / eta^2 in flux, which has no critical angle in
 * it: T10mean(tau) = T01mean(tau) / eta^2,   sigma^2 = mean of (1 - mu^2) T01 / mean of T01.
 */
#include "microfacet/lobe.h"
#include "microfacet/panels.h"
#include "precompute/dielectric.h"
#include "precompute/first_bounce.h"
#include "precompute/kinds.h"
#include "tables/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------- refinement */

/* Values of one interface at one level of resolution. */
typedef lq_status level_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                               lq_error *error);

/* Raise the level until two in a row agree: the estimate is twice their largest difference over `count`
 * values, and never below a tenth of the tolerance. `values` gets the finer ones. A level that does not
 * settle is left out. */
static lq_status refine(lq_rough *rough, double eta, double tolerance, level_values *evaluate,
                        const void *asked, size_t count, double *values, double *estimate, lq_error *error) {
    double *now = malloc(count * sizeof *now);
    if (!now) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", count);
    lq_status status = LQ_OK;
    *estimate = 1.0;
    for (int level = 0; status == LQ_OK && level<LQ_DIELECTRIC_LEVELS && * estimate> tolerance; level++) {
        status = evaluate(rough, eta, level, asked, now, error);
        if (status != LQ_OK) break;
        double change = 0.0;
        for (size_t i = 0; level > 0 && i < count; i++) change = fmax(change, fabs(now[i] - values[i]));
        if (level > 0) *estimate = fmax(2.0 * change, 0.1 * tolerance);
        memcpy(values, now, count * sizeof *now);
    }
    free(now);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* The estimate of a smooth interface, whose energies are exact at alpha = 0 and off by what masking and the
 * critical angle move over cosines of a few alpha otherwise. */
static double smooth_estimate(double alpha) {
    return 1e-15 + 30.0 * alpha;
}

/* --------------------------------------------------------------------------- transmittances */

/* Energies are asked for at every tau of a table, or, where these are many, at Chebyshev points of sqrt(tau),
 * both ends included, and interpolated: they are Laplace transforms in -ln tau, smooth in between. */
enum { TAUS_MAX = 32 };

typedef struct tau_nodes {
    size_t count;
    bool direct; /* they are the table's own */
    double tau[TAUS_MAX];
} tau_nodes;

static tau_nodes choose_taus(const double *tau, size_t count, int level) {
    static const size_t nodes[LQ_DIELECTRIC_LEVELS] = {16, 24, 24, 32, 32, 32};
    tau_nodes t = {.count = count, .direct = count <= nodes[level]};
    if (!t.direct) t.count = nodes[level];
    for (size_t k = 0; k < t.count; k++) {
        const double v = 0.5 - 0.5 * cos(3.14159265358979323846 * (double)k / (double)(t.count - 1));
        t.tau[k] = t.direct ? tau[k] : v * v;
    }
    return t;
}

/* Barycentric weights of the interpolation to one tau: sum_k weight[k] value_k. */
static void tau_weights(const tau_nodes *t, size_t index, double tau, double *weight) {
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

/* Cosines and transmittances of a table, and what is asked of each. */
typedef struct directional {
    lq_scattering scattering;
    int reward_side;
    const double *mu;
    size_t mu_count;
    const double *tau;
    size_t tau_count;
} directional;

/* values[t * mu_count + m] */
static lq_status directional_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                                    lq_error *error) {
    const directional *d = asked;
    if (lq_dielectric_is_closed(rough, eta)) {
        /* tau^(1/mu) straight through matched media is all but a step at grazing: no interpolation holds it.
         */
        const lq_question q = {0,           d->reward_side, d->scattering, d->mu,
                               d->mu_count, d->tau,         d->tau_count,  values};
        return lq_dielectric_answer(rough, eta, level, &q, 1, error);
    }
    const tau_nodes nodes = choose_taus(d->tau, d->tau_count, level);
    double *answer = malloc(nodes.count * d->mu_count * sizeof *answer);
    if (!answer) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", d->mu_count);
    const lq_question q = {0,           d->reward_side, d->scattering, d->mu,
                           d->mu_count, nodes.tau,      nodes.count,   answer};
    const lq_status status = lq_dielectric_answer(rough, eta, level, &q, 1, error);
    for (size_t t = 0; status == LQ_OK && t < d->tau_count; t++) {
        double weight[TAUS_MAX];
        tau_weights(&nodes, t, d->tau[t], weight);
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

/* One interface: values[t * mu_count + m] and their estimate. */
static lq_status solve_directional(lq_rough *rough, double eta, double tolerance, const directional *d,
                                   double *values, double *estimate, lq_error *error) {
    const double probes[PROBES] = {0.3 * rough->alpha, rough->alpha, 0.05, 0.2, 0.45, 0.7, 0.9, 1.0};
    const size_t all = d->mu_count < 2 * PROBES ? d->mu_count + PROBES : d->mu_count;
    double *mu = malloc(all * sizeof *mu), *wide = malloc(all * d->tau_count * sizeof *wide);
    lq_status status = LQ_NO_MEMORY;
    if (mu && wide) {
        directional watched = *d;
        memcpy(mu, d->mu, d->mu_count * sizeof *mu);
        if (all > d->mu_count) memcpy(mu + d->mu_count, probes, sizeof probes);
        watched.mu = mu;
        watched.mu_count = all;
        status = refine(rough, eta, tolerance, directional_values, &watched, all * d->tau_count, wide,
                        estimate, error);
        for (size_t t = 0; t < d->tau_count; t++)
            memcpy(values + t * d->mu_count, wide + t * all, d->mu_count * sizeof *values);
        if (rough->alpha < LQ_SMOOTH_ALPHA) *estimate = smooth_estimate(rough->alpha);
    } else {
        lq_fail(error, status, "no memory for %zu cosines", all);
    }
    free(mu);
    free(wide);
    return status;
}

static const double no_loss = 1.0;

/* fgd-dielectric: mu, alpha, eta. transmission: mu, alpha, eta, tau. */
static lq_status directional_slice(const lq_job *job, size_t index, int reward_side, const double *tau,
                                   size_t tau_count, double *values, double *estimate, lq_error *error) {
    enum { MU, ALPHA, ETA };
    const size_t mus = job->size[MU], etas = job->size[ETA];
    const directional d = {job->scattering, reward_side, job->nodes[MU], mus, tau, tau_count};
    lq_rough rough = lq_rough_start(job->ndf, job->nodes[ALPHA][index]);
    double *one = malloc(mus * tau_count * sizeof *one);
    lq_status status = one ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mus);
    *estimate = 0.0;
    for (size_t e = 0; status == LQ_OK && e < etas; e++) {
        double largest = 0.0;
        status = solve_directional(&rough, job->nodes[ETA][e], job->tolerance, &d, one, &largest, error);
        for (size_t t = 0; status == LQ_OK && t < tau_count; t++)
            memcpy(values + (t * etas + e) * mus, one + t * mus, mus * sizeof *values);
        *estimate = fmax(*estimate, largest);
    }
    free(one);
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

const lq_evaluator lq_evaluate_fgd_dielectric = {"fgd-dielectric", 1, NULL, fgd_slice, NULL};
const lq_evaluator lq_evaluate_transmission = {"transmission", 1, NULL, transmission_slice, NULL};

/* ---------------------------------------------------------------------- cosine-weighted means */

enum { MEAN_MAX = 512 };

/* A quadrature of 2 mu dmu on [0,1]: energies turn over cosines of alpha at grazing, and at the critical
 * cosine of light that comes from the denser side. */
typedef struct mean_rule {
    size_t count;
    double mu[MEAN_MAX], weight[MEAN_MAX];
} mean_rule;

static void mean_make(mean_rule *mean, double alpha, double index, int level) {
    static const int nodes[LQ_DIELECTRIC_LEVELS] = {5, 7, 10, 14, 18, 22};
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
        for (int i = 0; i < rule.count && mean->count < MEAN_MAX; i++, mean->count++) {
            double slope;
            const double mu = lq_panels_map(&panels, p, rule.node[i], &slope);
            mean->mu[mean->count] = mu;
            mean->weight[mean->count] = 2.0 * mu * rule.weight[i] * slope;
        }
}

/* What the means of one interface are asked for. */
typedef struct diffuse {
    const double *tau;
    size_t tau_count;
} diffuse;

/* Answer of one side at the mean's cosines and the tau nodes: answer[k * count + q]. */
static lq_status ask_mean(lq_rough *rough, double eta, int level, int side, const mean_rule *mean,
                          const tau_nodes *nodes, double *answer, lq_error *error) {
    const lq_question q = {side, 1, LQ_MULTIPLE, mean->mu, mean->count, nodes->tau, nodes->count, answer};
    return lq_dielectric_answer(rough, eta, level, &q, 1, error);
}

/* T10mean(tau) = T01mean(tau) / eta^2. */
static lq_status diffuse_transmission_values(lq_rough *rough, double eta, int level, const void *asked,
                                             double *values, lq_error *error) {
    const diffuse *d = asked;
    mean_rule mean;
    mean_make(&mean, rough->alpha, eta, level);
    const tau_nodes nodes = choose_taus(d->tau, d->tau_count, level);
    double *answer = malloc(nodes.count * mean.count * sizeof *answer), at_node[TAUS_MAX] = {0.0};
    if (!answer) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mean.count);
    const lq_status status = ask_mean(rough, eta, level, 0, &mean, &nodes, answer, error);
    for (size_t k = 0; status == LQ_OK && k < nodes.count; k++)
        for (size_t q = 0; q < mean.count; q++) at_node[k] += mean.weight[q] * answer[k * mean.count + q];
    for (size_t t = 0; status == LQ_OK && t < d->tau_count; t++) {
        double weight[TAUS_MAX], sum = 0.0;
        tau_weights(&nodes, t, d->tau[t], weight);
        for (size_t k = 0; k < nodes.count; k++) sum += weight[k] * at_node[k];
        values[t] = fmin(fmax(sum / (eta * eta), 0.0), 1.0);
    }
    free(answer);
    return status;
}

/* R10mean(tau) = mean of tau^(1/mu) R10(mu; tau): up from the base, and down again. At tau = 1 the outside
 * view is better: R10mean = 1 - T01mean / eta^2. */
static lq_status diffuse_reflection_values(lq_rough *rough, double eta, int level, const void *asked,
                                           double *values, lq_error *error) {
    const diffuse *d = asked;
    mean_rule mean;
    mean_make(&mean, rough->alpha, 1.0 / eta, level);
    const tau_nodes nodes = choose_taus(d->tau, d->tau_count, level);
    double *answer = malloc(nodes.count * mean.count * sizeof *answer);
    if (!answer) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mean.count);
    lq_status status = ask_mean(rough, eta, level, 1, &mean, &nodes, answer, error);
    for (size_t t = 0; status == LQ_OK && t < d->tau_count; t++) {
        double weight[TAUS_MAX], sum = 0.0;
        const double depth = d->tau[t] > 0.0 ? log(d->tau[t]) : -INFINITY;
        tau_weights(&nodes, t, d->tau[t], weight);
        for (size_t q = 0; q < mean.count; q++) {
            double back = 0.0;
            for (size_t k = 0; k < nodes.count; k++) back += weight[k] * answer[k * mean.count + q];
            sum += mean.weight[q] * (d->tau[t] < 1.0 ? exp(depth / mean.mu[q]) : 1.0) * back;
        }
        values[t] = fmin(fmax(sum, 0.0), 1.0);
    }
    free(answer);
    return status;
}

static lq_status variance_values(lq_rough *rough, double eta, int level, const void *asked, double *values,
                                 lq_error *error) {
    (void)asked;
    mean_rule mean;
    double answer[MEAN_MAX], flux = 0.0, moment = 0.0;
    const tau_nodes nodes = {.count = 1, .direct = true, .tau = {1.0}};
    mean_make(&mean, rough->alpha, eta, level);
    const lq_status status = ask_mean(rough, eta, level, 0, &mean, &nodes, answer, error);
    for (size_t q = 0; status == LQ_OK && q < mean.count; q++) {
        flux += mean.weight[q] * answer[q];
        moment += mean.weight[q] * answer[q] * (1.0 - mean.mu[q]) * (1.0 + mean.mu[q]);
    }
    values[0] = flux > 0.0 ? moment / flux : 0.0;
    return status;
}

/* Kinds over eta, alpha(, tau): the slice is the roughness, the second axis. */
static lq_status diffuse_slice(const lq_job *job, size_t index, level_values *evaluate, size_t taus,
                               double *values, double *estimate, lq_error *error) {
    enum { ETA, ALPHA, TAU };
    const diffuse d = {taus > 1 || job->kind->axis_count > TAU ? job->nodes[TAU] : &no_loss, taus};
    lq_rough rough = lq_rough_start(job->ndf, job->nodes[ALPHA][index]);
    double *one = malloc(taus * sizeof *one);
    lq_status status = one ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu transmittances", taus);
    *estimate = 0.0;
    for (size_t e = 0; status == LQ_OK && e < job->size[ETA]; e++) {
        double largest = 0.0;
        status = refine(&rough, job->nodes[ETA][e], job->tolerance, evaluate, &d, taus, one, &largest, error);
        for (size_t t = 0; status == LQ_OK && t < taus; t++) values[t * job->size[ETA] + e] = one[t];
        *estimate = fmax(*estimate, largest);
    }
    free(one);
    lq_rough_free(&rough);
    return status;
}

static lq_status diffuse_transmission_slice(const lq_job *job, const void *state, size_t index,
                                            double *const *values, double *estimate, lq_error *error) {
    (void)state;
    return diffuse_slice(job, index, diffuse_transmission_values, job->size[2], values[0], estimate, error);
}

static lq_status diffuse_reflection_slice(const lq_job *job, const void *state, size_t index,
                                          double *const *values, double *estimate, lq_error *error) {
    (void)state;
    return diffuse_slice(job, index, diffuse_reflection_values, job->size[2], values[0], estimate, error);
}

static lq_status variance_slice(const lq_job *job, const void *state, size_t index, double *const *values,
                                double *estimate, lq_error *error) {
    (void)state;
    const lq_status status = diffuse_slice(job, index, variance_values, 1, values[0], estimate, error);
    for (size_t e = 0; status == LQ_OK && e < job->size[0]; e++)
        values[1][e] = lq_lobe_roughness(job->ndf, values[0][e]);
    /* The roughness moves dalpha/dv1 times as much, no more than 2.5 where these variances lie. */
    *estimate *= 2.5;
    return status;
}

const lq_evaluator lq_evaluate_diffuse_transmission = {"diffuse-transmission", 1, NULL,
                                                       diffuse_transmission_slice, NULL};
const lq_evaluator lq_evaluate_diffuse_reflection = {"diffuse-reflection", 1, NULL, diffuse_reflection_slice,
                                                     NULL};
const lq_evaluator lq_evaluate_variance = {"variance", 1, NULL, variance_slice, NULL};

/* ------------------------------------------------------------------------------ coated Lambertian */

/* Albedo of one coated base at every cosine and base albedo (D22 eq. 3): R01 + T01 rho/(1 - rho R10mean)
 * T10mean. */
typedef struct pieces {
    double *r01, *t01; /* [mu], [tau * mus + mu] */
    double *t10, *r10; /* [tau] */
    double error;
} pieces;

static lq_status solve_pieces(const lq_job *job, lq_rough *rough, double eta, pieces *p, lq_error *error) {
    enum { MU, ALPHA, ETA, TAU };
    const double tolerance = 0.1 * job->tolerance;
    const diffuse d = {job->nodes[TAU], job->size[TAU]};
    directional out = {LQ_MULTIPLE, 0, job->nodes[MU], job->size[MU], &no_loss, 1};
    double estimate[4] = {0.0};
    lq_status status = solve_directional(rough, eta, tolerance, &out, p->r01, &estimate[0], error);
    out.reward_side = 1;
    out.tau = d.tau;
    out.tau_count = d.tau_count;
    if (status == LQ_OK) status = solve_directional(rough, eta, tolerance, &out, p->t01, &estimate[1], error);
    if (status == LQ_OK)
        status = refine(rough, eta, tolerance, diffuse_transmission_values, &d, d.tau_count, p->t10,
                        &estimate[2], error);
    if (status == LQ_OK)
        status = refine(rough, eta, tolerance, diffuse_reflection_values, &d, d.tau_count, p->r10,
                        &estimate[3], error);
    p->error = 0.0;
    for (int i = 0; status == LQ_OK && i < 4; i++) p->error = fmax(p->error, estimate[i]);
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
    double *block = malloc((mus + mus * taus + 2 * taus) * sizeof *block);
    lq_status status = block ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mus);
    pieces p = {block, block + mus, block + mus + mus * taus, block + mus + mus * taus + taus, 0.0};
    *estimate = 0.0;
    for (size_t e = 0; status == LQ_OK && e < job->size[ETA]; e++) {
        status = solve_pieces(job, &rough, job->nodes[ETA][e], &p, error);
        if (status == LQ_OK) *estimate = fmax(*estimate, combine_pieces(job, &p, e, values[0]));
    }
    free(block);
    lq_rough_free(&rough);
    return status;
}

const lq_evaluator lq_evaluate_coated_lambertian = {"coated-lambertian", 1, NULL, coated_slice, NULL};
