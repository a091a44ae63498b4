/* Smooth interfaces: Fresnel's formulas, Snell's law, and cosine-weighted means of them. */
#include "validate/smooth_limit.h"

#include "microfacet/fresnel.h"
#include "microfacet/gauss.h"
#include "validate/walk_kind.h"

#include <math.h>
#include <string.h>

typedef struct smooth {
    double mu, n, kappa, eta, tau, rho;
} smooth;

/* tau^(1/mu); what is not absorbed passes even along the horizon. */
static double crossing(double tau, double mu) {
    return tau == 1.0 ? 1.0 : pow(tau, 1.0 / mu);
}

static double through(double mu, double eta, double tau) {
    double cos_t;
    const double f = lq_fresnel_dielectric(mu, eta, &cos_t);
    return f < 1.0 ? (1.0 - f) * crossing(tau, cos_t) : 0.0;
}

typedef double integrand(const smooth *s, double mu);

/* integral of 2 mu f over [0,1], split at `kink`; mu = a + (b-a)(3w^2 - 2w^3) calms the square roots there.
 */
static double mean(const smooth *s, integrand *f, double kink) {
    lq_gauss rule;
    const double ends[] = {0.0, kink, 1.0};
    double sum = 0.0;
    lq_gauss_make(&rule, LQ_GAUSS_MAX);
    for (int p = 0; p < 2; p++)
        for (int i = 0; i < rule.count; i++) {
            const double w = rule.node[i], width = ends[p + 1] - ends[p];
            const double mu = ends[p] + width * w * w * (3.0 - 2.0 * w);
            sum += rule.weight[i] * width * 6.0 * w * (1.0 - w) * 2.0 * mu * f(s, mu);
        }
    return sum;
}

/* Cosine at which light that meets the relative index eta begins to pass. */
static double critical(double eta) {
    return eta < 1.0 ? sqrt((1.0 - eta) * (1.0 + eta)) : 0.0;
}

static double enters(const smooth *s, double mu) {
    return through(mu, s->eta, s->tau);
}

static double enters_sideways(const smooth *s, double mu) {
    return (1.0 - mu) * (1.0 + mu) * through(mu, s->eta, 1.0);
}

static double returns(const smooth *s, double mu) {
    const double once = crossing(s->tau, mu);
    return once * once * lq_fresnel_dielectric(mu, 1.0 / s->eta, NULL);
}

static double diffuse_transmission(const smooth *s) {
    return mean(s, enters, critical(s->eta)) / (s->eta * s->eta);
}

static double diffuse_reflection(const smooth *s) {
    return mean(s, returns, critical(1.0 / s->eta));
}

static double variance(smooth s) {
    s.tau = 1.0;
    return mean(&s, enters_sideways, critical(s.eta)) / mean(&s, enters, critical(s.eta));
}

static double coated(const smooth *s) {
    return lq_fresnel_dielectric(s->mu, s->eta, NULL) +
           enters(s, s->mu) * s->rho / (1.0 - s->rho * diffuse_reflection(s)) * diffuse_transmission(s);
}

bool lq_smooth_limit(const lq_kind *kind, const double *point, double *values) {
    const char *id = kind->id;
    const smooth s = {.mu = lq_kind_coordinate(kind, point, "mu", 1.0),
                      .n = lq_kind_coordinate(kind, point, "n", 1.0),
                      .kappa = lq_kind_coordinate(kind, point, "kappa", 0.0),
                      .eta = lq_kind_coordinate(kind, point, "eta", 1.0),
                      .tau = lq_kind_coordinate(kind, point, "tau", 1.0),
                      .rho = lq_kind_coordinate(kind, point, "rho", 0.0)};
    const double schlick = pow(1.0 - s.mu, 5.0);
    values[0] = 1.0;
    if (strcmp(id, "fgd") == 0) values[0] = lq_fresnel_conductor(s.mu, s.n, s.kappa);
    else if (strcmp(id, "tir-pass") == 0)
        values[0] = s.eta > 0.0 ? 1.0 - lq_fresnel_dielectric(s.mu, s.eta, NULL) : 0.0;
    else if (strcmp(id, "tir-loss") == 0) values[0] = sqrt((1.0 - s.mu) * (1.0 + s.mu)) > s.eta ? 1.0 : 0.0;
    else if (strcmp(id, "fgd-dielectric") == 0) values[0] = lq_fresnel_dielectric(s.mu, s.eta, NULL);
    else if (strcmp(id, "transmission") == 0) values[0] = enters(&s, s.mu);
    else if (strcmp(id, "diffuse-transmission") == 0) values[0] = diffuse_transmission(&s);
    else if (strcmp(id, "diffuse-reflection") == 0) values[0] = diffuse_reflection(&s);
    else if (strcmp(id, "coated-lambertian") == 0) values[0] = coated(&s);
    else if (strcmp(id, "dfg") == 0) {
        values[0] = 1.0 - schlick;
        values[1] = schlick;
    } else if (strcmp(id, "variance") == 0) {
        values[0] = variance(s);
        values[1] = NAN; /* a function of the first, which belongs to the NDF */
    } else return strcmp(id, "albedo") == 0 || strcmp(id, "albedo-average") == 0;
    return true;
}
