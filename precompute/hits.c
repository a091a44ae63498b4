/* Passes while they settle, a Krylov space where they do not. */
#include "precompute/hits.h"

#include "precompute/krylov.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t half_of(const lq_rough_level *level) {
    return (size_t)level->depths.count * 2 * (size_t)level->axis.count;
}

bool lq_hits_values_make(lq_hits_values *x, const lq_rough_level *level) {
    const size_t size = half_of(level);
    lq_v8 *all = (lq_v8 *)(void *)lq_zeros((4 * size + 2 * (size_t)level->axis.count) * LQ_LANES);
    *x = (lq_hits_values){.reward = all + 4 * size};
    for (int s = 0; s < 2; s++) {
        x->value[s] = all + (size_t)s * size;
        x->before[s] = all + (size_t)(2 + s) * size;
    }
    return all;
}

void lq_hits_values_free(lq_hits_values *x) {
    free(x->value[0]);
}

/* A system to solve: the eight rewards of x as they are, or a single one with its depths packed into the
 * lanes (travel_packed of kernels.h). */
typedef struct passes {
    const lq_hits *f;
    lq_hits_values x;
    lq_v8 *mirrored[2]; /* NULL: not packed */
} passes;

static int blocks_of(const passes *p) {
    const int depths = p->f->level->depths.count;
    return p->mirrored[0] ? (depths + LQ_LANES - 1) / LQ_LANES : depths;
}

/* Of one side. */
static size_t size_of(const passes *p) {
    return (size_t)blocks_of(p) * 2 * (size_t)p->f->level->axis.count;
}

static lq_two_sided kernel_of(const passes *p, int s) {
    const lq_rough_level *level = p->f->level;
    return (lq_two_sided){.nodes = level->axis.count,
                          .depths = level->depths.count,
                          .fall = p->f->fall[s],
                          .rise = p->f->rise[s],
                          .travel_down = level->travel_down,
                          .travel_up = level->travel_up,
                          .own = p->x.value[s],
                          .other = p->mirrored[0] ? p->mirrored[1 - s] : p->x.value[1 - s],
                          .before = p->x.before[s],
                          .reward = p->x.reward + s * level->axis.count,
                          .mirrored = p->mirrored[s]};
}

/* Every pass adds a hit. A few dozen do where the media differ; after that a Krylov space is the shorter way.
 */
enum { PASSES = 60, PRODUCTS = 1200 };

/* Residuals add up over as many facets as light meets. */
static const double RESIDUAL = 1e-9;

/* E of both sides from C. Returns the largest change. */
static double travel(const passes *p) {
    const lq_solver_kernels *kernels = lq_solver_kernels_get();
    double change = 0.0;
    for (int s = 0; s < p->f->sides; s++) {
        const lq_two_sided k = kernel_of(p, s);
        change =
            fmax(change, (k.mirrored ? kernels->travel_packed : kernels->travel)(&k, p->f->level->survival));
    }
    return change;
}

/* C of both sides from E. */
static void meet(const passes *p) {
    for (int s = 0; s < p->f->sides; s++) {
        lq_two_sided k = kernel_of(p, s);
        k.depths = blocks_of(p);
        lq_solver_kernels_get()->meet(&k);
    }
}

/* What a hit is worth besides what meets the next one. */
static void add_source(const passes *p, lq_v8 *before) {
    for (size_t q = 0; p->x.source && q < 2 * size_of(p); q++) before[q] += p->x.source[q];
}

static bool is_energy(const passes *p) {
    for (size_t q = 0; q < size_of(p); q++)
        if (!(fabs(p->x.value[0][q][0]) < 10.0 && fabs(p->x.value[1][q][0]) < 10.0))
            return false; /* NaN too */
    return true;
}

static bool solve_by_passes(const passes *p, double settled) {
    double change = 1.0, left = 1.0;
    for (int pass = 0; pass < PASSES && left > settled && change < 10.0; pass++) {
        const double before = change;
        change = travel(p);
        meet(p);
        add_source(p, p->x.before[0]);
        /* The changes fall like a geometric series: what all the later ones would add. */
        left = change < before ? change * fmax(change / (before - change), 1.0) : 1.0;
    }
    return left <= settled && is_energy(p);
}

/* One pass without the reward, from a C to another: what the Krylov space is made of. */
static void pass_unpaid(void *user, const lq_v8 *before, lq_v8 *after) {
    passes *p = user;
    const size_t size = size_of(p);
    memcpy(after, before, 2 * size * sizeof *after);
    for (int s = 0; s < 2; s++) p->x.before[s] = after + (size_t)s * size;
    travel(p);
    meet(p);
}

/* C of the light that has met one facet is the right side. False where that does not settle either: rays that
 * graze a fine level meet hundreds of facets, and its interpolation can overshoot by enough to matter then. A
 * coarser level holds. */
static bool solve_by_krylov(const passes *p) {
    const size_t size = size_of(p);
    lq_v8 *right = (lq_v8 *)(void *)lq_zeros((2 * size + (size_t)(2 * p->f->level->axis.count)) * LQ_LANES);
    if (!right) return false;
    passes unpaid = *p, first = *p;
    unpaid.x.reward = right + 2 * size;
    memset(p->x.before[0], 0, 2 * size * sizeof(lq_v8));
    travel(p);
    for (int s = 0; s < 2; s++) first.x.before[s] = right + (size_t)s * size;
    meet(&first);
    add_source(p, right);
    const double left = lq_krylov_solve(pass_unpaid, &unpaid, 2 * size, p->mirrored[0], right, p->x.before[0],
                                        PRODUCTS, RESIDUAL);
    travel(p);
    free(right);
    return left >= 0.0 && left <= 10.0 * RESIDUAL && is_energy(p);
}

static bool solve(const passes *p, double settled) {
    memset(p->x.before[0], 0, 2 * size_of(p) * sizeof(lq_v8));
    add_source(p, p->x.before[0]);
    return solve_by_passes(p, settled) || solve_by_krylov(p);
}

bool lq_hits_solve(const lq_hits *f, lq_hits_values *x, double settled) {
    const passes p = {f, *x, {NULL, NULL}};
    return solve(&p, settled);
}

/* More rewards than this are quicker side by side. */
enum { FEW = 3 };

/* Six arrays of half a packed system each, and rewards; false without memory. */
static bool packed_make(passes *p, const lq_hits *f) {
    const size_t nodes = (size_t)f->level->axis.count;
    const size_t blocks = ((size_t)f->level->depths.count + LQ_LANES - 1) / LQ_LANES,
                 size = blocks * 2 * nodes;
    lq_v8 *all = (lq_v8 *)(void *)lq_zeros((6 * size + 2 * nodes) * LQ_LANES);
    *p = (passes){.f = f, .x.reward = all + 6 * size};
    for (int s = 0; s < 2; s++) {
        p->x.value[s] = all + (size_t)s * size;
        p->x.before[s] = all + (size_t)(2 + s) * size;
        p->mirrored[s] = all + (size_t)(4 + s) * size;
    }
    return all;
}

static void unpack(const passes *p, const lq_v8 *packed, size_t lane, lq_v8 *out) {
    const size_t step = 2 * (size_t)p->f->level->axis.count, depths = (size_t)p->f->level->depths.count;
    for (size_t k = 0; k < depths; k++)
        for (size_t q = 0; q < step; q++)
            out[k * step + q][lane] = packed[k / LQ_LANES * step + q][k % LQ_LANES];
}

static bool solve_packed(passes *p, lq_hits_values *x, size_t lane, double settled) {
    const size_t nodes = (size_t)p->f->level->axis.count;
    memset(p->x.value[0], 0, 6 * size_of(p) * sizeof(lq_v8));
    for (size_t j = 0; j < 2 * nodes; j++) p->x.reward[j][0] = x->reward[j][lane];
    const bool settles = solve(p, settled);
    for (int s = 0; s < p->f->sides; s++) {
        unpack(p, p->x.value[s], lane, x->value[s]);
        unpack(p, p->x.before[s], lane, x->before[s]);
    }
    return settles;
}

bool lq_hits_solve_lanes(const lq_hits *f, lq_hits_values *x, size_t lanes, double settled) {
    passes p;
    if (lanes > FEW || !packed_make(&p, f)) return lq_hits_solve(f, x, settled);
    bool settles = true;
    for (size_t l = 0; settles && l < lanes; l++) settles = solve_packed(&p, x, l, settled);
    free(p.x.value[0]);
    return settles;
}
