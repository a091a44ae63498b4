/* R + T, reciprocity and furnace over the tables of a folder. */
#include "validate/certificate_pack.h"

#include "microfacet/gauss.h"
#include "validate/stream.h"

#include <math.h>
#include <string.h>

enum { POINTS = 20000, STREAM_PACK = 0x7061636b, MEAN_NODES = 32 };

/* The four tables of one coating; NULL: not there. Axes: mu, alpha, eta (, tau) and eta, alpha, tau. */
typedef struct coating {
    lq_certified *r01, *t01, *t10, *r10;
    const char *ndf;
    double alpha[2], eta[2], mu[2]; /* where all of them are defined */
} coating;

static double decode(const lq_certified *certified, const double *point) {
    const lq_sample_request *r = &certified->certificate.request;
    const lq_stage *last = &r->stages[r->stage_count - 1];
    return last->decode(last->subject, 0, point);
}

static double at_mu(const lq_certified *certified, double mu, double alpha, double eta) {
    const double point[LQ_MAX_AXES] = {mu, alpha, eta, 1.0};
    return decode(certified, point);
}

static double at_diffuse(const lq_certified *certified, double alpha, double eta) {
    const double point[LQ_MAX_AXES] = {eta, alpha, 1.0};
    return decode(certified, point);
}

/* ------------------------------------------------------------------------------------- the tables */

/* The table of a kind with this NDF, if it holds all orders of scattering and reaches tau = 1. */
static lq_certified *find(lq_certified *list, size_t count, const char *kind, const char *ndf) {
    for (size_t i = 0; i < count; i++) {
        const lq_sample_request *r = &list[i].certificate.request;
        if (strcmp(r->kind->id, kind) != 0 || strcmp(r->settings.ndf, ndf) != 0 ||
            r->settings.scattering != LQ_MULTIPLE)
            continue;
        bool clear = true;
        for (int a = 0; a < r->kind->axis_count; a++)
            if (strcmp(r->kind->axes[a].name, "tau") == 0) clear = r->domain.max[a] >= 1.0;
        if (clear) return &list[i];
    }
    return NULL;
}

static void cut(double range[2], const lq_certified *certified, const char *axis) {
    if (!certified) return;
    const lq_sample_request *r = &certified->certificate.request;
    for (int a = 0; a < r->kind->axis_count; a++)
        if (strcmp(r->kind->axes[a].name, axis) == 0) {
            range[0] = fmax(range[0], r->domain.min[a]);
            range[1] = fmin(range[1], r->domain.max[a]);
        }
}

static coating gather(lq_certified *list, size_t count, const char *ndf) {
    coating c = {.ndf = ndf, .alpha = {0.0, 1.0}, .eta = {0.0, 100.0}, .mu = {0.0, 1.0}};
    c.r01 = find(list, count, "fgd-dielectric", ndf);
    c.t01 = find(list, count, "transmission", ndf);
    c.t10 = find(list, count, "diffuse-transmission", ndf);
    c.r10 = find(list, count, "diffuse-reflection", ndf);
    lq_certified *const all[] = {c.r01, c.t01, c.t10, c.r10};
    for (size_t i = 0; i < 4; i++) {
        cut(c.alpha, all[i], "alpha");
        cut(c.eta, all[i], "eta");
        cut(c.mu, all[i], "mu");
    }
    return c;
}

/* ----------------------------------------------------------------------------------- the checks */

static void judge(lq_certified *to, const char *name, double value, const char *what) {
    const double bound = to->budget.bound[LQ_NORM_MAX];
    lq_check_add(to, name, value, bound > 0.0 ? bound : NAN, "%s, %d points at tau = 1", what, POINTS);
}

static double between(const double range[2], lq_stream *stream) {
    return range[0] + (range[1] - range[0]) * lq_stream_uniform(stream);
}

static void check_energy(const coating *c) {
    double most = 0.0, furnace = 0.0;
    for (size_t i = 0; i < POINTS; i++) {
        lq_stream stream = lq_stream_open(1, STREAM_PACK, i);
        const double mu = between(c->mu, &stream), alpha = between(c->alpha, &stream);
        const double eta = between(c->eta, &stream);
        const double r = at_mu(c->r01, mu, alpha, eta), t = at_mu(c->t01, mu, alpha, eta);
        most = fmax(most, r + t - 1.0);
        if (!c->t10 || !c->r10) continue;
        const double back = at_diffuse(c->r10, alpha, eta), out = at_diffuse(c->t10, alpha, eta);
        furnace = fmax(furnace, fabs(r + t * out / (1.0 - back) - 1.0));
    }
    judge(c->t01, "R + T", most, "R01 + T01 - 1 at most");
    if (c->t10 && c->r10) judge(c->r10, "furnace", furnace, "R01 + T01 T10 / (1 - R10) - 1");
}

/* 2 integral f(mu) mu dmu. */
static double mean(const lq_certified *certified, const lq_gauss *rule, double alpha, double eta) {
    double sum = 0.0;
    for (int i = 0; i < rule->count; i++) {
        /* mu = v^2: nodes crowd at grazing, where energies turn */
        const double v = rule->node[i];
        sum += rule->weight[i] * 4.0 * v * v * v * at_mu(certified, v * v, alpha, eta);
    }
    return sum;
}

/* What light from below does, from what light from above does; for both of `directional` and `diffuse`. */
static void check_reciprocity(const coating *c, lq_certified *directional, lq_certified *diffuse,
                              bool transmits) {
    lq_gauss rule;
    double most = 0.0;
    lq_gauss_make(&rule, MEAN_NODES);
    for (size_t i = 0; i < POINTS / 20; i++) {
        lq_stream stream = lq_stream_open(2, STREAM_PACK, i);
        const double alpha = between(c->alpha, &stream), eta = between(c->eta, &stream);
        const double above = mean(directional, &rule, alpha, eta) / (eta * eta);
        const double below = at_diffuse(diffuse, alpha, eta);
        const double expected = transmits ? above : 1.0 - (1.0 / (eta * eta) - above);
        most = fmax(most, fabs(below - expected));
    }
    const double bound = diffuse->budget.bound[LQ_NORM_MAX];
    lq_check_add(diffuse, "reciprocity", most, bound > 0.0 ? bound : NAN, "%s, %d points at tau = 1",
                 transmits ? "T10 - T01bar / eta^2" : "R10 - (1 - (1 - R01bar) / eta^2)", POINTS / 20);
}

void lq_check_pack(lq_certified *list, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const char *ndf = list[i].certificate.request.settings.ndf;
        bool first = true;
        for (size_t k = 0; k < i; k++)
            first = first && strcmp(list[k].certificate.request.settings.ndf, ndf) != 0;
        if (!first) continue;
        const coating c = gather(list, count, ndf);
        if (!(c.alpha[0] <= c.alpha[1] && c.eta[0] <= c.eta[1] && c.mu[0] <= c.mu[1])) continue;
        if (c.r01 && c.t01) check_energy(&c);
        if (c.t01 && c.t10) check_reciprocity(&c, c.t01, c.t10, true);
        if (c.r01 && c.r10) check_reciprocity(&c, c.r01, c.r10, false);
    }
}
