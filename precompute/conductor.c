/* The deterministic solver of conductor.h: scatter operators, a batched Gauss-Seidel, refinement. */
#include "precompute/conductor.h"

#include "microfacet/fresnel.h"
#include "precompute/critical.h"
#include "precompute/first_bounce.h"
#include "precompute/kernels.h"
#include "precompute/nodes.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------- resolutions */

/* Node cosines, quadrature nodes per panel of d, and per piece of azimuth. The quadrature grows with the
 * nodes because it integrates their basis: at a critical angle the high Chebyshev moments do not fade, and an
 * aliased one costs more than it resolves (measured: 2e-5 instead of 1e-6 at n = 0.7, alpha = 0.1). The
 * azimuth grows too with every level: where two had 16 of each, an error of Beckmann's azimuth showed in no
 * difference, and at 307 of 600 points of alpha in [0.7, 1] the estimate was too small, by 14 times. */
typedef struct level {
    int nodes, outer, inner;
    bool fine; /* see operators_allocate */
} level;

static const level levels[] = {{12, 8, 12, false},  {16, 10, 16, false}, {24, 12, 20, false},
                               {32, 16, 24, false}, {48, 24, 32, false}, {64, 32, 40, false},
                               {96, 40, 56, true},  {128, 48, 60, true}, {192, 56, 64, true}};

/* Of materials whose axes are divided: nodes of all elements together. */
static const level divided[] = {{16, 8, 12, false},  {24, 12, 16, false}, {36, 12, 20, false},
                                {48, 16, 24, false}, {60, 18, 28, false}, {84, 24, 36, false},
                                {120, 32, 48, true}, {168, 40, 56, true}, {240, 52, 64, true}};
enum { LEVELS = sizeof levels / sizeof levels[0] };

/* ------------------------------------------------------------------------------ operators */

typedef struct operators {
    int nodes, curves;
    bool fine, rooted;
    size_t stride;
    lq_facet_cuts cuts; /* where the axes are divided */
    lq_node_axis down, up;
    double a_down[LQ_NODES_MAX], a_up[LQ_NODES_MAX];
    double *dd, *du, *uu; /* as in lq_sylvester */
} operators;

static void operators_free(operators *o) {
    free(o->dd);
    free(o->du);
    free(o->uu);
    lq_node_axis_free(&o->down);
    lq_node_axis_free(&o->up);
}

/* Scatter moments of one direction: for every curve the Chebyshev moments of where its facets send light. */
typedef struct scatter {
    const lq_curves *curves;
    const lq_solver_kernels *kernels;
    const operators *o;
    double total;
    double *to_down, *to_up; /* [curve * nodes + moment] */
} scatter;

static void scatter_part(scatter *s, const lq_node_axis *axis, size_t count, const double *cosine,
                         const double *weight, const double *curve, double *sums) {
    double moment[LQ_NODES_MAX] = {0.0};
    if (!count) return;
    s->total += lq_node_axis_moments(axis, s->kernels, count, cosine, weight, moment);
    s->kernels->spread(s->curves->count, curve, s->o->nodes, moment, sums);
}

static void scatter_fan(void *user, const lq_fan *fan) {
    scatter *s = user;
    double curve[LQ_CURVES_MAX];
    const size_t up = (size_t)fan->up;
    lq_curves_at(s->curves, fan->cos_d, curve);
    scatter_part(s, &s->o->up, up, fan->mirror, fan->weight, curve, s->to_up);
    scatter_part(s, &s->o->down, (size_t)fan->count - up, fan->mirror + up, fan->weight + up, curve,
                 s->to_down);
}

/* Row i of an operator from its moments. Element (i, j) of curve k goes to out[k * stride + i * row + j *
 * column]. */
static void write_row(const operators *o, const lq_node_axis *axis, const double *moments, double total,
                      int i, int row, int column, double *out) {
    double values[LQ_NODES_MAX];
    const double scale = lq_inverse_area(total);
    for (int k = 0; k < o->curves; k++) {
        lq_node_axis_project(axis, moments + k * o->nodes, values);
        for (int j = 0; j < o->nodes; j++)
            out[(size_t)k * o->stride + (size_t)(i * row + j * column)] = values[j] * scale;
    }
}

static void scatter_direction(const lq_ndf *ndf, double alpha, double v_z, const lq_facet_rule *rule,
                              scatter *s) {
    const size_t size = (size_t)s->curves->count * (size_t)s->o->nodes * sizeof(double);
    const lq_facet_view view = {ndf,        alpha, 0.0, v_z, lq_sine(fabs(v_z)), rule, &s->curves->panels,
                                &s->o->cuts};
    memset(s->to_down, 0, size);
    memset(s->to_up, 0, size);
    s->total = 0.0;
    lq_facets_visit_view(&view, scatter_fan, s);
}

/* From this roughness on a rooted axis is the better one at few nodes, too. */
static const double ROOTED = 0.15;

/* Nodes of every element of one axis, so that both have as many in all. */
static int nodes_of(const level *l, int elements, int others) {
    const int both = elements == others ? elements : elements * others;
    return (l->nodes + both - 1) / both * both / elements;
}

static bool make_axes(operators *o, double alpha, const level *l, const lq_critical *at) {
    const int down = at->down_count + 1, up = at->up_count + 1;
    o->rooted = l->fine || alpha >= (at->down_count ? 0.5 : 1.0) * ROOTED;
    const lq_sense falling = o->rooted ? LQ_FALLING_ROOTED : LQ_FALLING;
    return lq_node_axis_make_divided(&o->down, alpha, falling, at->down, at->down_count,
                                     nodes_of(l, down, up)) &&
           lq_node_axis_make_divided(&o->up, alpha, LQ_RISING, at->up, at->up_count, nodes_of(l, up, down));
}

static void set_cuts(lq_facet_cuts *cuts, const lq_critical *at) {
    for (int i = 0; i < at->up_count; i++) cuts->cosine[cuts->count++] = at->up[i];
    for (int i = 0; i < at->down_count; i++) cuts->back[cuts->back_count++] = at->down[i];
}

static bool operators_allocate(operators *o, double alpha, const lq_curves *curves, const level *l,
                               const lq_critical *at) {
    *o = (operators){.curves = curves->count, .fine = l->fine};
    const bool axes = make_axes(o, alpha, l, at);
    const size_t n = (size_t)o->down.count, k = (size_t)curves->count;
    o->nodes = o->down.count;
    o->stride = (n * n + 7) / 8 * 8;
    set_cuts(&o->cuts, at);
    o->dd = lq_zeros(k * o->stride);
    o->du = lq_zeros(k * o->stride);
    o->uu = lq_zeros(k * o->stride);
    return axes && o->dd && o->du && o->uu;
}

static void operators_fill(operators *o, const lq_ndf *ndf, double alpha, const level *l, scatter *s) {
    lq_facet_rule rule;
    lq_facet_rule_make(&rule, l->outer, l->inner);
    for (int i = 0; i < o->nodes; i++) {
        o->a_down[i] = 1.0 + lq_lambda(ndf, alpha, o->down.mu[i]);
        o->a_up[i] = lq_lambda(ndf, alpha, o->up.mu[i]);
        scatter_direction(ndf, alpha, o->down.mu[i], &rule, s);
        write_row(o, &o->down, s->to_down, s->total, i, o->nodes, 1, o->dd);
        write_row(o, &o->up, s->to_up, s->total, i, o->nodes, 1, o->du);
        scatter_direction(ndf, alpha, -o->up.mu[i], &rule, s);
        write_row(o, &o->up, s->to_up, s->total, i, 1, o->nodes, o->uu);
    }
}

static bool operators_make(operators *o, const lq_ndf *ndf, double alpha, const lq_curves *curves,
                           const level *l, const lq_critical *at) {
    scatter s = {.curves = curves, .kernels = lq_solver_kernels_get(), .o = o};
    bool ok = operators_allocate(o, alpha, curves, l, at);
    const size_t row = (size_t)curves->count * (size_t)o->nodes;
    s.to_down = lq_zeros(row);
    s.to_up = lq_zeros(row);
    ok = ok && s.to_down && s.to_up;
    if (ok) operators_fill(o, ndf, alpha, l, &s);
    free(s.to_down);
    free(s.to_up);
    if (!ok) operators_free(o);
    return ok;
}

/* -------------------------------------------------------------------------------- readout */

typedef struct readout {
    lq_readout at;
    double *escaping, *remaining, *weights;
} readout;

static void readout_free(readout *r) {
    free(r->escaping);
    free(r->remaining);
    free(r->weights);
}

/* False without memory; free it in either case. */
static bool readout_make(readout *r, const operators *o, const lq_ndf *ndf, double alpha,
                         const lq_curves *curves, const level *l, const double *mu, size_t count) {
    const size_t k = (size_t)curves->count, n = (size_t)o->nodes;
    *r = (readout){{0}, lq_zeros(count * k), lq_zeros(count * k), lq_zeros(count * n)};
    if (!r->escaping || !r->remaining || !r->weights) return false;
    lq_facet_rule rule;
    lq_facet_rule_make(&rule, l->outer, l->inner);
    for (size_t m = 0; m < count; m++) {
        lq_first_bounce(ndf, alpha, LQ_CORRELATED, mu[m], curves, &rule, r->escaping + m * k,
                        r->remaining + m * k);
        (o->fine ? lq_node_axis_weights_from_zero : lq_node_axis_weights)(&o->down, mu[m],
                                                                          r->weights + m * n);
    }
    r->at = (lq_readout){count, r->escaping, r->remaining, r->weights};
    return true;
}

/* -------------------------------------------------------------------------------- batches */

/* Work space of the batches of one level. */
typedef struct batch {
    lq_sylvester s;
    bool rooted; /* what remains at its first nodes is next to nothing, but known */
    lq_v8 *work, *coefficients, *ratio, *energy;
} batch;

static void batch_free(batch *b) {
    free(b->work);
    free(b->coefficients);
    free(b->ratio);
    free(b->energy);
}

static lq_v8 *vectors(size_t count) {
    return (lq_v8 *)(void *)lq_zeros(count * LQ_LANES);
}

static bool batch_make(batch *b, const operators *o, size_t mu_count) {
    *b = (batch){.rooted = o->rooted,
                 .work = vectors(4 * o->stride),
                 .coefficients = vectors((size_t)o->curves),
                 .ratio = vectors((size_t)o->nodes),
                 .energy = vectors(mu_count)};
    b->s = (lq_sylvester){.nodes = o->nodes,
                          .curves = o->curves,
                          .stride = o->stride,
                          .loses = o->fine,
                          .dd = o->dd,
                          .du = o->du,
                          .uu = o->uu,
                          .a_down = o->a_down,
                          .a_up = o->a_up,
                          .coefficients = b->coefficients,
                          .down = b->work,
                          .source = b->work + o->stride,
                          .up = b->work + 2 * o->stride,
                          .r = b->work + 3 * o->stride};
    if (b->work && b->coefficients && b->ratio && b->energy) return true;
    batch_free(b);
    return false;
}

/* The coefficients of up to LQ_LANES materials; unused lanes get total reflection. */
static void batch_load(batch *b, const lq_conductors *materials, const size_t *which, size_t count) {
    for (int k = 0; k < b->s.curves; k++)
        for (size_t l = 0; l < LQ_LANES; l++)
            b->coefficients[k][l] =
                l < count ? materials->coefficients[which[l] * (size_t)b->s.curves + (size_t)k] : 0.0;
}

/* Gauss-Seidel in order of rising cosines follows the light: grazing rays first, and every reflection only
 * raises a ray, so that one sweep would do were the basis local. It takes 4 to 12. */
enum { SWEEPS_MAX = 400 };

static void batch_solve(batch *b, const lq_solver_kernels *kernels, const lq_readout *at, double tolerance) {
    const double settle = fmin(1e-4 * tolerance, 1e-11);
    b->s.negligible = b->rooted ? 1e-14 : 0.01 * tolerance;
    kernels->assemble(&b->s);
    memset(b->s.r, 0, b->s.stride * sizeof(lq_v8));
    for (int sweep = 0; sweep < SWEEPS_MAX && kernels->sweep(&b->s) > settle; sweep++) continue;
    kernels->survival(&b->s, b->ratio);
    kernels->read(at, &b->s, b->ratio, b->energy);
}

/* ----------------------------------------------------------------------------- refinement */

/* What is asked for, and where it is kept from level to level. */
typedef struct refinement {
    const lq_ndf *ndf;
    double alpha;
    const double *mu;
    size_t mu_count;
    double tolerance;
    double *energy; /* [material * mu_count + m] */
    double *change; /* of each material, from the level before; negative: not solved yet */
} refinement;

/* Materials solved together: a basis of curves of their own, and of each its place in the refinement. */
typedef struct group {
    const lq_conductors *materials;
    size_t *active; /* those not yet within tolerance, ascending, as indices into `materials` */
    size_t active_count;
    const size_t *place; /* of each of `materials`, or NULL: their own index */
} group;

static size_t place_of(const group *g, size_t material) {
    return g->place ? g->place[material] : material;
}

/* The first level has nothing to be compared with: what it changes is infinite. */
static void keep(refinement *r, size_t place, const lq_v8 *energy, size_t lane) {
    const bool first = r->change[place] < 0.0;
    double change = first ? INFINITY : 0.0;
    for (size_t m = 0; m < r->mu_count; m++) {
        const double now = fmin(fmax(energy[m][lane], 0.0), 1.0);
        double *kept = r->energy + place * r->mu_count + m;
        if (!first) change = fmax(change, fabs(now - *kept));
        *kept = now;
    }
    r->change[place] = change;
}

/* Two levels that agree by accident would make the estimate too small. It is twice the largest difference
 * over many cosines, and never below a tenth of what was asked for. */
static double estimate_of(const refinement *r, size_t place) {
    return fmax(2.0 * r->change[place], 0.1 * r->tolerance);
}

static bool solve_batches(refinement *r, const group *g, const operators *o, const readout *read) {
    const lq_solver_kernels *kernels = lq_solver_kernels_get();
    batch b;
    if (!batch_make(&b, o, r->mu_count)) return false;
    for (size_t first = 0; first < g->active_count; first += LQ_LANES) {
        const size_t left = g->active_count - first, count = left < LQ_LANES ? left : LQ_LANES;
        batch_load(&b, g->materials, g->active + first, count);
        batch_solve(&b, kernels, &read->at, r->tolerance);
        for (size_t lane = 0; lane < count; lane++)
            keep(r, place_of(g, g->active[first + lane]), b.energy, lane);
    }
    batch_free(&b);
    return true;
}

/* Where the axes of a group are divided: nowhere, if it has many materials. */
static lq_critical divisions_of(const refinement *r, const group *g, bool fine) {
    const lq_conductors *m = g->materials;
    return m->count == 1 ? lq_critical_find(r->alpha, m->n[0], m->kappa[0], fine)
                         : (lq_critical){.distance = INFINITY};
}

static bool is_divided(const refinement *r, const group *g) {
    return divisions_of(r, g, false).down_count > 0;
}

static bool solve_level(refinement *r, const group *g, const level *l) {
    const lq_critical at = divisions_of(r, g, l->fine);
    const lq_curves *curves = &g->materials->curves;
    operators o;
    readout read;
    if (!operators_make(&o, r->ndf, r->alpha, curves, l, &at)) return false;
    const bool ok = readout_make(&read, &o, r->ndf, r->alpha, curves, l, r->mu, r->mu_count) &&
                    solve_batches(r, g, &o, &read);
    readout_free(&read);
    operators_free(&o);
    return ok;
}

static void retire(const refinement *r, group *g) {
    size_t left = 0;
    for (size_t i = 0; i < g->active_count; i++)
        if (estimate_of(r, place_of(g, g->active[i])) > r->tolerance) g->active[left++] = g->active[i];
    g->active_count = left;
}

static bool refine(refinement *r, group *g, int from);

/* Go on with the active materials of a group as groups of at most `size`, each with a basis of its own: at
 * high resolution the operators cost more than the batches, and their cost goes with the number of curves. */
static bool refine_apart(refinement *r, const group *g, size_t size, int from) {
    bool ok = true;
    for (size_t first = 0; ok && first < g->active_count; first += size) {
        const size_t left = g->active_count - first, count = left < size ? left : size;
        double *n = malloc(2 * count * sizeof *n);
        size_t *place = malloc(2 * count * sizeof *place);
        lq_conductors materials = {0};
        ok = n && place;
        for (size_t i = 0; ok && i < count; i++) {
            const size_t material = g->active[first + i];
            n[i] = g->materials->n[material];
            n[count + i] = g->materials->kappa[material];
            place[i] = place_of(g, material);
            place[count + i] = i;
        }
        ok = ok && lq_conductors_make(&materials, n, n + count, count, 0.01 * r->tolerance, NULL) == LQ_OK;
        if (ok) {
            group own = {
                .materials = &materials, .active = place + count, .active_count = count, .place = place};
            ok = refine(r, &own, from > 2 && is_divided(r, &own) ? from - 2 : from);
        }
        lq_conductors_free(&materials);
        free(n);
        free(place);
    }
    return ok;
}

/* Raise the level for the active materials of `g`, from levels[from] on. */
static bool refine(refinement *r, group *g, int from) {
    enum { ALONE = 3, LEVEL_OF_CONCERN = 4 };
    for (int i = from; i < LEVELS && g->active_count; i++) {
        if (i >= LEVEL_OF_CONCERN && g->materials->count > 1) {
            if (g->active_count <= ALONE) return refine_apart(r, g, 1, i);
            if (i == LEVELS - 1) return refine_apart(r, g, 1, i - 1);
            if (2 * g->active_count < g->materials->count) return refine_apart(r, g, g->active_count, i);
        }
        if (!solve_level(r, g, is_divided(r, g) ? &divided[i] : &levels[i])) return false;
        if (i > 0) retire(r, g);
    }
    return true;
}

/* Is the critical angle so sharp that it is a kink to any level of many materials? */
static bool is_sharp(double alpha, const lq_conductors *materials, size_t m) {
    static const double SHARP = 0.02;
    const lq_critical at = lq_critical_find(alpha, materials->n[m], materials->kappa[m], false);
    return at.down_count && at.distance < SHARP;
}

/* Sharp materials each alone, and the others together. `active` has room for all. */
static bool refine_all(refinement *r, const lq_conductors *materials, size_t *active) {
    const size_t count = materials->count;
    group smooth = {.materials = materials, .active = active}, sharp = {.materials = materials};
    for (size_t m = 0; m < count; m++)
        if (count == 1 || !is_sharp(r->alpha, materials, m)) active[smooth.active_count++] = m;
    sharp.active = active + smooth.active_count;
    for (size_t m = 0; m < count && count > 1; m++)
        if (is_sharp(r->alpha, materials, m)) sharp.active[sharp.active_count++] = m;
    return refine_apart(r, &sharp, 1, 0) && refine(r, &smooth, 0);
}

/* The limit alpha = 0. At alpha > 0 light at cosines of a few alpha still leaves at such cosines, so that it
 * is off by no more than what those absorb. */
static double smooth_energies(double alpha, const lq_conductors *materials, const double *mu, size_t mu_count,
                              double *energy) {
    double error = 1e-15;
    for (size_t i = 0; i < materials->count; i++) {
        const double n = materials->n[i], kappa = materials->kappa[i];
        for (size_t m = 0; m < mu_count; m++)
            energy[i * mu_count + m] = lq_fresnel_conductor(mu[m], n, kappa);
        if (alpha > 0.0) error = fmax(error, 1.0 - lq_fresnel_conductor(30.0 * alpha, n, kappa));
    }
    return error;
}

static lq_status solve_slice(const lq_ndf *ndf, double alpha, const lq_conductors *materials,
                             const double *mu, size_t mu_count, double tolerance, double *energy,
                             double *estimate, lq_error *error) {
    refinement r = {ndf, alpha, mu, mu_count, 0.0, energy, malloc(materials->count * sizeof(double))};
    /* The representation of the materials takes its share of the tolerance first. */
    r.tolerance = fmax(tolerance - materials->missed, 0.5 * tolerance);
    size_t *active = malloc(materials->count * sizeof *active);
    bool ok = r.change && active;
    for (size_t m = 0; ok && m < materials->count; m++) r.change[m] = -1.0;
    ok = ok && refine_all(&r, materials, active);
    *estimate = materials->missed;
    for (size_t m = 0; ok && m < materials->count; m++)
        *estimate = fmax(*estimate, estimate_of(&r, m) + materials->missed);
    free(active);
    free(r.change);
    return ok ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory to solve %zu materials", materials->count);
}

/* Cosines that are always watched: fewer would let two levels agree by accident. */
enum { PROBES = 10 };

static void place_probes(double alpha, double *mu) {
    const double spread[PROBES] = {0.01, 0.1, 0.3, 1.0, 3.0, 10.0};
    const double fixed[] = {0.15, 0.4, 0.7, 1.0};
    for (int i = 0; i < 6; i++) mu[i] = fmin(spread[i] * alpha, 1.0);
    for (int i = 0; i < 4; i++) mu[6 + i] = fixed[i];
}

/* Few cosines: solve them together with the probes. */
static lq_status solve_with_probes(const lq_ndf *ndf, double alpha, const lq_conductors *materials,
                                   const double *mu, size_t mu_count, double tolerance, double *energy,
                                   double *estimate, lq_error *error) {
    const size_t all = mu_count + PROBES;
    double *cosines = malloc(all * sizeof(double));
    double *energies = malloc(all * materials->count * sizeof(double));
    lq_status status = LQ_NO_MEMORY;
    if (cosines && energies) {
        memcpy(cosines, mu, mu_count * sizeof(double));
        place_probes(alpha, cosines + mu_count);
        status = solve_slice(ndf, alpha, materials, cosines, all, tolerance, energies, estimate, error);
        for (size_t m = 0; m < materials->count; m++)
            memcpy(energy + m * mu_count, energies + m * all, mu_count * sizeof(double));
    } else {
        lq_fail(error, status, "no memory to solve %zu materials", materials->count);
    }
    free(cosines);
    free(energies);
    return status;
}

lq_status lq_conductor_energies(const lq_ndf *ndf, double alpha, const lq_conductors *materials,
                                const double *mu, size_t mu_count, double tolerance, double *energy,
                                double *estimate, lq_error *error) {
    if (alpha < LQ_SMOOTH_ALPHA) {
        *estimate = smooth_energies(alpha, materials, mu, mu_count, energy);
        return LQ_OK;
    }
    return (mu_count < 2 * PROBES ? solve_with_probes : solve_slice)(ndf, alpha, materials, mu, mu_count,
                                                                     tolerance, energy, estimate, error);
}

/* ------------------------------------------------------------------- orders of scattering */

/* What one more hit makes of R: R'_ij = (a_d P_dd R + R a_u P_uu)_ij / (a_d,i + a_u,j). The batch holds the
 * scaled operators; one lane of it is one material. */
static void next_order(const lq_sylvester *s, const double *r, double *next) {
    const int n = s->nodes;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = 0.0;
            for (int k = 0; k < n; k++)
                sum += s->down[i * n + k][0] * r[k * n + j] + r[i * n + k] * s->up[j * n + k][0];
            next[i * n + j] = sum / (s->a_down[i] + s->a_up[j]);
        }
}

/* Energies of one order at the readout's only cosine: its remaining flux times the interpolated share. */
static double read_order(const lq_sylvester *s, const lq_readout *at, const double *r) {
    const int n = s->nodes;
    double remaining = at->remaining[0], share = 0.0;
    for (int k = 1; k < s->curves; k++) remaining -= s->coefficients[k][0] * at->remaining[k];
    for (int i = 0; i < n; i++) {
        double order = 0.0, all = 0.0;
        for (int j = 0; j < n; j++) {
            order += r[i * n + j];
            all += s->down[i * n + j][0] + s->a_up[j] / (s->a_down[i] + s->a_up[j]) * s->source[i * n + j][0];
        }
        if (all > 0.0) share += at->weights[i] * order * s->a_down[i] / all;
    }
    return remaining * share;
}

static bool run_orders(const lq_sylvester *s, const lq_readout *at, size_t orders, double *energies) {
    const size_t n2 = (size_t)s->nodes * (size_t)s->nodes;
    double *r = malloc(n2 * sizeof *r), *next = malloc(n2 * sizeof *next);
    const bool ok = r && next;
    if (ok) {
        energies[0] = at->escaping[0];
        for (int k = 1; k < s->curves; k++) energies[0] -= s->coefficients[k][0] * at->escaping[k];
        for (int i = 0; i < s->nodes; i++)
            for (int j = 0; j < s->nodes; j++)
                r[i * s->nodes + j] = s->source[i * s->nodes + j][0] / (s->a_down[i] + s->a_up[j]);
    }
    for (size_t order = 1; ok && order < orders; order++) {
        next_order(s, r, next);
        energies[order] = fmax(read_order(s, at, next), 0.0);
        double *swap = r;
        r = next;
        next = swap;
    }
    free(r);
    free(next);
    return ok;
}

lq_status lq_conductor_orders(const lq_ndf *ndf, double alpha, const lq_conductors *material, double mu,
                              size_t orders, double *energies, lq_error *error) {
    for (size_t i = 0; i < orders; i++) energies[i] = 0.0;
    if (orders == 0) return LQ_OK;
    if (alpha < LQ_SMOOTH_ALPHA) {
        smooth_energies(alpha, material, &mu, 1, energies);
        return LQ_OK;
    }
    const level l = levels[5];
    const size_t only = 0;
    operators o;
    readout read;
    batch b;
    bool ok = operators_make(&o, ndf, alpha, &material->curves, &l, &(lq_critical){.distance = INFINITY});
    if (ok) {
        ok = readout_make(&read, &o, ndf, alpha, &material->curves, &l, &mu, 1);
        if (ok && (ok = batch_make(&b, &o, 1))) {
            batch_load(&b, material, &only, 1);
            lq_solver_kernels_get()->assemble(&b.s);
            ok = run_orders(&b.s, &read.at, orders, energies);
            batch_free(&b);
        }
        readout_free(&read);
        operators_free(&o);
    }
    return ok ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu orders of scattering", orders);
}

/* ------------------------------------------------------------------------------ materials */

lq_status lq_conductors_make(lq_conductors *materials, const double *n, const double *kappa, size_t count,
                             double accuracy, lq_error *error) {
    *materials = (lq_conductors){.count = count, .n = n, .kappa = kappa};
    double *wide = malloc(count * LQ_CURVES_MAX * sizeof(double));
    if (!wide) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", count);
    lq_status status =
        lq_curves_basis(&materials->curves, n, kappa, count, accuracy, wide, &materials->missed, error);
    if (status == LQ_OK) {
        const size_t curves = (size_t)materials->curves.count;
        for (size_t m = 0; m < count; m++)
            memmove(wide + m * curves, wide + m * LQ_CURVES_MAX, curves * sizeof(double));
        double *tight = realloc(wide, count * curves * sizeof(double));
        materials->coefficients = tight ? tight : wide;
    } else {
        free(wide);
    }
    return status;
}

void lq_conductors_free(lq_conductors *materials) {
    free(materials->coefficients);
    materials->coefficients = NULL;
}
