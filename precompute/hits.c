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

static lq_two_sided kernel_of(const lq_hits *f, const lq_hits_values *x, int s) {
    return (lq_two_sided){.nodes = f->level->axis.count,
                          .depths = f->level->depths.count,
                          .fall = f->fall[s],
                          .rise = f->rise[s],
                          .travel_down = f->level->travel_down,
                          .travel_up = f->level->travel_up,
                          .own = x->value[s],
                          .other = x->value[1 - s],
                          .before = x->before[s],
                          .reward = x->reward + s * f->level->axis.count};
}

/* Every pass adds a hit. A few dozen do where the media differ; after that a Krylov space is the shorter way.
 */
enum { PASSES = 60, PRODUCTS = 1200 };

/* Residuals add up over as many facets as light meets. */
static const double RESIDUAL = 1e-9;

static size_t half_size(const lq_hits *f) {
    return half_of(f->level);
}

/* E of both sides from C. Returns the largest change. */
static double travel(const lq_hits *f, const lq_hits_values *x) {
    double change = 0.0;
    for (int s = 0; s < f->sides; s++) {
        const lq_two_sided k = kernel_of(f, x, s);
        change = fmax(change, lq_solver_kernels_get()->travel(&k, f->level->survival));
    }
    return change;
}

/* C of both sides from E. */
static void meet(const lq_hits *f, const lq_hits_values *x) {
    for (int s = 0; s < f->sides; s++) {
        const lq_two_sided k = kernel_of(f, x, s);
        lq_solver_kernels_get()->meet(&k);
    }
}

/* What a hit is worth besides what meets the next one. */
static void add_source(const lq_hits *f, const lq_hits_values *x, lq_v8 *before) {
    for (size_t q = 0; x->source && q < 2 * half_size(f); q++) before[q] += x->source[q];
}

static bool is_energy(const lq_hits *f, const lq_hits_values *x) {
    for (size_t q = 0; q < half_size(f); q++)
        if (!(fabs(x->value[0][q][0]) < 10.0 && fabs(x->value[1][q][0]) < 10.0)) return false; /* NaN too */
    return true;
}

static bool solve_by_passes(const lq_hits *f, lq_hits_values *x, double settled) {
    double change = 1.0, left = 1.0;
    for (int pass = 0; pass < PASSES && left > settled && change < 10.0; pass++) {
        const double before = change;
        change = travel(f, x);
        meet(f, x);
        add_source(f, x, x->before[0]);
        /* The changes fall like a geometric series: what all the later ones would add. */
        left = change < before ? change * fmax(change / (before - change), 1.0) : 1.0;
    }
    return left <= settled && is_energy(f, x);
}

/* One pass without the reward, from a C to another: what the Krylov space is made of. */
typedef struct one_pass {
    const lq_hits *f;
    lq_hits_values unpaid;
} one_pass;

static void pass_unpaid(void *user, const lq_v8 *before, lq_v8 *after) {
    one_pass *p = user;
    const size_t size = half_size(p->f);
    memcpy(after, before, 2 * size * sizeof *after);
    for (int s = 0; s < 2; s++) p->unpaid.before[s] = after + (size_t)s * size;
    travel(p->f, &p->unpaid);
    meet(p->f, &p->unpaid);
}

/* C of the light that has met one facet is the right side. False where that does not settle either: rays that
 * graze a fine level meet hundreds of facets, and its interpolation can overshoot by enough to matter then. A
 * coarser level holds. */
static bool solve_by_krylov(const lq_hits *f, lq_hits_values *x) {
    const size_t size = half_size(f);
    lq_v8 *right = (lq_v8 *)(void *)lq_zeros((2 * size + (size_t)(2 * f->level->axis.count)) * LQ_LANES);
    if (!right) return false;
    one_pass p = {f, *x};
    p.unpaid.reward = right + 2 * size;
    memset(x->before[0], 0, 2 * size * sizeof(lq_v8));
    travel(f, x);
    lq_hits_values first = *x;
    for (int s = 0; s < 2; s++) first.before[s] = right + (size_t)s * size;
    meet(f, &first);
    add_source(f, x, right);
    const double left = lq_krylov_solve(pass_unpaid, &p, 2 * size, right, x->before[0], PRODUCTS, RESIDUAL);
    travel(f, x);
    free(right);
    return left >= 0.0 && left <= 10.0 * RESIDUAL && is_energy(f, x);
}

bool lq_hits_solve(const lq_hits *f, lq_hits_values *x, double settled) {
    memset(x->before[0], 0, 2 * half_size(f) * sizeof(lq_v8));
    add_source(f, x, x->before[0]);
    return solve_by_passes(f, x, settled) || solve_by_krylov(f, x);
}
