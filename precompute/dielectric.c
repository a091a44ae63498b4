/* The two-sided solver of dielectric.h: operators, iteration, readout. */
#include "precompute/dielectric.h"

#include "microfacet/fresnel.h"
#include "precompute/first_bounce.h"
#include "precompute/hits.h"
#include "precompute/kernels.h"
#include "precompute/rough_level.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What the passes that are not made may add up to. */
static const double SETTLED = 1e-9;

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
    const lq_leaving *at;
    double escaping[LQ_LEAVING], through[LQ_LEAVING];
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
    for (int m = 0; m < LQ_LEAVING; m++) {
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

/* ----------------------------------------------------------------------------- one batch */

/* One batch of rewards, a lane each. */
typedef struct solution {
    lq_hits_values hits;
    lq_v8 *leaving; /* rewards, [side * LQ_LEAVING + j], of the leaving nodes */
} solution;

static bool solution_make(solution *x, const interface *f) {
    x->leaving = (lq_v8 *)(void *)lq_zeros((size_t)(2 * LQ_LEAVING * LQ_LANES));
    if (x->leaving && lq_hits_values_make(&x->hits, f->level)) return true;
    free(x->leaving);
    return false;
}

static void solution_free(solution *x) {
    lq_hits_values_free(&x->hits);
    free(x->leaving);
}

static bool solve(const interface *f, solution *x, size_t lanes) {
    const lq_hits hits = {
        f->level, 2, {f->sides[0].fall, f->sides[1].fall}, {f->sides[0].rise, f->sides[1].rise}};
    return lq_hits_solve_lanes(&hits, &x->hits, lanes, SETTLED);
}

/* -------------------------------------------------------------------------------- readout */

/* What a reader needs at one cosine, kept while the batches pass. Near grazing the first facet is met at the
 * very top, where powers of the depth are all but steps that no collocation sees. Of the light that a rising
 * node gets, the part that leaves at once is therefore known in closed form, and the rest is read where it
 * meets its second facet, whose depths are known too. */
typedef struct reader {
    double arrival[LQ_DEPTHS_MAX]; /* where a ray from outside meets its first facet, and what it reflects,
                                      the next */
    double row[4 * LQ_NODES_MAX];
    const lq_leaving *leaving;
    double escaping[2 * LQ_LEAVING]; /* leaves at once, on the leaving nodes: own side, then other */
    double staying[LQ_NODES_MAX];    /* what stays of the rising nodes of the own side */
    double *refracted; /* [depth * nodes + j]: likewise of the other side, at its second facet */
} reader;

/* Where next to nothing stays, the quotient of the two is rounding. */
static double staying_scale(double stays, double by_nodes) {
    return by_nodes > 1e-4 ? fmax(fmin(stays / by_nodes, 2.0), 0.0) : 1.0;
}

/* Light on its way up on one side after the first facet: what leaves, by facets, and what its nodes keep. */
typedef struct rising {
    double stays, by_nodes;
} rising;

static void read_own_rising(reader *r, const interface *f, double lambda_i, double leaves) {
    rising own = {-leaves, 0.0};
    for (int j = 0; j < f->nodes; j++) {
        const double light = r->row[j];
        r->staying[j] = light * (1.0 - lq_reflected_escape(lambda_i, f->level->lambda[j]));
        own.stays += light;
        own.by_nodes += r->staying[j];
    }
    const double scale = staying_scale(own.stays, own.by_nodes);
    for (int j = 0; j < f->nodes; j++) r->staying[j] *= scale;
}

static void read_refracted(reader *r, const interface *f, double lambda_i, double leaves) {
    const int n = f->nodes, size = n * f->level->depths.count;
    const double *light = r->row + 2 * n;
    rising other = {-leaves, 0.0};
    lq_rough_level_refracted(f->level, lambda_i, r->refracted);
    for (int j = 0; j < n; j++) other.stays += light[j];
    for (int i = 0; i < size; i++) {
        r->refracted[i] *= light[i % n];
        other.by_nodes += r->refracted[i];
    }
    const double scale = staying_scale(other.stays, other.by_nodes);
    for (int i = 0; i < size; i++) r->refracted[i] *= scale;
}

/* What the scales could not mend goes to what leaves at once, so that all adds up to 1. */
static void settle_sum(reader *r, const interface *f) {
    const int n = f->nodes, size = n * f->level->depths.count;
    double sum = 0.0, direct_light = 0.0;
    for (int j = 0; j < 2 * LQ_LEAVING; j++) direct_light += r->escaping[j];
    for (int j = 0; j < n; j++) sum += r->staying[j] + r->row[n + j] + r->row[3 * n + j];
    for (int i = 0; i < size; i++) sum += r->refracted[i];
    const double scale = direct_light > 1e-6 ? (1.0 - sum) / direct_light : 1.0;
    for (int j = 0; j < 2 * LQ_LEAVING; j++) r->escaping[j] *= scale;
}

/* `refracted` has room for depths * nodes. */
static void reader_make(reader *r, const interface *f, const lq_leaving *at, int s, double mu,
                        double *refracted) {
    /* At mu = 0 itself the limit is approached only like mu^Lambda_o, slower than any table resolves. */
    const double cosine = fmax(mu, LQ_GRAZING);
    const double lambda_i = lq_lambda(f->ndf, f->alpha, cosine);
    direct first = {at, {0.0}, {0.0}};
    double leaves[2] = {0.0, 0.0};
    lq_arrival(&f->level->depths, lambda_i, r->arrival);
    facet_row(f, s, cosine, r->row, &first);
    r->leaving = at;
    r->refracted = refracted;
    memset(r->escaping, 0, sizeof r->escaping);
    for (int j = 0; j < at->axis.count; j++) {
        r->escaping[j] = first.escaping[j];
        r->escaping[LQ_LEAVING + j] = first.through[j] * lq_refracted_escape(lambda_i, at->lambda[j]);
        leaves[0] += r->escaping[j];
        leaves[1] += r->escaping[LQ_LEAVING + j];
    }
    read_own_rising(r, f, lambda_i, leaves[0]);
    read_refracted(r, f, lambda_i, leaves[1]);
    settle_sum(r, f);
}

/* What leaves at once is worth: all there is in single scattering. */
static void read_direct(int s, const reader *r, const solution *x, lq_v8 *value) {
    lq_v8 sum = {0.0};
    for (int j = 0; j < r->leaving->axis.count; j++)
        sum += r->escaping[j] * x->leaving[s * LQ_LEAVING + j] +
               r->escaping[LQ_LEAVING + j] * x->leaving[(1 - s) * LQ_LEAVING + j];
    *value = sum;
}

/* All orders at the lanes of x: what leaves at once, what rising light is worth when it meets its second
 * facet, and what falling light is when it sets out. */
static void read_multiple(const interface *f, int s, const reader *r, const solution *x, lq_v8 *value) {
    const int n = f->nodes, depths = f->level->depths.count;
    const lq_solver_kernels *kernels = lq_solver_kernels_get();
    lq_v8 sum, refracted, mean[2 * LQ_NODES_MAX];
    read_direct(s, r, x, &sum);
    kernels->average(depths, 2 * n, r->arrival, false, x->hits.before[s], mean);
    for (int j = 0; j < n; j++) sum += r->staying[j] * mean[j];
    kernels->contract(depths, n, r->refracted, x->hits.before[1 - s], &refracted);
    for (int way = 0; way < 2; way++) {
        const int t = way == 0 ? s : 1 - s;
        kernels->average(depths, 2 * n, r->arrival, t != s, x->hits.value[t], mean);
        for (int j = 0; j < n; j++) sum += r->row[(2 * way + 1) * n + j] * mean[n + j];
    }
    *value = sum + refracted;
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

static void load_rewards(const interface *f, const lq_question *q, const lq_leaving *at, size_t first,
                         size_t count, solution *x) {
    const int n = f->nodes;
    memset(x->hits.reward, 0, 2 * (size_t)n * sizeof(lq_v8));
    memset(x->leaving, 0, 2 * LQ_LEAVING * sizeof(lq_v8));
    for (size_t l = 0; l < count; l++) {
        const double tau = q->tau[first + l];
        const int payer = is_complement(q, tau) ? q->side : q->reward_side;
        for (int j = 0; j < n; j++) x->hits.reward[payer * n + j][l] = reward_of(tau, f->level->axis.mu[j]);
        for (int j = 0; j < at->axis.count; j++)
            x->leaving[payer * LQ_LEAVING + j][l] = reward_of(tau, at->axis.mu[j]);
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
    const lq_leaving *at = &f->level->leaving[!counts_energy(q)];
    const size_t hits = (size_t)(f->nodes * f->level->depths.count);
    reader *readers = malloc(q->mu_count * (sizeof *readers + hits * sizeof(double)));
    double *refracted = (double *)(void *)(readers + q->mu_count);
    solution x;
    lq_status status = LQ_OK;
    if (!readers || !solution_make(&x, f)) {
        free(readers);
        return LQ_NO_MEMORY;
    }
    for (size_t m = 0; m < q->mu_count; m++)
        reader_make(&readers[m], f, at, q->side, q->mu[m], refracted + m * hits);
    for (size_t first = 0; first < q->tau_count; first += LQ_LANES) {
        const size_t left = q->tau_count - first, count = left < LQ_LANES ? left : LQ_LANES;
        load_rewards(f, q, at, first, count, &x);
        if (q->scattering == LQ_MULTIPLE && !solve(f, &x, count)) status = LQ_NOT_CONVERGED;
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
    const lq_rough_level *shared = lq_rough_level_get(rough, eta, l);
    interface f;
    lq_status status = shared && interface_make(&f, rough, eta, shared) ? LQ_OK : LQ_NO_MEMORY;
    if (status == LQ_OK) {
        for (size_t i = 0; status == LQ_OK && i < count; i++) status = answer(&f, &questions[i]);
        interface_free(&f);
    }
    if (status == LQ_NO_MEMORY) lq_fail(error, status, "no memory to solve a dielectric at level %d", l);
    return status == LQ_NOT_CONVERGED
               ? lq_fail(error, status, "the iteration at %d cosines did not settle", shared->axis.count)
               : status;
}
