/* goniometer.c - rays in blocks, each thread with sums of its own, which are added at the end. */
#include "validate/goniometer.h"

#include <math.h>
#include <stdlib.h>

#include "stack/description.h"
#include "system/parallel.h"
#include "system/status.h"
#include "validate/walk_stack.h"

/* Weights are at most 1, in units of this: sums of LQ_GONIO_MAX_SAMPLES of them stay below 2^64. */
#define UNIT 0x1p-32

/* Weight and square, a channel; channels of one cell lie together, since a ray adds to all of them. */
enum { SUMS = 2, BLOCK = 1 << 14 };

static size_t slice_size(const lq_gonio *g) {
    return (size_t)LQ_SLICE_CELLS * (size_t)g->channels * SUMS;
}

static size_t slice_at(const lq_gonio *g, int side, lq_slice_layout layout, int order) {
    return (((size_t)side * (size_t)g->layouts + layout) * LQ_GONIO_ORDERS + (size_t)order) * slice_size(g);
}

static size_t all_sums(const lq_gonio *g) {
    return slice_at(g, g->sides, 0, 0);
}

/* ======================================================================================
 *                                        Rays
 * ====================================================================================== */

typedef struct job {
    lq_gonio *gonio;
    const lq_walk_pile *pile;
    int channel; /* the first of the pile's */
    uint64_t seed;
    uint64_t **sums, *lost; /* one a thread */
} job;

static uint64_t fixed(double weight) {
    return (uint64_t)(weight * (1.0 / UNIT) + 0.5);
}

static void add(const job *j, uint64_t *sums, int side, int order, const lq_traveller *t) {
    const lq_gonio *g = j->gonio;
    for (int layout = 0; layout < g->layouts; layout++) {
        const size_t cell = lq_slice_cell((lq_slice_layout)layout, g->mu, t->x, t->y, t->ray.z);
        uint64_t *at = sums + slice_at(g, side, (lq_slice_layout)layout, order) +
                       (cell * (size_t)g->channels + (size_t)j->channel) * SUMS;
        for (int c = 0; c < t->colours; c++) {
            const double w = t->colours > 1 ? t->ray.weight * t->tint[c] : t->ray.weight;
            at[c * SUMS] += fixed(w);
            at[c * SUMS + 1] += fixed(w * w);
        }
    }
}

static lq_status run_block(void *user, size_t index, int thread, lq_error *error) {
    (void)error;
    const job *j = user;
    const size_t end = (index + 1) * BLOCK < j->gonio->samples ? (index + 1) * BLOCK : j->gonio->samples;
    for (size_t i = index * BLOCK; i < end; i++) {
        lq_stream stream = lq_stream_open(j->seed, (uint64_t)j->channel, i);
        lq_traveller t;
        size_t meetings;
        const lq_fate fate = lq_walk_through(j->pile, j->gonio->mu, &stream, &t, &meetings);
        const int order = (int)(meetings < LQ_GONIO_ORDERS ? meetings : LQ_GONIO_ORDERS) - 1;
        if (fate == LQ_GIVEN_UP) j->lost[thread] += fixed(t.ray.weight);
        else if (fate != LQ_ABSORBED) add(j, j->sums[thread], fate == LQ_THROUGH, order, &t);
    }
    return LQ_OK;
}

/* ======================================================================================
 *                                     All of them
 * ====================================================================================== */

static void join(const job *j, int threads) {
    lq_gonio *g = j->gonio;
    for (int i = 0; i < threads; i++) {
        for (size_t k = 0; i > 0 && k < all_sums(g); k++) g->sums[k] += j->sums[i][k];
        g->lost += j->lost[i];
    }
}

/* The first thread adds to the result itself. */
static lq_status run(job *j, int threads, const lq_progress *progress, lq_error *error) {
    const size_t blocks = (j->gonio->samples + BLOCK - 1) / BLOCK;
    const int count = lq_parallel_threads(blocks, threads);
    lq_status status = LQ_OK;
    j->sums = calloc((size_t)count, sizeof *j->sums);
    j->lost = calloc((size_t)count, sizeof *j->lost);
    bool whole = j->sums && j->lost;
    for (int i = 0; whole && i < count; i++)
        whole = (j->sums[i] = i ? calloc(all_sums(j->gonio), sizeof(uint64_t)) : j->gonio->sums);
    status = whole ? lq_parallel(blocks, count, run_block, j, progress, error)
                   : lq_fail(error, LQ_NO_MEMORY, "no memory for the slices of %d threads", count);
    if (status == LQ_OK) join(j, count);
    for (int i = 1; j->sums && i < count; i++) free(j->sums[i]);
    free(j->sums);
    free(j->lost);
    return status;
}

static lq_status check(const lq_stack *stack, const lq_stack_query *query, size_t samples, lq_error *error) {
    if (samples < 2 || samples > LQ_GONIO_MAX_SAMPLES)
        return lq_fail(error, LQ_BAD_INPUT, "slices: %zu samples, accepted are 2 to %u", samples,
                       LQ_GONIO_MAX_SAMPLES);
    return lq_stack_solvable(stack, query, error);
}

lq_status lq_gonio_measure(lq_gonio *g, const lq_stack *stack, const lq_stack_query *query, int layouts,
                           size_t samples, uint64_t seed, const lq_progress *progress, lq_error *error) {
    const bool opaque = stack->layers[stack->layer_count - 1].type != LQ_LAYER_DIELECTRIC;
    *g = (lq_gonio){.mu = query->mu[0],
                    .samples = samples,
                    .channels = lq_stack_channels(stack),
                    .sides = opaque ? 1 : LQ_GONIO_SIDES,
                    .layouts = layouts};
    lq_status status = check(stack, query, samples, error);
    if (status != LQ_OK) return status;
    g->sums = calloc(all_sums(g), sizeof *g->sums);
    if (!g->sums) return lq_fail(error, LQ_NO_MEMORY, "no memory for slices");
    const int colours = lq_walk_pile_shared(stack) ? g->channels : 1;
    for (int c = 0; c < g->channels && status == LQ_OK; c += colours) {
        lq_walk_pile pile;
        status = lq_walk_pile_make(&pile, stack, query, c, colours, error);
        job j = {.gonio = g, .pile = &pile, .channel = c, .seed = seed};
        if (status == LQ_OK) status = run(&j, query->threads, progress, error);
        lq_walk_pile_free(&pile);
    }
    return status;
}

void lq_gonio_free(lq_gonio *g) {
    free(g->sums);
    g->sums = NULL;
}

/* ======================================================================================
 *                                      Read out
 * ====================================================================================== */

static void sums_of(const lq_gonio *g, lq_slice_layout layout, const lq_gonio_part *part, size_t cell,
                    double sums[SUMS]) {
    sums[0] = sums[1] = 0.0;
    for (int order = part->from; order <= part->to; order++) {
        const uint64_t *at = g->sums + slice_at(g, part->side, layout, order) +
                             (cell * (size_t)g->channels + (size_t)part->channel) * SUMS;
        for (int k = 0; k < SUMS; k++) sums[k] += (double)at[k] * UNIT;
    }
}

/* Of the mean of all rays, those that went elsewhere adding nothing. */
static double standard_error(const lq_gonio *g, const double sums[SUMS]) {
    const double n = (double)g->samples;
    return sqrt(fmax(sums[1] - sums[0] * sums[0] / n, 0.0) / (n * (n - 1.0)));
}

void lq_gonio_slice(const lq_gonio *g, lq_slice_layout layout, const lq_gonio_part *part, const double *solid,
                    float *value, float *noise) {
    for (size_t cell = 0; cell < LQ_SLICE_CELLS; cell++) {
        double sums[SUMS];
        sums_of(g, layout, part, cell, sums);
        const double scale = solid[cell] > 0.0 ? 1.0 / solid[cell] : 0.0;
        if (value) value[cell] = (float)(sums[0] / (double)g->samples * scale);
        if (noise) noise[cell] = (float)(standard_error(g, sums) * scale);
    }
}

double lq_gonio_energy(const lq_gonio *g, lq_slice_layout layout, const lq_gonio_part *part, double *noise) {
    double all[SUMS] = {0.0};
    for (size_t cell = 0; cell < LQ_SLICE_CELLS; cell++) {
        double sums[SUMS];
        sums_of(g, layout, part, cell, sums);
        for (int k = 0; k < SUMS; k++) all[k] += sums[k];
    }
    if (noise) *noise = standard_error(g, all);
    return all[0] / (double)g->samples;
}

double lq_gonio_lost(const lq_gonio *g) {
    return (double)g->lost * UNIT / (double)g->samples;
}
