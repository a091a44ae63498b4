/* Fixed blocks of samples, each summed by one thread; the blocks are then joined in their order. */
#include "validate/walk_reduce.h"

#include "system/status.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* More blocks than threads by enough to balance the load, few enough that joining them costs nothing. */
enum { BLOCKS = 512 };

typedef struct block {
    size_t samples;
    double mean[LQ_WALK_MAX_VALUES];
    double spread[LQ_WALK_MAX_VALUES]; /* sum of squared deviations from the mean */
} block;

/* Sums are taken about the first sample: nearly equal values would otherwise lose their spread. */
static void run_block(const lq_walk *walk, lq_walk_sample *sample, const void *context, size_t count,
                      size_t begin, size_t end, block *out) {
    double origin[LQ_WALK_MAX_VALUES] = {0.0}, sum[LQ_WALK_MAX_VALUES] = {0.0};
    double square[LQ_WALK_MAX_VALUES] = {0.0};
    for (size_t i = begin; i < end; i++) {
        double values[LQ_WALK_MAX_VALUES];
        memset(values, 0, count * sizeof *values);
        lq_stream stream = lq_stream_open(walk->seed, walk->purpose, i);
        sample(context, &stream, values);
        if (i == begin) memcpy(origin, values, count * sizeof *values);
        for (size_t k = 0; k < count; k++) {
            const double d = values[k] - origin[k];
            sum[k] += d;
            square[k] += d * d;
        }
    }
    const double samples = (double)(end - begin);
    out->samples = end - begin;
    for (size_t k = 0; k < count; k++) {
        out->mean[k] = origin[k] + sum[k] / samples;
        out->spread[k] = fmax(square[k] - sum[k] * sum[k] / samples, 0.0);
    }
}

/* Chan, Golub & LeVeque 1979: the mean and spread of two groups from those of each. */
static void join(block *total, const block *part, size_t count) {
    const double a = (double)total->samples, b = (double)part->samples;
    for (size_t k = 0; k < count; k++) {
        const double d = part->mean[k] - total->mean[k];
        total->mean[k] += d * (b / (a + b));
        total->spread[k] += part->spread[k] + d * d * (a * b / (a + b));
    }
    total->samples += part->samples;
}

lq_status lq_walk_reduce(const lq_walk *walk, lq_walk_sample *sample, const void *context, size_t count,
                         lq_walk_mean *means, lq_error *error) {
    const size_t samples = walk->samples;
    const size_t block_count = samples < BLOCKS ? samples : BLOCKS;
    block *blocks = calloc(block_count, sizeof *blocks);
    if (!blocks) return lq_fail(error, LQ_NO_MEMORY, "no memory for the sums of a random walk");
    const int threads = walk->threads > 0 ? walk->threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t i = 0; i < block_count; i++)
        run_block(walk, sample, context, count, samples * i / block_count, samples * (i + 1) / block_count,
                  &blocks[i]);
    for (size_t i = 1; i < block_count; i++) join(&blocks[0], &blocks[i], count);
    const double n = (double)samples;
    for (size_t k = 0; k < count; k++) {
        means[k].mean = blocks[0].mean[k];
        means[k].error = samples > 1 ? sqrt(blocks[0].spread[k] / (n * (n - 1.0))) : INFINITY;
    }
    free(blocks);
    return LQ_OK;
}

/* The delta method, with 2 cov = var(x + y) - var x - var y. */
lq_walk_mean lq_walk_ratio(lq_walk_mean y, lq_walk_mean x, lq_walk_mean sum) {
    lq_walk_mean r = {0.0, 0.0};
    if (x.mean <= 0.0) return r;
    r.mean = y.mean / x.mean;
    const double vx = x.error * x.error, vy = y.error * y.error;
    const double covariance = 0.5 * (sum.error * sum.error - vx - vy);
    const double variance = vy - 2.0 * r.mean * covariance + r.mean * r.mean * vx;
    r.error = sqrt(fmax(variance, 0.0)) / x.mean;
    return r;
}
