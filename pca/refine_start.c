/* refine_start.c - a fit before its first sweep: memory, and singular vectors of the transformed samples. */
#include "pca/refine_start.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/low_rank.h"
#include "pca/refine_lines.h"
#include "system/status.h"

lq_status lq_fit_create(lq_fit *fit, lq_error *error) {
    for (int k = 0; k < fit->stream_count; k++) {
        lq_stream *s = &fit->streams[k];
        const size_t lines = s->bases * s->pairs;
        s->p = calloc(fit->rows * s->bases, sizeof *s->p);
        s->q = calloc(s->columns * s->bases, sizeof *s->q);
        s->column = malloc(fit->columns * sizeof *s->column);
        for (int a = 0; a < 2 && lines > 0; a++) s->lines[a] = calloc(lines * s->size[a], sizeof(double));
        if (!s->p || !s->q || !s->column || (lines > 0 && (!s->lines[0] || !s->lines[1]))) {
            lq_fit_free(fit);
            return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu bases of %zu texels", s->bases, fit->rows);
        }
    }
    return LQ_OK;
}

void lq_fit_free(lq_fit *fit) {
    for (int k = 0; k < LQ_MAX_STREAMS; k++) {
        lq_stream *s = &fit->streams[k];
        free(s->p);
        free(s->q);
        free(s->column);
        free(s->lines[0]);
        free(s->lines[1]);
        s->p = s->q = s->lines[0] = s->lines[1] = NULL;
        s->column = NULL;
    }
}

/* ------------------------------------------------------------------ energy and path of a crossing */

/* The path log2(1/c) of a crossing and its energy from the samples of one row that share a column of stream
 * 0: at[j], in order of growing tau. */
static void crossing(const lq_fit *fit, const float *samples, const size_t *at, size_t count, float *energy,
                     float *path) {
    const size_t last = at[count - 1];
    double e = fmax((double)samples[last], 1e-12);
    if (fit->depth[last] < -1e-6 && count > 1) { /* no sample at tau = 1: on along the last two */
        const size_t previous = at[count - 2];
        const double slope =
            log2(e / fmax((double)samples[previous], 1e-12)) / (fit->depth[last] - fit->depth[previous]);
        e = fmin(e * exp2(-fit->depth[last] * fmax(slope, 0.0)), 1.0);
    }
    *energy = (float)e;
    double known = 1.0; /* of a sample that says nothing: that of the neighbour */
    for (size_t j = 0; j < count; j++) {
        const double loss = log2(fmax((double)samples[at[j]], 1e-30) / e);
        const bool says = fit->depth[at[j]] < -1e-3 && (double)samples[at[j]] > 1e-5 && loss < 0.0;
        if (says) known = fmin(fmax(log2(loss / fit->depth[at[j]]), -0.5), 6.0);
        path[at[j]] = (float)(says || j > 0 ? known : NAN);
    }
    for (size_t j = count - 1; j-- > 0;)
        if (isnan(path[at[j]])) path[at[j]] = path[at[j + 1]];
    if (count > 2 && fit->depth[last] > -1e-6) /* tau = 1 has no slope: on along the last two */
        path[last] = 2.0f * path[at[count - 2]] - path[at[count - 3]];
}

/* Samples of the two streams: rows x columns of each. */
static void crossings(const lq_fit *fit, float *energy, float *path, size_t *at) {
    const lq_stream *s = &fit->streams[0];
    for (size_t column = 0; column < s->columns; column++) {
        size_t count = 0;
        for (size_t c = 0; c < fit->columns; c++)
            if (s->column[c] == column) at[count++] = c;
        for (size_t row = 0; row < fit->rows; row++)
            crossing(fit, fit->samples + row * fit->columns, at, count, &energy[row * s->columns + column],
                     path + row * fit->columns);
    }
}

/* ------------------------------------------------------------------ start */

static lq_status start_stream(lq_fit *fit, int k, const float *samples, lq_error *error) {
    lq_stream *s = &fit->streams[k];
    lq_status status = lq_low_rank(samples, fit->rows, s->columns, s->bases, s->p, s->q, error);
    if (status == LQ_OK && s->pairs > 0) status = lq_lines_start(s, error);
    return status;
}

static lq_status start_roots(lq_fit *fit, lq_error *error) {
    const size_t count = fit->rows * fit->columns;
    float *roots = malloc(count * sizeof *roots);
    if (!roots) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu samples", count);
    for (size_t i = 0; i < count; i++) roots[i] = sqrtf(fmaxf(fit->samples[i], 0.0f));
    const lq_status status = start_stream(fit, 0, roots, error);
    free(roots);
    return status;
}

static lq_status start_crossings(lq_fit *fit, lq_error *error) {
    float *energy = malloc(fit->rows * fit->streams[0].columns * sizeof *energy);
    float *path = malloc(fit->rows * fit->columns * sizeof *path);
    size_t *at = malloc(fit->columns * sizeof *at);
    lq_status status = LQ_OK;
    if (energy && path && at) {
        crossings(fit, energy, path, at);
        status = start_stream(fit, 0, energy, error);
        if (status == LQ_OK) status = start_stream(fit, 1, path, error);
    } else {
        status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu samples", fit->rows * fit->columns);
    }
    free(energy);
    free(path);
    free(at);
    return status;
}

lq_status lq_fit_start(lq_fit *fit, lq_error *error) {
    switch (fit->value) {
    case LQ_VALUE_PLAIN:
        return start_stream(fit, 0, fit->samples, error);
    case LQ_VALUE_SQUARE:
        return start_roots(fit, error);
    default:
        return start_crossings(fit, error);
    }
}
