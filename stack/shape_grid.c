/* shape_grid.c - refine cosines until lobes in between follow from their neighbours. */
#include "stack/shape_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stack/shape_lobe.h"
#include "system/parallel.h"
#include "system/status.h"

/* Steps of an energy at a critical angle never settle: they end at the most nodes, that wide. */
enum { FEWEST = 17, MOST = 129 };
/* Tables are asked for no more than shows beside that. */
static const double ENOUGH = 5e-3, TABLES = 1e-5;

/* ======================================================================================
 *                                     Some cosines
 * ====================================================================================== */

typedef struct row {
    const lq_stack *stack;
    const lq_model_query *query;
    double least_alpha;
    bool masked;
    size_t width;
    const double *mu;
    const lq_model_lobe *solved;
    lq_grid_lobe *lobes;
} row;

static double mirrored(double sine) {
    const double s = fmin(fmax(sine, 0.0), 1.0);
    return fmax(sqrt((1.0 - s) * (1.0 + s)), LQ_SHAPE_LEAST_MU);
}

static lq_status scale_lobe(void *user, size_t index, int thread, lq_error *error) {
    const row *r = user;
    const lq_model_lobe *from = &r->solved[index];
    double albedo = 1.0;
    (void)thread;
    r->lobes[index] = (lq_grid_lobe){from->energy, 0.0, fmin(fmax(from->alpha, r->least_alpha), 1.0)};
    if (!(from->energy > 0.0)) return LQ_OK;
    const lq_status status =
        r->masked ? LQ_OK : lq_lobe_albedo(mirrored(from->mean), r->lobes[index].alpha, &albedo, error);
    r->lobes[index].scale = from->energy / albedo;
    return status;
}

static lq_status solve_row(row *r, size_t count, lq_error *error) {
    lq_model_query query = *r->query;
    lq_model_lobe *solved = malloc((count * r->width + 1) * sizeof *solved);
    if (!solved) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    query.mu = r->mu;
    query.mu_count = count;
    query.tolerance = TABLES;
    r->solved = solved;
    lq_status status = lq_model_solve(r->stack, &query, solved, NULL, error);
    if (status == LQ_OK) status = lq_parallel(count * r->width, query.threads, scale_lobe, r, NULL, error);
    free(solved);
    return status;
}

/* ======================================================================================
 *                                      Refinement
 * ====================================================================================== */

static double node_cosine(size_t i, size_t nodes) {
    const double root = (double)i / (double)(nodes - 1);
    return root * root;
}

/* Lobes without light have no roughness to differ in. */
static double change(lq_grid_lobe a, lq_grid_lobe b) {
    const double energy = fmax(fabs(a.energy - b.energy), fabs(a.scale - b.scale));
    return a.energy > 0.0 && b.energy > 0.0 ? fmax(energy, fmax(a.energy, b.energy) * fabs(a.alpha - b.alpha))
                                            : energy;
}

/* The grid twice as fine, from cosines halfway between. */
static lq_status refine(lq_shape_grid *grid, row *r, lq_error *error) {
    const size_t before = grid->nodes, added = before - 1, nodes = before + added, width = grid->width;
    lq_grid_lobe *all = malloc(nodes * width * sizeof *all), *between = malloc(added * width * sizeof *all);
    double *mu = malloc(added * sizeof *mu);
    lq_status status = LQ_OK;
    if (!all || !between || !mu) status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", nodes);
    for (size_t i = 0; i < added && status == LQ_OK; i++) mu[i] = node_cosine(2 * i + 1, nodes);
    r->mu = mu;
    r->lobes = between;
    if (status == LQ_OK) status = solve_row(r, added, error);
    grid->gap = 0.0;
    for (size_t i = 0; i < added * width && status == LQ_OK; i++)
        grid->gap = fmax(grid->gap, change(between[i], lq_shape_grid_at(grid, i % width, mu[i / width])));
    for (size_t i = 0; i < nodes && status == LQ_OK; i++)
        memcpy(all + i * width, (i % 2 ? between : grid->lobes) + i / 2 * width, width * sizeof *all);
    free(mu);
    free(between);
    if (status != LQ_OK) {
        free(all);
        return status;
    }
    free(grid->lobes);
    grid->lobes = all;
    grid->nodes = nodes;
    return LQ_OK;
}

static lq_status start(lq_shape_grid *grid, row *r, lq_error *error) {
    double mu[FEWEST];
    grid->lobes = malloc(FEWEST * grid->width * sizeof *grid->lobes);
    if (!grid->lobes) return lq_fail(error, LQ_NO_MEMORY, "no memory for %d cosines", (int)FEWEST);
    for (size_t i = 0; i < FEWEST; i++) mu[i] = node_cosine(i, FEWEST);
    r->mu = mu;
    r->lobes = grid->lobes;
    grid->nodes = FEWEST;
    return solve_row(r, FEWEST, error);
}

lq_status lq_shape_grid_make(lq_shape_grid *grid, const lq_stack *stack, const lq_model_query *query,
                             double least_alpha, bool masked, lq_error *error) {
    *grid = (lq_shape_grid){.width = lq_model_lobe_count(stack) * (size_t)lq_stack_channels(stack)};
    row r = {
        .stack = stack, .query = query, .least_alpha = least_alpha, .masked = masked, .width = grid->width};
    lq_status status = start(grid, &r, error);
    grid->gap = INFINITY;
    while (status == LQ_OK && grid->nodes < MOST && grid->gap > ENOUGH) status = refine(grid, &r, error);
    return status;
}

void lq_shape_grid_free(lq_shape_grid *grid) {
    free(grid->lobes);
    *grid = (lq_shape_grid){0};
}

lq_grid_lobe lq_shape_grid_at(const lq_shape_grid *grid, size_t lobe, double cosine) {
    const double at = sqrt(fmin(fmax(cosine, 0.0), 1.0)) * (double)(grid->nodes - 1);
    const size_t below = (size_t)fmin(at, (double)(grid->nodes - 2));
    const double t = at - (double)below;
    const lq_grid_lobe *a = &grid->lobes[below * grid->width + lobe], *b = a + grid->width;
    /* Where one of both has no light, the other's roughness is the one there is. */
    const double low = a->energy > 0.0 ? a->alpha : b->alpha, high = b->energy > 0.0 ? b->alpha : a->alpha;
    return (lq_grid_lobe){a->energy + t * (b->energy - a->energy), a->scale + t * (b->scale - a->scale),
                          low + t * (high - low)};
}
