/* Certificates: every block computed, decoded and reduced. */
#include "validate/certificate.h"

#include "pack/measure.h"
#include "system/status.h"
#include "validate/certificate_confidence.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

double lq_decode_table(const void *table, int channel, const double *point) {
    return lq_table_lookup(table, channel, point);
}

double lq_decode_factored(const void *factored, int channel, const double *point) {
    (void)channel;
    return lq_factored_lookup(factored, point);
}

double lq_decode_texture(const void *texture, int channel, const double *point) {
    double values[4];
    lq_texture_sample(texture, point, LQ_FILTER_BITS, values);
    return values[channel];
}

double lq_decode_gpu(const void *factored, int channel, const double *point) {
    (void)channel;
    return lq_factored_lookup_gpu(factored, point);
}

/* ------------------------------------------------------------------------------------- sampling */

static size_t channels_of(const lq_sampled *c) {
    return (size_t)c->request.kind->channel_count;
}

static lq_status allocate(lq_sampled *c, lq_error *error) {
    const size_t axes = (size_t)c->request.kind->axis_count, values = c->points * channels_of(c);
    c->at = malloc(c->points * axes * sizeof *c->at);
    c->exact = malloc(values * sizeof *c->exact);
    bool good = c->at && c->exact;
    for (int s = 0; s < c->request.stage_count; s++) {
        c->decoded[s] = malloc(values * sizeof *c->decoded[s]);
        good = good && c->decoded[s];
    }
    return good ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu points", c->points);
}

/* Block `b` into its places. */
static lq_status measure_block(lq_sampled *c, size_t b, double *estimate, lq_error *error) {
    const lq_sample_request *r = &c->request;
    const int axes = r->kind->axis_count;
    const size_t count = c->plan.per_block, first = b * count;
    lq_block *block = malloc(sizeof *block);
    double *values = malloc(count * channels_of(c) * sizeof *values);
    lq_status status = block && values ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for a block");
    if (status == LQ_OK) {
        lq_block_draw(&c->plan, b, block);
        status = lq_block_exact(r->kind, &r->settings, r->curve, block, values, estimate, error);
    }
    for (size_t i = 0; status == LQ_OK && i < count; i++) {
        double *point = c->at + (first + i) * (size_t)axes;
        lq_block_point(block, axes, i, point);
        for (size_t k = 0; k < channels_of(c); k++) {
            const size_t to = k * c->points + first + i;
            const double exact = values[k * count + i], unit = r->relative ? fabs(exact) : 1.0;
            c->exact[to] = exact / unit;
            for (int s = 0; s < r->stage_count; s++)
                c->decoded[s][to] = r->stages[s].decode(r->stages[s].subject, (int)k, point) / unit;
        }
    }
    free(values);
    free(block);
    return status;
}

static lq_status measure(lq_sampled *c, const lq_progress *progress, lq_error *error) {
    const int threads = c->request.threads > 0 ? c->request.threads : omp_get_num_procs();
    const size_t blocks = c->plan.count;
    lq_status status = LQ_OK;
    size_t done = 0;
    double worst = 0.0;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) reduction(max : worst)
    for (size_t b = 0; b < blocks; b++) {
        lq_status stop;
#pragma omp atomic read
        stop = status;
        if (stop != LQ_OK) continue;
        lq_error cause = {""};
        double estimate = 0.0;
        stop = measure_block(c, b, &estimate, &cause);
        worst = fmax(worst, estimate);
#pragma omp critical(lq_certify_block)
        {
            done++;
            if (stop == LQ_OK && progress && progress->report &&
                !progress->report(progress->user, (double)done / (double)blocks))
                stop = lq_fail(&cause, LQ_CANCELLED, "cancelled");
            if (stop != LQ_OK && status == LQ_OK) {
                if (error) *error = cause;
#pragma omp atomic write
                status = stop;
            }
        }
    }
    c->estimate = worst;
    return status;
}

/* -------------------------------------------------------------------------------------- figures */

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* p99 and its limit from `size`, |d| of every point block by block, repeated for `channels`. */
static void quantiles(const lq_sampled *c, size_t channels, const double *size, double *sorted, size_t *hits,
                      lq_figures *f) {
    const size_t count = c->points * channels;
    memcpy(sorted, size, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, ascending);
    f->p99 = sorted[count - 1 - count / 100];
    memset(hits, 0, c->plan.count * sizeof *hits);
    for (size_t i = 0; i < count; i++) hits[i % c->points / c->plan.per_block] += size[i] > f->p99;
    f->effective = lq_effective_points(hits, c->plan.count, c->plan.per_block * channels);
    const double rank = lq_quantile_rank(f->effective, 0.99, LQ_CONFIDENCE) / f->effective * (double)count;
    f->p99_limit = rank < (double)count ? sorted[(size_t)rank] : INFINITY;
}

/* Of first - second, `channels` lists of all points; `work` holds twice as many numbers. */
static void reduce(const lq_sampled *c, size_t channels, const double *first, const double *second,
                   double *work, size_t *hits, lq_figures *f) {
    const size_t count = c->points * channels;
    *f = (lq_figures){.max = -1.0};
    for (size_t i = 0; i < count; i++) {
        const double d = first[i] - second[i], size = isnan(d) ? INFINITY : fabs(d);
        work[i] = size;
        f->bias += d;
        f->mean += size;
        f->rms += d * d;
        if (size > f->max) f->max = size, f->worst = i;
    }
    f->bias /= (double)count;
    f->mean /= (double)count;
    f->rms = sqrt(f->rms / (double)count);
    quantiles(c, channels, work, work + count, hits, f);
}

static lq_status reduce_all(lq_sampled *c, lq_error *error) {
    const size_t channels = channels_of(c), values = c->points * channels;
    double *work = malloc(2 * values * sizeof *work);
    size_t *hits = malloc(c->plan.count * sizeof *hits);
    if (work && hits) {
        for (int s = 0; s < c->request.stage_count; s++)
            for (size_t k = 0; k < channels; k++) {
                const double *now = c->decoded[s] + k * c->points, *exact = c->exact + k * c->points;
                const double *before = s > 0 ? c->decoded[s - 1] + k * c->points : exact;
                reduce(c, 1, now, exact, work, hits, &c->error[s][k]);
                reduce(c, 1, now, before, work, hits, &c->part[s][k]);
            }
        reduce(c, channels, c->decoded[c->request.stage_count - 1], c->exact, work, hits, &c->total);
        c->unseen = lq_share_limit(0.0, (double)c->plan.count, LQ_CONFIDENCE);
    }
    const bool good = work && hits;
    free(work);
    free(hits);
    return good ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu errors", values);
}

lq_status lq_sample(const lq_sample_request *request, const lq_progress *progress, lq_sampled *certificate,
                    lq_error *error) {
    lq_sampled *c = certificate;
    *c = (lq_sampled){.request = *request};
    lq_status status =
        lq_block_plan_make(&c->plan, request->kind, &request->domain, request->points, request->seed, error);
    if (status != LQ_OK) return status;
    c->points = c->plan.count * c->plan.per_block;
    status = allocate(c, error);
    if (status == LQ_OK) status = measure(c, progress, error);
    if (status == LQ_OK) status = reduce_all(c, error);
    if (status == LQ_OK) status = lq_sampled_search(c, error);
    c->max = fmax(c->total.max, c->found.error);
    return status;
}

void lq_sampled_free(lq_sampled *c) {
    lq_block_plan_free(&c->plan);
    free(c->at);
    free(c->exact);
    for (int s = 0; s < LQ_STAGES_MAX; s++) free(c->decoded[s]);
    *c = (lq_sampled){.points = 0};
}
