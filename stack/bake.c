/* bake.c - which sets of parameters are solved, and all of them in one loop. */
#include "stack/bake.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/parallel.h"
#include "system/status.h"

enum { FIRST = 5, MOST = 33 };

static const double BEND = 0.02; /* below it a roughness is hardly seen, and its logarithm runs away */

static double coordinate_of(const lq_material_range *range, double value) {
    return range->roughness ? log(value + BEND) : value;
}

static double value_of(const lq_material_range *range, double coordinate) {
    const double value = range->roughness ? exp(coordinate) - BEND : coordinate;
    return fmin(fmax(value, range->min), range->max);
}

/* ======================================================================================
 *                                    Interpolation
 * ====================================================================================== */

static size_t sets_of(const lq_baked *b) {
    return b->nodes[0].nodes * b->nodes[1].nodes;
}

static size_t set_size(const lq_baked *b) {
    return b->mu_count * LQ_MATERIAL_NUMBERS;
}

static void weights_at(const lq_baked *b, int r, double coordinate, double *weight) {
    if (b->nodes[r].nodes == 1) weight[0] = 1.0;
    else lq_series_weights(&b->nodes[r], coordinate, weight);
}

static void interpolate(const lq_baked *b, const double *coordinates, double *numbers) {
    double weight[LQ_MATERIAL_RANGES][LQ_SERIES_MAX];
    for (int r = 0; r < LQ_MATERIAL_RANGES; r++) weights_at(b, r, coordinates[r], weight[r]);
    memset(numbers, 0, set_size(b) * sizeof *numbers);
    for (size_t s = 0; s < sets_of(b); s++) {
        const double w = weight[0][s % b->nodes[0].nodes] * weight[1][s / b->nodes[0].nodes];
        const double *from = b->numbers + s * set_size(b);
        for (size_t i = 0; i < set_size(b); i++) numbers[i] += w * from[i];
    }
}

void lq_baked_at(const lq_baked *b, const double *values, double *numbers) {
    double coordinates[LQ_MATERIAL_RANGES] = {0.0};
    for (int r = 0; r < b->material->range_count; r++)
        coordinates[r] = coordinate_of(&b->material->ranges[r], values[r]);
    interpolate(b, coordinates, numbers);
}

/* ======================================================================================
 *                                        Rounds
 * ====================================================================================== */

/* A material on its way: the grid it has, and the one being solved. */
typedef struct growing {
    lq_baked *baked;
    lq_baked next;
    int along; /* the range that grows; -1: the first round */
    bool settled[LQ_MATERIAL_RANGES], done;
    size_t first; /* of its turns in the round */
    size_t turns;
} growing;

typedef struct baking {
    growing *growing;
    size_t count;
    const double *mu;
    const lq_spread *spread;
} baking;

/* The set of the new grid that turn `turn` solves: those that the old grid has not. */
static size_t set_of(const growing *g, size_t turn) {
    if (g->along < 0) return turn;
    const size_t width = g->next.nodes[0].nodes;
    if (g->along == 1) return (2 * (turn / width) + 1) * width + turn % width;
    const size_t odd = width / 2;
    return turn / odd * width + 2 * (turn % odd) + 1;
}

static bool is_new(const growing *g, size_t set) {
    const size_t width = g->next.nodes[0].nodes;
    return g->along < 0 || ((g->along == 0 ? set % width : set / width) & 1) == 1;
}

static void coordinates_of(const lq_baked *b, size_t set, double *coordinates) {
    const size_t at[] = {set % b->nodes[0].nodes, set / b->nodes[0].nodes};
    for (int r = 0; r < LQ_MATERIAL_RANGES; r++)
        coordinates[r] = b->nodes[r].nodes > 1 ? lq_series_node(&b->nodes[r], at[r]) : b->nodes[r].from;
}

static lq_status solve_set(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    const baking *b = user;
    const growing *g = b->growing;
    while (turn >= g->first + g->turns) g++;
    const lq_material *material = g->next.material;
    const size_t set = set_of(g, turn - g->first);
    double values[LQ_MATERIAL_RANGES];
    coordinates_of(&g->next, set, values);
    for (int r = 0; r < material->range_count; r++) values[r] = value_of(&material->ranges[r], values[r]);
    return lq_material_solve(material, values, b->spread, b->mu, g->next.mu_count, 0, 0.0,
                             g->next.numbers + set * set_size(&g->next), error);
}

/* What the sets of the old grid were. */
static void copy_known(const growing *g) {
    const size_t size = set_size(&g->next), width = g->next.nodes[0].nodes;
    for (size_t set = 0; set < sets_of(&g->next); set++) {
        if (is_new(g, set)) continue;
        const size_t x = set % width, y = set / width;
        const size_t old =
            (g->along == 1 ? y / 2 : y) * g->baked->nodes[0].nodes + (g->along == 0 ? x / 2 : x);
        memcpy(g->next.numbers + set * size, g->baked->numbers + old * size, size * sizeof(double));
    }
}

static lq_status begin(growing *g, lq_error *error) {
    g->next = *g->baked;
    g->along = -1;
    if (g->baked->numbers) {
        g->along = g->settled[0] ? 1 : 0;
        g->next.nodes[g->along].nodes = 2 * g->next.nodes[g->along].nodes - 1;
    }
    g->next.numbers = malloc((sets_of(&g->next) * set_size(&g->next) + 1) * sizeof(double));
    if (!g->next.numbers) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu stacks", sets_of(&g->next));
    g->turns = g->along < 0 ? sets_of(&g->next) : sets_of(&g->next) - sets_of(g->baked);
    if (g->along >= 0) copy_known(g);
    return LQ_OK;
}

/* Energies as they are, a roughness by how much light has it. */
static double difference(const double *a, const double *b) {
    double most = 0.0, inner = 0.0;
    for (int k = 0; k < LQ_MATERIAL_NUMBERS; k++)
        if (k != LQ_MATERIAL_INNER_ALPHA) most = fmax(most, fabs(a[k] - b[k]));
    for (int c = 0; c < LQ_MATERIAL_COLOURS; c++) inner = fmax(inner, a[LQ_MATERIAL_INNER + c]);
    return fmax(most, inner * fabs(a[LQ_MATERIAL_INNER_ALPHA] - b[LQ_MATERIAL_INNER_ALPHA]));
}

/* What the old grid said of the new sets. Grazing light, where no error is promised, does not count. */
static double judge(const growing *g, const double *mu, double *scratch) {
    double most = 0.0, at[LQ_MATERIAL_RANGES];
    for (size_t set = 0; set < sets_of(&g->next); set++) {
        if (!is_new(g, set)) continue;
        coordinates_of(&g->next, set, at);
        interpolate(g->baked, at, scratch);
        const double *exact = g->next.numbers + set * set_size(&g->next);
        for (size_t m = 0; m < g->next.mu_count; m++)
            if (mu[m] >= LQ_MATERIAL_FROM)
                most = fmax(most,
                            difference(exact + m * LQ_MATERIAL_NUMBERS, scratch + m * LQ_MATERIAL_NUMBERS));
    }
    return most;
}

/* The new grid takes the place of the old one. */
static lq_status end(growing *g, const double *mu, double tolerance, lq_error *error) {
    double *scratch = malloc((set_size(&g->next) + 1) * sizeof *scratch);
    if (!scratch) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", g->next.mu_count);
    const double off = g->along < 0 ? 0.0 : judge(g, mu, scratch);
    free(scratch);
    free(g->baked->numbers);
    *g->baked = g->next;
    g->next.numbers = NULL;
    if (g->along >= 0 && (off <= tolerance || g->baked->nodes[g->along].nodes >= MOST)) {
        g->settled[g->along] = true;
        g->baked->error = fmax(g->baked->error, off);
    }
    g->done = g->settled[0] && g->settled[1];
    return LQ_OK;
}

/* Every material that is not done grows once. */
static lq_status round_of(baking *b, double tolerance, int threads, const lq_progress *progress,
                          lq_error *error) {
    size_t turns = 0;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < b->count; i++) {
        growing *g = &b->growing[i];
        g->first = turns;
        g->turns = 0;
        if (!g->done && status == LQ_OK) status = begin(g, error);
        turns += g->turns;
    }
    if (status == LQ_OK) status = lq_parallel(turns, threads, solve_set, b, progress, error);
    if (status == LQ_NOT_CONVERGED)
        status = LQ_OK; /* the level was too fine for an interface: measured later */
    for (size_t i = 0; i < b->count && status == LQ_OK; i++)
        if (!b->growing[i].done) status = end(&b->growing[i], b->mu, tolerance, error);
    return status;
}

static void start(growing *g, lq_baked *baked, const lq_material *material, size_t mu_count) {
    *g = (growing){.baked = baked};
    *baked = (lq_baked){.material = material, .mu_count = mu_count, .nodes = {{1, 0.0, 0.0}, {1, 0.0, 0.0}}};
    for (int r = 0; r < LQ_MATERIAL_RANGES; r++) {
        const lq_material_range *range = &material->ranges[r];
        g->settled[r] = r >= material->range_count || range->min == range->max;
        if (r >= material->range_count) continue;
        const double from = coordinate_of(range, range->min), to = coordinate_of(range, range->max);
        baked->nodes[r] = (lq_series){g->settled[r] ? 1 : FIRST, from, to};
    }
}

static lq_status bake_all(baking *b, double tolerance, int threads, const lq_progress *progress,
                          lq_error *error) {
    lq_status status = LQ_OK;
    bool left = true;
    while (left && status == LQ_OK) {
        status = round_of(b, tolerance, threads, progress, error);
        left = false;
        for (size_t i = 0; i < b->count; i++) left = left || !b->growing[i].done;
    }
    for (size_t i = 0; i < b->count; i++) free(b->growing[i].next.numbers);
    return status;
}

lq_status lq_bake(const lq_material *const *materials, size_t count, const double *mu, size_t mu_count,
                  double tolerance, int threads, const lq_progress *progress, lq_baked *baked,
                  lq_error *error) {
    double *cosines = malloc((mu_count + 1) * sizeof *cosines), worst = 0.0;
    lq_spread spread = {0};
    baking b = {malloc((count + 1) * sizeof *b.growing), count, mu, &spread};
    for (size_t i = 0; i < count; i++) baked[i] = (lq_baked){0};
    lq_status status =
        cosines && b.growing ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", count);
    if (status == LQ_OK) {
        memcpy(cosines, mu, mu_count * sizeof *cosines);
        cosines[mu_count] = 1.0;
        status = lq_spread_make(&spread, cosines, mu_count + 1, error);
    }
    for (size_t i = 0; i < count && status == LQ_OK; i++)
        start(&b.growing[i], &baked[i], materials[i], mu_count);
    if (status == LQ_OK) status = bake_all(&b, tolerance, threads, progress, error);
    for (size_t i = 0; i < count; i++) worst = fmax(worst, baked[i].error);
    lq_spread_free(&spread);
    free(cosines);
    free(b.growing);
    if (status != LQ_OK || worst <= tolerance) return status;
    return lq_fail(error, LQ_NOT_CONVERGED, "%d nodes of a range leave %.2g", MOST, worst);
}

void lq_baked_free(lq_baked *baked) {
    free(baked->numbers);
    *baked = (lq_baked){0};
}
