/* surface.c - the stages of one surface: facet rows, rewards in batches, blocks. */
#include "stack/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "microfacet/fresnel.h"
#include "precompute/curves.h"
#include "precompute/first_bounce.h"
#include "precompute/hits.h"
#include "stack/facet_sums.h"
#include "system/status.h"

/* What is kept of one direction of arrival, [material][mode] of each: light that leaves at once, on the axes
 * of both media; what stays of the light that rises on its own side, what falls there, and what falls on the
 * other side, on the nodes of the level; and what stays of the light that rises on the other side, where it
 * meets its second facet: [mode][depth * nodes + j]. */
typedef struct entry_rows {
    double *arrival; /* [depths]: where the first facet is met, and the next */
    double *leaving, *staying, *refracted;
    double *worth; /* of a reward at each node of both axes, once the batches are solved */
} entry_rows;

struct lq_surface_work {
    lq_surface spec;
    lq_rough_level *level; /* NULL: known in closed form */
    int nodes, depths, sides;
    double settled;
    size_t columns; /* rewards: nodes of the axes of both media */
    lq_panels kinks[2];
    double *memory;
    double *fall[2], *rise[2]; /* [(material * LQ_MODES + mode) * nodes + i][4 nodes] */
    /* What a hit sends to the axes of both media, own side first: [material and mode][rising i, then falling
     * i] [columns]; and how much of it leaves from depth k, [k * axis + a]. */
    double *out[2], *survival[2];
    /* What that is scaled by, so that with what the nodes keep it is all that the hit sends there: [(material
     * * 2 + (own side, other side)) * depths + k][rising i, then falling i]. */
    double *balance[2];
    entry_rows entry[2];
};

/* ======================================================================================
 *                                        Memory
 * ====================================================================================== */

static size_t axis_count(const lq_surface *s, int side) {
    return s->axis[side] ? (size_t)s->axis[side]->count : 0;
}

static size_t leaving_size(const lq_surface_work *w) {
    return axis_count(&w->spec, 0) + axis_count(&w->spec, 1);
}

static size_t variants(const lq_surface_work *w) {
    return (size_t)w->spec.materials * LQ_MODES;
}

/* Doubles that an array of `count` takes from the memory at *at; NULL stands for memory that is only counted.
 */
static double *take(double *memory, size_t *at, size_t count) {
    double *taken = memory ? memory + *at : NULL;
    *at += (count + LQ_LANES - 1) / LQ_LANES * LQ_LANES;
    return taken;
}

static size_t place_arrays(lq_surface_work *w) {
    const size_t n = (size_t)w->nodes, depths = (size_t)w->depths, each = variants(w);
    size_t at = 0;
    for (int s = 0; s < w->sides; s++) {
        const size_t rows = w->spec.entry_count[s];
        entry_rows *e = &w->entry[s];
        w->fall[s] = take(w->memory, &at, each * n * 4 * n);
        w->rise[s] = take(w->memory, &at, each * n * 4 * n);
        w->out[s] = take(w->memory, &at, each * 2 * n * w->columns);
        w->survival[s] = take(w->memory, &at, depths * axis_count(&w->spec, s));
        w->balance[s] = take(w->memory, &at, (size_t)w->spec.materials * 2 * depths * 2 * n);
        e->arrival = take(w->memory, &at, rows * depths);
        e->leaving = take(w->memory, &at, rows * each * leaving_size(w));
        e->staying = take(w->memory, &at, rows * each * 3 * n);
        e->refracted = take(w->memory, &at, w->sides == 2 ? rows * LQ_MODES * depths * n : 0);
        e->worth = take(w->memory, &at, rows * each * w->columns);
    }
    return at;
}

/* Is the block known in closed form? */
static bool is_closed(const lq_surface *s) {
    return s->diffuse || s->alpha < LQ_SMOOTH_ALPHA || (!s->opaque && fabs(s->eta - 1.0) < LQ_MATCHED);
}

static void make_kinks(lq_surface_work *w) {
    const lq_surface *s = &w->spec;
    if (s->opaque) {
        lq_fresnel_panels(&w->kinks[0], s->n, s->kappa, s->materials);
        return;
    }
    for (int side = 0; side < 2; side++) {
        const double eta = side == 0 ? s->eta : 1.0 / s->eta;
        lq_panels_start(&w->kinks[side], 0.0, 1.5707963267948966);
        if (eta < 1.0) lq_panels_add(&w->kinks[side], asin(eta), true);
    }
}

/* No two levels share a resolution that could be what limits both. */
static const lq_resolution resolutions[LQ_SURFACE_LEVELS + 1] = {
    {8, 16, 9, 14},   {12, 20, 10, 16}, {16, 24, 12, 20}, {20, 28, 16, 24},
    {28, 32, 20, 30}, {40, 36, 26, 36}, {56, 40, 36, 46}, {84, 44, 52, 60}};

/* Light along the horizon: it starts a millionth from the end of the depths and at nodes as far down, with
 * powers that are not smooth there, and errors go as depths^-4. */
static const lq_resolution grazing[LQ_SURFACE_LEVELS + 1] = {
    {20, 32, 10, 14}, {23, 40, 12, 18}, {30, 44, 16, 24}, {36, 48, 20, 30},
    {44, 56, 26, 36}, {56, 64, 32, 42}, {66, 72, 40, 50}, {84, 80, 52, 60}};

enum { FEWEST_NODES = 8, SPLITS_MAX = 3 };

/* Splits closer than this to each other or to an end are left out: their element would have nodes for
 * nothing. */
static const double SPLITS_APART = 0.02;

static void add_split(lq_level_splits *splits, double at) {
    int i = 0;
    if (at < SPLITS_APART || at > 1.0 - SPLITS_APART || splits->count == SPLITS_MAX) return;
    while (i < splits->count && splits->at[i] < at) i++;
    if (i < splits->count && splits->at[i] - at < SPLITS_APART) return;
    if (i > 0 && at - splits->at[i - 1] < SPLITS_APART) return;
    for (int k = splits->count++; k > i; k--) splits->at[k] = splits->at[k - 1];
    splits->at[i] = at;
}

/* Where the node axis is divided: where other interfaces make steps, and in the denser medium, where what
 * falls on the facets turns at the critical angle, cos = sqrt(1 - eta^2), within a width alpha, and what
 * rises meets no facet below that angle from cos = eta on, where the cone touches the horizon. Divided there,
 * 20 nodes do what 32 do undivided. */
static lq_level_splits splits_of(const lq_surface *s) {
    const double eta = fmin(s->eta, 1.0 / s->eta);
    lq_level_splits splits = {0};
    for (int side = 0; side < (s->opaque ? 1 : 2); side++)
        for (int i = 0; i < s->sharp[side].count; i++) add_split(&splits, s->sharp[side].cosine[i]);
    if (!s->opaque && eta < 0.9) add_split(&splits, s->alpha < 0.3 ? sqrt((1.0 - eta) * (1.0 + eta)) : eta);
    return splits;
}

static lq_resolution resolution_of(const lq_surface *s, int level) {
    return (s->grazing ? grazing : resolutions)[level - LQ_LEVEL_TRIAL];
}

/* Nodes of one element: of the length of the axis, which is logarithmic down to alpha, and more at every
 * level even where many elements share few; all nodes together are a multiple of four. */
static int nodes_each(const lq_surface *s, int level, int elements) {
    static const int step[4] = {1, 4, 2, 4};
    const int unit = step[elements % 4], grows = unit > 2 ? unit : 2;
    const double length = 1.0 + 0.15 * log(1.0 / s->alpha);
    const int share = (int)(resolution_of(s, level).nodes * length) / elements,
              fewest = FEWEST_NODES + grows * (level - LQ_LEVEL_TRIAL);
    return ((share > fewest ? share : fewest) + unit - 1) / unit * unit;
}

static lq_rough_level *make_level(const lq_surface *s, int level) {
    const lq_level_splits splits = splits_of(s);
    lq_resolution r = resolution_of(s, level);
    r.nodes = nodes_each(s, level, splits.count + 1);
    return lq_rough_level_make(s->ndf, s->alpha, s->opaque ? 0.0 : s->eta, &r, &splits);
}

static void fill_survival(lq_surface_work *w) {
    for (int s = 0; s < w->sides; s++) {
        const lq_node_axis *axis = w->spec.axis[s];
        for (int a = 0; a < axis->count; a++) {
            const double lambda = lq_lambda(w->spec.ndf, w->spec.alpha, axis->mu[a]);
            for (int k = 0; k < w->depths; k++)
                w->survival[s][k * axis->count + a] = lq_survival(lambda, w->level->depths.u[k]);
        }
    }
}

/* What the passes that are not made may add up to, for one of some hundred rewards: a thousandth of what the
 * coarsest levels reach. The rows of a dielectric are scaled to all light afterwards. */
static double settled_at(const lq_surface *s, int level) {
    return s->opaque ? 1e-12 : level <= 0 ? 1e-8 : 1e-9;
}

static bool allocate(lq_surface_work *w, int level) {
    const lq_surface *s = &w->spec;
    w->sides = s->opaque ? 1 : 2;
    w->settled = settled_at(s, level);
    if (is_closed(s)) return true;
    w->level = make_level(s, level);
    if (!w->level) return false;
    w->nodes = w->level->axis.count;
    w->depths = w->level->depths.count;
    w->columns = leaving_size(w);
    make_kinks(w);
    w->memory = lq_zeros(place_arrays(w));
    if (w->memory) place_arrays(w);
    if (w->memory) fill_survival(w);
    return w->memory;
}

lq_status lq_surface_begin(lq_surface_work **work, const lq_surface *surface, int level, lq_error *error) {
    lq_surface_work *w = calloc(1, sizeof *w);
    *work = w;
    if (w) {
        w->spec = *surface;
        if (allocate(w, level)) return LQ_OK;
    }
    lq_surface_end(w);
    *work = NULL;
    return lq_fail(error, LQ_NO_MEMORY, "no memory to solve an interface at level %d", level);
}

void lq_surface_end(lq_surface_work *w) {
    if (!w) return;
    lq_rough_level_free(w->level);
    free(w->memory);
    free(w);
}

/* ======================================================================================
 *                                         Rows
 * ====================================================================================== */

static lq_facet_sums sums_of(const lq_surface_work *w, int side, double v_z) {
    const lq_surface *s = &w->spec;
    return (lq_facet_sums){.ndf = s->ndf,
                           .alpha = s->alpha,
                           .eta = s->opaque   ? 0.0
                                  : side == 0 ? s->eta
                                              : 1.0 / s->eta,
                           .materials = s->materials,
                           .n = s->n,
                           .kappa = s->kappa,
                           .v_z = v_z,
                           .rule = &w->level->rule,
                           .kinks = &w->kinks[side],
                           .nodes = &w->level->axis,
                           .leaving = {s->axis[side], s->axis[1 - side]},
                           .cuts = {&s->sharp[side], &s->sharp[1 - side]}};
}

/* Nodes and axis do not agree to rounding on what leaves unhindered; travel between hits goes by the nodes.
 */
static void balance_row(lq_surface_work *w, int side, int material, size_t q) {
    const size_t n = (size_t)w->nodes, depths = (size_t)w->depths, v = (size_t)material * LQ_MODES;
    const double *row = q < n ? w->rise[side] + (v * n + q) * 4 * n : w->fall[side] + (v * n + q - n) * 4 * n;
    const double *out = w->out[side] + (v * 2 * n + q) * w->columns;
    for (int way = 0; way < w->sides; way++) {
        const int to = way == 0 ? side : 1 - side;
        const size_t axis = axis_count(&w->spec, to);
        for (size_t k = 0; k < depths; k++) {
            double by_nodes = 0.0, by_axis = 0.0;
            for (size_t j = 0; j < n; j++)
                by_nodes += row[(size_t)(2 * way) * n + j] * w->level->survival[k * n + j];
            for (size_t a = 0; a < axis; a++) by_axis += out[a] * w->survival[to][k * axis + a];
            w->balance[side][(((size_t)material * 2 + (size_t)way) * depths + k) * 2 * n + q] =
                by_axis > 1e-9 ? by_nodes / by_axis : 1.0;
        }
        out += axis;
    }
}

/* The row of one node of the level, rising (v below the horizon) or falling. */
static lq_status node_row(lq_surface_work *w, int side, bool rising, int node, lq_error *error) {
    const size_t n = (size_t)w->nodes;
    const double mu = w->level->axis.mu[node];
    lq_facet_sums f = sums_of(w, side, rising ? -mu : mu);
    const lq_status status = lq_facet_sums_make(&f, error);
    if (status != LQ_OK) return status;
    for (size_t v = 0; v < variants(w); v++) {
        double *row = (rising ? w->rise[side] : w->fall[side]) + (v * n + (size_t)node) * 4 * n;
        for (int part = 0; part < (w->sides == 2 ? 4 : 2); part++)
            lq_facet_sums_project(&f, LQ_PART_RISES + part, v, row + (size_t)part * n);
        double *out = w->out[side] + ((v * 2 + (rising ? 0 : 1)) * n + (size_t)node) * w->columns;
        lq_facet_sums_project(&f, LQ_PART_ESCAPES, v, out);
        if (w->sides == 2) lq_facet_sums_project(&f, LQ_PART_PASSES, v, out + axis_count(&w->spec, side));
    }
    lq_facet_sums_free(&f);
    for (int m = 0; m < w->spec.materials; m++)
        balance_row(w, side, m, (size_t)node + (rising ? 0 : (size_t)w->nodes));
    return LQ_OK;
}

static double total_of(const double *values, size_t count) {
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += values[i];
    return sum;
}

/* Light refracted at the first facet: what leaves at once, masked at the nodes of the axis, and where the
 * rest meets its next facet. The nodes' own masking sums to something else; it is scaled to what the axis
 * leaves. */
static lq_status refracted_rows(lq_surface_work *w, int side, size_t row, double lambda_i,
                                const lq_facet_sums *f, lq_error *error) {
    const lq_surface *s = &w->spec;
    const lq_node_axis *other = s->axis[1 - side];
    const size_t n = (size_t)w->nodes, size = n * (size_t)w->depths, own = axis_count(s, side);
    double *hits = malloc((size + n) * sizeof *hits), scale = 1.0;
    if (!hits) return lq_fail(error, LQ_NO_MEMORY, "no memory for a row of an interface");
    double *light = hits + size;
    lq_rough_level_refracted(w->level, lambda_i, hits);
    for (size_t v = 0; v < LQ_MODES; v++) {
        double *leaving = w->entry[side].leaving + (row * LQ_MODES + v) * leaving_size(w) + own;
        double *refracted = w->entry[side].refracted + (row * LQ_MODES + v) * size;
        for (int j = 0; j < other->count; j++)
            leaving[j] *= lq_refracted_escape(lambda_i, lq_lambda(s->ndf, s->alpha, other->mu[j]));
        lq_facet_sums_project(f, LQ_PART_CROSSES, v, light);
        for (size_t i = 0; i < size; i++) refracted[i] = hits[i] * light[i % n];
        if (v == 0) {
            const double stays = total_of(light, n) - total_of(leaving, (size_t)other->count);
            const double by_nodes = total_of(refracted, size);
            scale = by_nodes > 1e-4 ? fmax(fmin(stays / by_nodes, 2.0), 0.0) : 1.0;
        }
        for (size_t i = 0; i < size; i++) refracted[i] *= scale;
    }
    free(hits);
    return LQ_OK;
}

/* The row of light that arrives from outside. */
static lq_status entry_row(lq_surface_work *w, int side, size_t row, lq_error *error) {
    const lq_surface *s = &w->spec;
    const size_t n = (size_t)w->nodes, own = axis_count(s, side);
    const double mu = fmax(s->entry[side][row], LQ_GRAZING), lambda_i = lq_lambda(s->ndf, s->alpha, mu);
    lq_facet_sums f = sums_of(w, side, mu);
    f.masked = true;
    lq_status status = lq_facet_sums_make(&f, error);
    if (status != LQ_OK) return status;
    lq_arrival(&w->level->depths, lambda_i, w->entry[side].arrival + row * (size_t)w->depths);
    for (size_t v = 0; v < variants(w); v++) {
        double *leaving = w->entry[side].leaving + (row * variants(w) + v) * leaving_size(w);
        double *staying = w->entry[side].staying + (row * variants(w) + v) * 3 * n;
        lq_facet_sums_project(&f, LQ_PART_ESCAPES, v, leaving);
        lq_facet_sums_project(&f, LQ_PART_RISES, v, staying);
        lq_facet_sums_project(&f, LQ_PART_FALLS, v, staying + n);
        if (w->sides == 1) continue;
        lq_facet_sums_project(&f, LQ_PART_PASSES, v, leaving + own);
        lq_facet_sums_project(&f, LQ_PART_CROSSES_FALLING, v, staying + 2 * n);
    }
    if (w->sides == 2) status = refracted_rows(w, side, row, lambda_i, &f, error);
    lq_facet_sums_free(&f);
    return status;
}

static size_t node_rows(const lq_surface_work *w) {
    return w->level && w->spec.scattering == LQ_MULTIPLE ? (size_t)(2 * w->sides * w->nodes) : 0;
}

size_t lq_surface_rows(const lq_surface_work *w) {
    return w->level ? node_rows(w) + w->spec.entry_count[0] + w->spec.entry_count[1] : 0;
}

lq_status lq_surface_row(lq_surface_work *w, size_t row, lq_error *error) {
    if (row < node_rows(w)) {
        const int node = (int)(row % (size_t)w->nodes), which = (int)(row / (size_t)w->nodes);
        return node_row(w, which / 2, which % 2, node, error);
    }
    row -= node_rows(w);
    const int side = row >= w->spec.entry_count[0];
    return entry_row(w, side, side ? row - w->spec.entry_count[0] : row, error);
}

/* ======================================================================================
 *                                        Batches
 * ====================================================================================== */

static size_t batches_of_one(const lq_surface_work *w) {
    return (w->columns + LQ_LANES - 1) / LQ_LANES;
}

size_t lq_surface_batches(const lq_surface_work *w) {
    return node_rows(w) ? variants(w) * batches_of_one(w) : 0;
}

/* What light of one entry that stays is worth at the lanes of x. */
static void read_entry(const lq_surface_work *w, int side, size_t row, size_t v, const lq_hits_values *x,
                       lq_v8 *sum) {
    const lq_solver_kernels *kernels = lq_solver_kernels_get();
    const int n = w->nodes, depths = w->depths;
    const entry_rows *e = &w->entry[side];
    const double *arrival = e->arrival + row * (size_t)depths;
    const double *staying = e->staying + (row * variants(w) + v) * 3 * (size_t)n;
    lq_v8 refracted;
    memset(sum, 0, sizeof *sum);
    kernels->arrive(depths, n, arrival, false, staying, x->before[side], sum);
    kernels->arrive(depths, n, arrival, false, staying + n, x->value[side] + n, sum);
    if (w->sides == 1) return;
    kernels->arrive(depths, n, arrival, true, staying + 2 * n, x->value[1 - side] + n, sum);
    kernels->contract(depths, n, e->refracted + (row * LQ_MODES + v) * (size_t)(n * depths),
                      x->before[1 - side], &refracted);
    *sum += refracted;
}

static void read_batch(lq_surface_work *w, size_t v, size_t first, const lq_hits_values *x) {
    const size_t left = w->columns - first, lanes = left < LQ_LANES ? left : LQ_LANES;
    for (int side = 0; side < w->sides; side++)
        for (size_t row = 0; row < w->spec.entry_count[side]; row++) {
            lq_v8 worth;
            read_entry(w, side, row, v, x, &worth);
            double *to = w->entry[side].worth + (row * variants(w) + v) * w->columns + first;
            for (size_t l = 0; l < lanes; l++) to[l] = worth[l];
        }
}

/* What a hit at each depth and node of both sides sends out at once, for the reward of 1 at one node of an
 * axis. */
static void load_source(const lq_surface_work *w, size_t v, size_t column, size_t lane, lq_v8 *source) {
    const size_t n = (size_t)w->nodes, depths = (size_t)w->depths, above = axis_count(&w->spec, 0);
    const int paid = column >= above;
    const size_t node = paid ? column - above : column, axis = axis_count(&w->spec, paid);
    for (int s = 0; s < w->sides; s++) {
        const size_t own = axis_count(&w->spec, s);
        const double *out = w->out[s] + v * 2 * n * w->columns + (paid == s ? node : own + node);
        for (size_t k = 0; k < depths; k++) {
            const size_t depth = paid == s ? k : depths - 1 - k;
            const double leaves = w->survival[paid][depth * axis + node];
            const size_t way = (v / LQ_MODES) * 2 + (paid == s ? 0 : 1);
            const double *balance = w->balance[s] + (way * depths + depth) * 2 * n;
            lq_v8 *to = source + ((size_t)s * depths + k) * 2 * n;
            for (size_t q = 0; q < 2 * n; q++) to[q][lane] = balance[q] * leaves * out[q * w->columns];
        }
    }
}

lq_status lq_surface_batch(lq_surface_work *w, size_t batch, lq_error *error) {
    const size_t v = batch / batches_of_one(w), first = batch % batches_of_one(w) * LQ_LANES;
    const size_t n = (size_t)w->nodes, rows = v * n * 4 * n;
    lq_hits hits = {.level = w->level, .sides = w->sides};
    lq_hits_values x;
    const size_t size = 4 * n * (size_t)w->depths;
    lq_v8 *source = (lq_v8 *)(void *)lq_zeros(size * LQ_LANES);
    if (!source || !lq_hits_values_make(&x, w->level)) {
        free(source);
        return lq_fail(error, LQ_NO_MEMORY, "no memory for the rewards of an interface");
    }
    x.source = source;
    for (int s = 0; s < w->sides; s++) {
        hits.fall[s] = w->fall[s] + rows;
        hits.rise[s] = w->rise[s] + rows;
    }
    for (size_t l = 0; l < LQ_LANES && first + l < w->columns; l++) load_source(w, v, first + l, l, source);
    const bool settled = lq_hits_solve(&hits, &x, w->settled);
    if (settled) read_batch(w, v, first, &x);
    lq_hits_values_free(&x);
    free(source);
    return settled ? LQ_OK
                   : lq_fail(error, LQ_NOT_CONVERGED, "the iteration at %d cosines did not settle", w->nodes);
}

/* ======================================================================================
 *                                        Blocks
 * ====================================================================================== */

/* What the worths of a dielectric's row are scaled by, so that with the light that leaves at once they count
 * all of it. */
static double worth_scale(const lq_surface_work *w, int side, size_t row, int material) {
    const size_t v = (size_t)material * LQ_MODES, at = row * variants(w) + v;
    if (w->sides == 1 || w->spec.scattering == LQ_SINGLE) return 1.0;
    const double leaves = total_of(w->entry[side].leaving + at * leaving_size(w), leaving_size(w));
    const double worth = total_of(w->entry[side].worth + at * w->columns, w->columns);
    return worth > 1e-12 ? (1.0 - leaves) / worth : 1.0;
}

/* One row of a block: what leaves at once, and what the rest is worth. */
static void fill_row(const lq_surface_work *w, int side, size_t row, size_t v, double scale,
                     lq_block *block) {
    const size_t at = row * variants(w) + v, own = axis_count(&w->spec, side),
                 above = axis_count(&w->spec, 0);
    const double *leaving = w->entry[side].leaving + at * leaving_size(w);
    const double *worth = w->entry[side].worth + at * w->columns;
    for (int way = 0; way < w->sides; way++) {
        const int out = way == 0 ? side : 1 - side;
        const size_t count = axis_count(&w->spec, out);
        double *to = (way == 0 ? block->r[side] : block->t[side]) + row * count;
        for (size_t a = 0; a < count; a++)
            to[a] = leaving[(way == 0 ? 0 : own) + a] + scale * worth[(out == 0 ? 0 : above) + a];
    }
}

static void fill_rough(const lq_surface_work *w, int material, lq_block *blocks) {
    for (int side = 0; side < w->sides; side++)
        for (size_t row = 0; row < w->spec.entry_count[side]; row++) {
            const double scale = worth_scale(w, side, row, material);
            for (size_t mode = 0; mode < LQ_MODES; mode++)
                fill_row(w, side, row, (size_t)material * LQ_MODES + mode, scale, &blocks[mode]);
        }
}

/* A mirror turns nothing; refraction keeps the tangential part of a direction but for the index. */
static void fill_smooth(const lq_surface *s, int material, lq_block *blocks) {
    for (int side = 0; side < (s->opaque ? 1 : 2); side++)
        for (size_t row = 0; row < s->entry_count[side]; row++) {
            const double mu = s->entry[side][row], eta = side == 0 ? s->eta : 1.0 / s->eta;
            double cos_t = 0.0, weights[LQ_NODES_MAX];
            const double f = s->opaque ? lq_fresnel_conductor(mu, s->n[material], s->kappa[material])
                                       : lq_fresnel_dielectric(mu, eta, &cos_t);
            lq_node_axis_weights(s->axis[side], mu, weights);
            for (size_t j = 0; j < axis_count(s, side); j++)
                for (int mode = 0; mode < LQ_MODES; mode++)
                    blocks[mode].r[side][row * axis_count(s, side) + j] = f * weights[j];
            if (s->opaque) continue;
            const size_t count = axis_count(s, 1 - side);
            lq_node_axis_weights(s->axis[1 - side], cos_t, weights);
            for (size_t j = 0; j < count; j++)
                for (int mode = 0; mode < LQ_MODES; mode++)
                    blocks[mode].t[side][row * count + j] = (1.0 - f) * weights[j] / (mode == 1 ? eta : 1.0);
        }
}

/* What arrives anywhere leaves cosine-weighted, its azimuth forgotten. */
static void fill_diffuse(const lq_surface *s, int material, lq_block *blocks) {
    const size_t count = axis_count(s, 0);
    double mean[LQ_NODES_MAX];
    lq_node_axis_cosine_mean(s->axis[0], mean);
    for (size_t i = 0; i < s->entry_count[0] * count; i++)
        blocks[0].r[0][i] = s->rho[material] * mean[i % count];
}

static lq_status make_blocks(const lq_surface *s, lq_block *blocks, lq_error *error) {
    bool ok = true;
    for (int mode = 0; mode < LQ_MODES; mode++)
        ok &= lq_block_make(&blocks[mode], s->entry_count[0], s->entry_count[1], axis_count(s, 0),
                            axis_count(s, 1));
    return ok ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for the block of an interface");
}

lq_status lq_surface_blocks(const lq_surface_work *w, int material, lq_block blocks[LQ_MODES],
                            lq_error *error) {
    memset(blocks, 0, LQ_MODES * sizeof *blocks);
    lq_status status = make_blocks(&w->spec, blocks, error);
    if (status == LQ_OK && w->level) fill_rough(w, material, blocks);
    else if (status == LQ_OK && w->spec.diffuse) fill_diffuse(&w->spec, material, blocks);
    else if (status == LQ_OK) fill_smooth(&w->spec, material, blocks);
    for (int mode = 0; status != LQ_OK && mode < LQ_MODES; mode++) lq_block_free(&blocks[mode]);
    return status;
}
