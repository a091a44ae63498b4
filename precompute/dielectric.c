/* The two-sided solver of dielectric.h: operators, iteration, readout. */
#include "precompute/dielectric.h"

#include "microfacet/facets.h"
#include "microfacet/fresnel.h"
#include "precompute/depth.h"
#include "precompute/first_bounce.h"
#include "precompute/kernels.h"
#include "precompute/nodes.h"
#include "tables/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Node cosines, depths, quadrature nodes per panel of d and per piece of azimuth. */
typedef struct resolution {
    int nodes, depths, outer, inner;
} resolution;

static const resolution levels[LQ_DIELECTRIC_LEVELS] = {{12, 16, 8, 8},   {20, 20, 8, 12},  {24, 20, 12, 18},
                                                        {32, 24, 16, 24}, {48, 32, 24, 32}, {64, 40, 32, 40}};

/* Where rewards of the light that leaves after its first hit are read, outside the iteration: tau^(1/mu) has
 * an essential singularity at grazing, which costs nodes that plain energy can do without. */
enum { LEAVING = 48, LEAVING_ENERGY = 16 };

typedef struct leaving {
    lq_node_axis axis;
    double lambda[LEAVING];
} leaving;

/* One level of one roughness. Rising and falling directions of both sides use the same nodes, so that light
 * which crosses undeviated is not interpolated at all. */
struct lq_rough_level {
    lq_node_axis axis;
    double lambda[LQ_NODES_MAX];
    lq_depths depths;
    lq_facet_rule rule;
    double *travel_down, *travel_up; /* [(i * depths + from) * depths + at] */
    double *survival;                /* [depth * nodes + j]: u^Lambda */
    leaving leaving[2];              /* for energy alone, and for any reward */
};

/* One side: the relative index of the other, where its reflectance kinks, and its facet operators: row i of a
 * falling (rising) ray over the 4 n directions it may be sent to: own side rising, own side falling, other
 * side rising, other side falling. */
typedef struct side {
    double eta;
    lq_panels kinks;
    double *fall, *rise;
} side;

typedef struct interface {
    const lq_ndf *ndf;
    double alpha;
    int nodes;
    const lq_rough_level *level;
    side sides[2];
} interface;

static void interface_free(interface *f) {
    for (int s = 0; s < 2; s++) {
        free(f->sides[s].fall);
        free(f->sides[s].rise);
    }
}

/* ----------------------------------------------------------------------------- roughness */

static void level_free(lq_rough_level *r) {
    if (!r) return;
    lq_node_axis_free(&r->axis);
    for (int i = 0; i < 2; i++) lq_node_axis_free(&r->leaving[i].axis);
    free(r->travel_down);
    free(r->travel_up);
    free(r->survival);
    free(r);
}

static void fill_travel(lq_rough_level *r) {
    const size_t depths = (size_t)r->depths.count, n = (size_t)r->axis.count;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < depths; k++) {
            const size_t at = (i * depths + k) * depths;
            lq_travel_down(&r->depths, r->lambda[i], r->depths.u[k], r->travel_down + at);
            lq_travel_up(&r->depths, r->lambda[i], r->depths.u[k], r->travel_up + at);
            r->survival[k * n + i] = lq_survival(r->lambda[i], r->depths.u[k]);
        }
}

/* From this band on, light crosses again and again almost undeviated, and an interpolation that overshoots
 * ever so slightly would be raised to the power of all these crossings: there it is linear. */
enum { NEARLY_MATCHED = 5 };

static bool leaving_make(leaving *l, const lq_ndf *ndf, double alpha, int count) {
    if (!lq_node_axis_make(&l->axis, alpha, LQ_RISING, count, 0.0)) return false;
    for (int i = 0; i < count; i++) l->lambda[i] = lq_lambda(ndf, alpha, l->axis.mu[i]);
    return true;
}

static lq_rough_level *level_make(const lq_ndf *ndf, double alpha, const resolution *l, int band) {
    const size_t n = (size_t)l->nodes, d = (size_t)l->depths;
    lq_rough_level *r = calloc(1, sizeof *r);
    if (!r) return NULL;
    lq_depths_make(&r->depths, l->depths);
    lq_facet_rule_make(&r->rule, l->outer, l->inner);
    r->travel_down = lq_zeros(n * d * d);
    r->travel_up = lq_zeros(n * d * d);
    r->survival = lq_zeros(n * d);
    const double scale = ldexp(alpha, -band);
    const bool axis = band >= NEARLY_MATCHED ? lq_node_axis_make_linear(&r->axis, scale, LQ_RISING, l->nodes)
                                             : lq_node_axis_make(&r->axis, scale, LQ_RISING, l->nodes, 0.0);
    const bool leaves = leaving_make(&r->leaving[0], ndf, alpha, LEAVING_ENERGY) &&
                        leaving_make(&r->leaving[1], ndf, alpha, LEAVING);
    if (!axis || !leaves || !r->travel_down || !r->travel_up || !r->survival) {
        level_free(r);
        return NULL;
    }
    for (int i = 0; i < l->nodes; i++) r->lambda[i] = lq_lambda(ndf, alpha, r->axis.mu[i]);
    fill_travel(r);
    return r;
}

lq_rough lq_rough_start(const lq_ndf *ndf, double alpha) {
    return (lq_rough){.ndf = ndf, .alpha = alpha};
}

void lq_rough_free(lq_rough *rough) {
    for (int band = 0; band < LQ_DIELECTRIC_BANDS; band++)
        for (int l = 0; l < LQ_DIELECTRIC_LEVELS; l++) level_free(rough->levels[band][l]);
}

/* Energies change over cosines of alpha and, where the media hardly differ, of the critical cosine, to which
 * the nodes are then scaled: they are dense below alpha / 2^band. Band 0 has none of it. */
static int band_of(double alpha, double eta) {
    const double critical = sqrt(2.0 * fabs(eta - 1.0));
    if (critical > 0.35 * alpha) return 0;
    const long band = lround(log2(alpha / critical));
    return band < LQ_DIELECTRIC_BANDS ? (int)band : LQ_DIELECTRIC_BANDS - 1;
}

double lq_dielectric_blind_below(const lq_rough *rough, double eta) {
    if (lq_dielectric_is_closed(rough, eta) || eta > 1.0 || band_of(rough->alpha, eta) < NEARLY_MATCHED)
        return 0.0;
    return 10.0 * sqrt(2.0 * (1.0 - eta));
}

double lq_dielectric_regular_from(const lq_rough *rough) {
    return lq_dielectric_is_closed(rough, 2.0) ? INFINITY
                                               : 1.0 + fmax(1e-4, 0.0011 * rough->alpha * rough->alpha);
}

static const lq_rough_level *level_of(lq_rough *rough, double eta, int l) {
    const int band = band_of(rough->alpha, eta);
    lq_rough_level **r = &rough->levels[band][l];
    if (!*r) *r = level_make(rough->ndf, rough->alpha, &levels[l], band);
    return *r;
}

/* --------------------------------------------------------------------------------- facets */

/* Where the facets seen from one direction send light: Chebyshev moments on the node axes of both sides. */
typedef struct scatter {
    const lq_solver_kernels *kernels;
    double eta;
    const lq_node_axis *axis;
    double reflected, refracted; /* sums of the weights */
    double *moments;             /* [4 * nodes], as the rows of side.fall */
    int nodes;
    /* Of a ray from outside, if wanted: moments of what is reflected and leaves at once, masking taken at
     * each facet. */
    const lq_ndf *ndf;
    double alpha, mu, area;
    const lq_node_axis *leaving;
    double *escaping; /* on the leaving nodes, or NULL */
    double *through;  /* likewise, all that is refracted away from the surface */
} scatter;

static void add_images(scatter *s, const lq_fan *fan, double factor, double *up, double *down,
                       double *total) {
    double weight[LQ_FAN_MAX];
    const size_t rising = (size_t)fan->up;
    for (int i = 0; i < fan->count; i++) weight[i] = factor * fan->weight[i];
    *total += lq_node_axis_moments(s->axis, s->kernels, rising, fan->mirror, weight, up);
    *total += lq_node_axis_moments(s->axis, s->kernels, (size_t)fan->count - rising, fan->mirror + rising,
                                   weight + rising, down);
}

static void add_escaping(scatter *s, const lq_fan *fan, double factor) {
    double area[LQ_FAN_MAX], weight[LQ_FAN_MAX];
    const size_t rising = (size_t)fan->up;
    s->ndf->areas_below(s->ndf, s->alpha, rising, fan->mirror, area);
    for (size_t i = 0; i < rising; i++) {
        const double lit = s->area * fan->mirror[i], sum = lit + area[i] * s->mu;
        weight[i] = sum > 0.0 ? factor * fan->weight[i] * lit / sum : 0.0;
    }
    lq_node_axis_moments(s->leaving, s->kernels, rising, fan->mirror, weight, s->escaping);
}

static void add_reflection(void *user, const lq_fan *fan) {
    scatter *s = user;
    const double f = lq_fresnel_dielectric(fan->cos_d, s->eta, NULL);
    if (s->escaping) add_escaping(s, fan, f);
    add_images(s, fan, f, s->moments, s->moments + s->nodes, &s->reflected);
}

static void add_refraction(void *user, const lq_fan *fan) {
    scatter *s = user;
    const double f = lq_fresnel_dielectric(fan->cos_d, s->eta, NULL);
    if (s->through) {
        double weight[LQ_FAN_MAX];
        for (int i = 0; i < fan->up; i++) weight[i] = (1.0 - f) * fan->weight[i];
        lq_node_axis_moments(s->leaving, s->kernels, (size_t)fan->up, fan->mirror, weight, s->through);
    }
    add_images(s, fan, 1.0 - f, s->moments + 2 * s->nodes, s->moments + 3 * s->nodes, &s->refracted);
}

/* Light that leaves a ray from outside, on the leaving nodes: reflected and not masked, and refracted, masked
 * or not. */
typedef struct direct {
    const leaving *at;
    double escaping[LEAVING], through[LEAVING];
} direct;

/* The row of direction v_z on side `s`: weights on the nodes of both sides that add up to 1, and the first
 * hit's direct light where it is asked for. */
static void facet_row(const interface *f, int s, double v_z, double *row, direct *first) {
    const side *own = &f->sides[s];
    const lq_node_axis *axis = &f->level->axis;
    const lq_facet_rule *rule = &f->level->rule;
    const int n = f->nodes;
    double moments[4 * LQ_NODES_MAX] = {0.0};
    direct at_once = {NULL, {0.0}, {0.0}};
    const double sine = lq_sine(fabs(v_z));
    scatter k = {.kernels = lq_solver_kernels_get(), .eta = own->eta, .axis = axis};
    k.moments = moments;
    k.nodes = n;
    if (first) {
        k.ndf = f->ndf;
        k.alpha = f->alpha;
        k.mu = v_z;
        k.area = lq_area_above(f->ndf, f->alpha, v_z, sine);
        k.leaving = &first->at->axis;
        k.escaping = at_once.escaping;
        k.through = at_once.through;
    }
    lq_facets_visit(f->ndf, f->alpha, v_z, sine, rule, &own->kinks, add_reflection, &k);
    lq_facets_visit_refracted(f->ndf, f->alpha, own->eta, v_z, sine, rule, &own->kinks, add_refraction, &k);
    const double scale = lq_inverse_area(k.reflected + k.refracted);
    for (int m = 0; m < 4 * n; m++) moments[m] *= scale;
    for (int m = 0; m < LEAVING; m++) {
        at_once.escaping[m] *= scale;
        at_once.through[m] *= scale;
    }
    for (int part = 0; part < 4; part++) lq_node_axis_project(axis, moments + part * n, row + part * n);
    if (first) {
        lq_node_axis_project(k.leaving, at_once.escaping, first->escaping);
        lq_node_axis_project(k.leaving, at_once.through, first->through);
    }
}

/* ----------------------------------------------------------------------------- operators */

static bool interface_make(interface *f, const lq_rough *rough, double eta, const lq_rough_level *level) {
    const int n = level->axis.count;
    const size_t row = 4 * (size_t)n;
    bool ok = true;
    *f = (interface){.ndf = rough->ndf, .alpha = rough->alpha, .nodes = n, .level = level};
    for (int s = 0; s < 2; s++) {
        side *a = &f->sides[s];
        a->eta = s == 0 ? eta : 1.0 / eta;
        lq_panels_start(&a->kinks, 0.0, 1.5707963267948966);
        if (a->eta < 1.0) lq_panels_add(&a->kinks, asin(a->eta), true);
        ok &= (a->fall = lq_zeros(row * (size_t)n)) && (a->rise = lq_zeros(row * (size_t)n));
    }
    for (int i = 0; ok && i < 2 * n; i++) {
        const int s = i / n, j = i % n;
        facet_row(f, s, level->axis.mu[j], f->sides[s].fall + (size_t)j * row, NULL);
        facet_row(f, s, -level->axis.mu[j], f->sides[s].rise + (size_t)j * row, NULL);
    }
    if (!ok) interface_free(f);
    return ok;
}

/* ------------------------------------------------------------------------------ iteration */

/* One batch of rewards, a lane each. */
typedef struct solution {
    lq_v8 *reward;    /* [side * nodes + j], of the rising nodes */
    lq_v8 *leaving;   /* [side * LEAVING + j], of the leaving ones */
    lq_v8 *value[2];  /* E: [depth * 2 nodes + (rising, falling)] */
    lq_v8 *before[2]; /* C: likewise */
} solution;

static bool solution_make(solution *x, const interface *f) {
    const size_t size = (size_t)f->level->depths.count * 2 * (size_t)f->nodes;
    lq_v8 *all = (lq_v8 *)(void *)lq_zeros((4 * size + 2 * (size_t)f->nodes + 2 * LEAVING) * LQ_LANES);
    *x = (solution){.reward = all + 4 * size, .leaving = all + 4 * size + 2 * (size_t)f->nodes};
    for (int s = 0; s < 2; s++) {
        x->value[s] = all + (size_t)s * size;
        x->before[s] = all + (size_t)(2 + s) * size;
    }
    return all;
}

static void solution_free(solution *x) {
    free(x->value[0]);
}

static lq_two_sided kernel_of(const interface *f, const solution *x, int s) {
    const side *a = &f->sides[s];
    return (lq_two_sided){.nodes = f->nodes,
                          .depths = f->level->depths.count,
                          .fall = a->fall,
                          .rise = a->rise,
                          .travel_down = f->level->travel_down,
                          .travel_up = f->level->travel_up,
                          .own = x->value[s],
                          .other = x->value[1 - s],
                          .before = x->before[s],
                          .reward = x->reward + s * f->nodes};
}

/* Passes count hits: a few dozen where the media differ, thousands where they nearly match. */
static int passes_max(const interface *f) {
    return (int)fmin(1.5e8 / ((double)f->level->depths.count * f->nodes * f->nodes), 20000.0); /* a second */
}

/* What the passes that are not made may add up to. */
static const double SETTLED = 1e-9;

/* False where the iteration grows instead: rays that graze a fine level meet hundreds of facets, and its
 * interpolation can overshoot by enough to matter then. A coarser level holds. */
static bool solve(const interface *f, solution *x) {
    const lq_solver_kernels *kernels = lq_solver_kernels_get();
    const size_t size = (size_t)f->level->depths.count * 2 * (size_t)f->nodes;
    for (int s = 0; s < 2; s++) memset(x->before[s], 0, size * sizeof(lq_v8));
    double change = 1.0, left = 1.0;
    const int most = passes_max(f);
    for (int pass = 0; pass < most && left > SETTLED && change < 10.0; pass++) {
        const double before = change;
        change = 0.0;
        for (int s = 0; s < 2; s++) {
            const lq_two_sided k = kernel_of(f, x, s);
            change = fmax(change, kernels->travel(&k, f->level->survival));
        }
        for (int s = 0; s < 2; s++) {
            const lq_two_sided k = kernel_of(f, x, s);
            kernels->meet(&k);
        }
        /* The changes fall like a geometric series: what all the later ones would add. */
        left = change < before ? change * fmax(change / (before - change), 1.0) : 1.0;
    }
    for (size_t q = 0; q < size; q++)
        if (!(fabs(x->value[0][q][0]) < 10.0 && fabs(x->value[1][q][0]) < 10.0)) return false; /* NaN too */
    return left <= 1e-6;
}

/* -------------------------------------------------------------------------------- readout */

/* Beta weights: the chance that light refracted on its first hit leaves the other side unhindered. */
static double refracted_escape(double lambda_i, double lambda_o) {
    return (1.0 + lambda_i) *
           exp(lgamma(1.0 + lambda_i) + lgamma(1.0 + lambda_o) - lgamma(2.0 + lambda_i + lambda_o));
}

/* What a reader needs at one cosine, kept while the batches pass. Near grazing the first facet is met at the
 * very top, where powers of the depth are all but steps that no collocation sees. Of the light that a rising
 * node gets, the part that leaves at once is therefore known in closed form, and the value of the rest,
 * averaged over the depths of arrival, is weighted with what really stays. */
typedef struct reader {
    double arrival[LQ_DEPTHS_MAX]; /* where a ray from outside meets its first facet */
    double row[4 * LQ_NODES_MAX];
    const leaving *leaving;
    double escaping[2 * LEAVING];      /* leaves at once, on the leaving nodes: own side, then other */
    double survives[2 * LQ_NODES_MAX]; /* the same per unit of light, as the depths see it */
    double staying[2 * LQ_NODES_MAX];  /* weight of E minus the reward of what survives */
} reader;

/* Survival at node j, averaged over the depths of arrival, on the side of arrival or on the other. */
static double mean_survival(const interface *f, const reader *r, int j, bool own) {
    const int n = f->nodes, depths = f->level->depths.count;
    double mean = 0.0;
    for (int k = 0; k < depths; k++)
        mean += r->arrival[k] * f->level->survival[(own ? k : depths - 1 - k) * n + j];
    return mean;
}

static double reflected_escape(double lambda_i, double lambda_o) {
    return (1.0 + lambda_i) / (1.0 + lambda_i + lambda_o);
}

/* The weight of what stays of one node's light, given its exact share: the depths see the share 1 - seen. */
static double weight_staying(double light, double share, double seen) {
    return seen < 1.0 - 1e-9 ? light * share / (1.0 - seen) : light;
}

/* Where next to nothing stays, the quotient of the two is rounding. */
static double staying_scale(double stays, double by_nodes) {
    return by_nodes > 1e-4 ? fmax(fmin(stays / by_nodes, 2.0), 0.0) : 1.0;
}

static void settle_sum(reader *r, int n) {
    double sum = 0.0, direct_light = 0.0;
    for (int j = 0; j < 2 * LEAVING; j++) direct_light += r->escaping[j];
    for (int j = 0; j < 2 * n; j++) sum += r->staying[j] * (1.0 - r->survives[j]);
    for (int j = 0; j < n; j++) sum += r->row[n + j] + r->row[3 * n + j];
    const double scale = direct_light > 1e-6 ? (1.0 - sum) / direct_light : 1.0;
    for (int j = 0; j < 2 * LEAVING; j++) r->escaping[j] *= scale;
}

static void reader_make(reader *r, const interface *f, const leaving *at, int s, double mu) {
    const int n = f->nodes;
    /* At mu = 0 itself the limit is approached only like mu^Lambda_o, slower than any table resolves. */
    const double cosine = fmax(mu, LQ_GRAZING);
    const double lambda_i = lq_lambda(f->ndf, f->alpha, cosine);
    lq_travel_down(&f->level->depths, lambda_i, 1.0, r->arrival);
    direct first = {at, {0.0}, {0.0}};
    facet_row(f, s, cosine, r->row, &first);
    double stays[2] = {0.0, 0.0}, by_nodes[2] = {0.0, 0.0}; /* rising, but not out: by facets, and by nodes */
    r->leaving = at;
    memset(r->escaping, 0, sizeof r->escaping);
    for (int j = 0; j < at->axis.count; j++) {
        r->escaping[j] = first.escaping[j];
        r->escaping[LEAVING + j] = first.through[j] * refracted_escape(lambda_i, at->lambda[j]);
        stays[0] -= r->escaping[j];
        stays[1] -= r->escaping[LEAVING + j];
    }
    for (int j = 0; j < 2 * n; j++) {
        const int way = j / n;
        const double lambda = f->level->lambda[j % n], light = r->row[2 * way * n + j % n];
        const double leaves =
            way == 0 ? reflected_escape(lambda_i, lambda) : refracted_escape(lambda_i, lambda);
        r->survives[j] = mean_survival(f, r, j % n, way == 0);
        r->staying[j] = weight_staying(light, 1.0 - leaves, r->survives[j]);
        stays[way] += light;
        by_nodes[way] += r->staying[j] * (1.0 - r->survives[j]);
    }
    for (int j = 0; j < 2 * n; j++) r->staying[j] *= staying_scale(stays[j / n], by_nodes[j / n]);
    /* What the scales could not mend goes to what leaves at once, so that all adds up to 1. */
    settle_sum(r, n);
}

/* What leaves at once is worth: all there is in single scattering. */
static void read_direct(int s, const reader *r, const solution *x, lq_v8 *value) {
    lq_v8 sum = {0.0};
    for (int j = 0; j < r->leaving->axis.count; j++)
        sum += r->escaping[j] * x->leaving[s * LEAVING + j] +
               r->escaping[LEAVING + j] * x->leaving[(1 - s) * LEAVING + j];
    *value = sum;
}

/* All orders at the lanes of x: what leaves at once, what stays of rising nodes, what falling ones are worth.
 */
static void read_multiple(const interface *f, int s, const reader *r, const solution *x, lq_v8 *value) {
    const int n = f->nodes, depths = f->level->depths.count;
    const lq_solver_kernels *kernels = lq_solver_kernels_get();
    lq_v8 sum, mean[2 * LQ_NODES_MAX];
    read_direct(s, r, x, &sum);
    for (int way = 0; way < 2; way++) {
        const int t = way == 0 ? s : 1 - s;
        kernels->average(depths, 2 * n, r->arrival, t != s, x->value[t], mean);
        for (int j = 0; j < n; j++) {
            const int at = way * n + j;
            sum += r->staying[at] * (mean[j] - r->survives[at] * x->reward[t * n + j]);
            sum += r->row[(2 * way + 1) * n + j] * mean[n + j];
        }
    }
    *value = sum;
}

static double reward_of(double tau, double mu) {
    return tau == 1.0 ? 1.0 : tau > 0.0 ? exp(log(tau) / mu) : 0.0;
}

/* Light is not lost: what does not leave one side leaves the other. Energy is always counted on the side that
 * the light comes from, so that both sides add up to 1. */
static bool is_complement(const lq_question *q, double tau) {
    return tau == 1.0 && q->scattering == LQ_MULTIPLE && q->reward_side != q->side;
}

static bool counts_energy(const lq_question *q) {
    for (size_t t = 0; t < q->tau_count; t++)
        if (q->tau[t] != 1.0) return false;
    return true;
}

static void load_rewards(const interface *f, const lq_question *q, const leaving *at, size_t first,
                         size_t count, solution *x) {
    const int n = f->nodes;
    memset(x->reward, 0, (2 * (size_t)n + 2 * LEAVING) * sizeof(lq_v8));
    for (size_t l = 0; l < count; l++) {
        const double tau = q->tau[first + l];
        const int payer = is_complement(q, tau) ? q->side : q->reward_side;
        for (int j = 0; j < n; j++) x->reward[payer * n + j][l] = reward_of(tau, f->level->axis.mu[j]);
        for (int j = 0; j < at->axis.count; j++)
            x->leaving[payer * LEAVING + j][l] = reward_of(tau, at->axis.mu[j]);
    }
}

static void answer_batch(const interface *f, const lq_question *q, const reader *readers, size_t first,
                         size_t count, const solution *x) {
    for (size_t m = 0; m < q->mu_count; m++) {
        const reader *r = &readers[m];
        lq_v8 value;
        if (q->scattering == LQ_SINGLE) read_direct(q->side, r, x, &value);
        else read_multiple(f, q->side, r, x, &value);
        for (size_t l = 0; l < count; l++) {
            const double energy = fmin(fmax(value[l], 0.0), 1.0);
            q->answer[(first + l) * q->mu_count + m] =
                is_complement(q, q->tau[first + l]) ? 1.0 - energy : energy;
        }
    }
}

static lq_status answer(const interface *f, const lq_question *q) {
    const leaving *at = &f->level->leaving[!counts_energy(q)];
    reader *readers = malloc(q->mu_count * sizeof *readers);
    solution x;
    lq_status status = LQ_OK;
    if (!readers || !solution_make(&x, f)) {
        free(readers);
        return LQ_NO_MEMORY;
    }
    for (size_t m = 0; m < q->mu_count; m++) reader_make(&readers[m], f, at, q->side, q->mu[m]);
    for (size_t first = 0; first < q->tau_count; first += LQ_LANES) {
        const size_t left = q->tau_count - first, count = left < LQ_LANES ? left : LQ_LANES;
        load_rewards(f, q, at, first, count, &x);
        if (q->scattering == LQ_MULTIPLE && !solve(f, &x)) status = LQ_NOT_CONVERGED;
        answer_batch(f, q, readers, first, count, &x);
    }
    solution_free(&x);
    free(readers);
    return status;
}

/* ----------------------------------------------------------------------------- the smooth limit */

/* alpha = 0, or eta = 1 where nothing happens at any roughness. */
static void answer_smooth(double eta, const lq_question *q) {
    const double index = q->side == 0 ? eta : 1.0 / eta;
    for (size_t m = 0; m < q->mu_count; m++) {
        double cos_t;
        const double r = lq_fresnel_dielectric(q->mu[m], index, &cos_t);
        const bool back = q->side == q->reward_side;
        const double energy = back ? r : 1.0 - r, cosine = back ? q->mu[m] : cos_t;
        for (size_t t = 0; t < q->tau_count; t++) {
            const double tau = q->tau[t];
            const double reward = cosine > 0.0 ? reward_of(tau, cosine) : tau == 1.0;
            q->answer[t * q->mu_count + m] = energy * reward;
        }
    }
}

bool lq_dielectric_is_closed(const lq_rough *rough, double eta) {
    return rough->alpha < LQ_SMOOTH_ALPHA || fabs(eta - 1.0) < LQ_MATCHED;
}

lq_status lq_dielectric_answer(lq_rough *rough, double eta, int l, const lq_question *questions, size_t count,
                               lq_error *error) {
    if (lq_dielectric_is_closed(rough, eta)) {
        for (size_t i = 0; i < count; i++) answer_smooth(eta, &questions[i]);
        return LQ_OK;
    }
    const lq_rough_level *shared = level_of(rough, eta, l);
    interface f;
    lq_status status = shared && interface_make(&f, rough, eta, shared) ? LQ_OK : LQ_NO_MEMORY;
    if (status == LQ_OK) {
        for (size_t i = 0; status == LQ_OK && i < count; i++) status = answer(&f, &questions[i]);
        interface_free(&f);
    }
    if (status == LQ_NO_MEMORY)
        lq_fail(error, status, "no memory to solve a dielectric at %d cosines", levels[l].nodes);
    return status == LQ_NOT_CONVERGED
               ? lq_fail(error, status, "the iteration at %d cosines did not settle", levels[l].nodes)
               : status;
}
