/* refine_lines.c - the separated side of a stream: free columns, or sums of products of two lines. */
#include "pca/refine_lines.h"

#include <stdlib.h>
#include <string.h>

#include "pca/low_rank.h"
#include "pca/normal.h"
#include "system/status.h"

static size_t packed_at(size_t bases, size_t a, size_t b) {
    const size_t low = a < b ? a : b, high = a < b ? b : a;
    return low * bases - low * (low + 1) / 2 + high; /* rows of the upper triangle, the diagonal included */
}

/* ------------------------------------------------------------------ free columns */

static bool free_step(lq_stream *s, const float *matrices, const float *right) {
    const size_t packed = s->bases * (s->bases + 1) / 2;
    double *full = malloc((s->bases + 1) * s->bases * sizeof *full), *step = full + s->bases * s->bases;
    if (!full) return false;
    for (size_t c = 0; c < s->columns; c++) {
        for (size_t a = 0; a < s->bases; a++) step[a] = (double)right[c * s->bases + a];
        if (!lq_normal_solve(matrices + c * packed, s->bases, full, step)) continue;
        for (size_t a = 0; a < s->bases; a++) s->q[c * s->bases + a] += step[a];
    }
    free(full);
    return true;
}

/* ------------------------------------------------------------------ lines */

void lq_lines_multiply(lq_stream *s) {
    memset(s->q, 0, s->columns * s->bases * sizeof *s->q);
    for (size_t b = 0; b < s->bases; b++)
        for (size_t j = 0; j < s->pairs; j++) {
            const double *along = s->lines[0] + (b * s->pairs + j) * s->size[0];
            const double *across = s->lines[1] + (b * s->pairs + j) * s->size[1];
            for (size_t c = 0; c < s->columns; c++)
                s->q[c * s->bases + b] += along[c % s->size[0]] * across[c / s->size[0]];
        }
}

/* The column at texel i of line `axis` and texel o of the other. */
static size_t column_of(const lq_stream *s, int axis, size_t i, size_t o) {
    return axis == 0 ? o * s->size[0] + i : i * s->size[0] + o;
}

/* Normal equations of all lines' values at texel i of one axis. */
static void contract(const lq_stream *s, int axis, size_t i, const float *matrices, const float *right,
                     float *normal, double *step) {
    const size_t n = s->bases * s->pairs, others = s->size[1 - axis], packed = s->bases * (s->bases + 1) / 2;
    const double *other = s->lines[1 - axis];
    float *at = normal;
    for (size_t u = 0; u < n; u++) {
        step[u] = 0.0;
        for (size_t o = 0; o < others; o++)
            step[u] +=
                (double)right[column_of(s, axis, i, o) * s->bases + u / s->pairs] * other[u * others + o];
        for (size_t v = u; v < n; v++) {
            const size_t entry = packed_at(s->bases, u / s->pairs, v / s->pairs);
            double sum = 0.0;
            for (size_t o = 0; o < others; o++)
                sum += (double)matrices[column_of(s, axis, i, o) * packed + entry] * other[u * others + o] *
                       other[v * others + o];
            *at++ = (float)sum;
        }
    }
}

/* right -= normal (q - before): the gradient after q has moved, to first order. */
static void follow(const lq_stream *s, const double *before, const float *matrices, float *right) {
    const size_t packed = s->bases * (s->bases + 1) / 2;
    for (size_t c = 0; c < s->columns; c++)
        for (size_t a = 0; a < s->bases; a++) {
            double sum = 0.0;
            for (size_t b = 0; b < s->bases; b++)
                sum += (double)matrices[c * packed + packed_at(s->bases, a, b)] *
                       (s->q[c * s->bases + b] - before[c * s->bases + b]);
            right[c * s->bases + a] -= (float)sum;
        }
}

static lq_status line_steps(lq_stream *s, const float *matrices, float *right, lq_error *error) {
    const size_t n = s->bases * s->pairs;
    double *full = malloc((n * (n + 1) + s->columns * s->bases) * sizeof *full);
    float *normal = malloc(n * (n + 1) / 2 * sizeof *normal);
    if (!full || !normal) {
        free(full);
        free(normal);
        return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu lines", n);
    }
    double *step = full + n * n, *before = step + n;
    for (int axis = 0; axis < 2; axis++) {
        memcpy(before, s->q, s->columns * s->bases * sizeof *before);
        for (size_t i = 0; i < s->size[axis]; i++) {
            contract(s, axis, i, matrices, right, normal, step);
            if (!lq_normal_solve(normal, n, full, step)) continue;
            for (size_t u = 0; u < n; u++) s->lines[axis][u * s->size[axis] + i] += step[u];
        }
        lq_lines_multiply(s);
        if (axis == 0) follow(s, before, matrices, right);
    }
    free(full);
    free(normal);
    return lq_lines_start(s, error); /* the same products, from lines that do not cancel each other */
}

lq_status lq_columns_step(lq_stream *stream, const float *matrices, float *right, lq_error *error) {
    if (stream->pairs > 0) return line_steps(stream, matrices, right, error);
    if (free_step(stream, matrices, right)) return LQ_OK;
    return lq_fail(error, LQ_NO_MEMORY, "no memory to refine factors");
}

/* ------------------------------------------------------------------ start */

static lq_status lines_of(lq_stream *s, size_t base, float *matrix, double *left, double *right,
                          lq_error *error) {
    for (size_t c = 0; c < s->columns; c++) matrix[c] = (float)s->q[c * s->bases + base];
    const lq_status status = lq_low_rank(matrix, s->size[1], s->size[0], s->pairs, left, right, error);
    for (size_t j = 0; status == LQ_OK && j < s->pairs; j++) {
        for (size_t i = 0; i < s->size[0]; i++)
            s->lines[0][(base * s->pairs + j) * s->size[0] + i] = right[i * s->pairs + j];
        for (size_t i = 0; i < s->size[1]; i++)
            s->lines[1][(base * s->pairs + j) * s->size[1] + i] = left[i * s->pairs + j];
    }
    return status;
}

lq_status lq_lines_start(lq_stream *s, lq_error *error) {
    float *matrix = malloc(s->columns * sizeof *matrix);
    double *left = malloc((s->size[0] + s->size[1]) * s->pairs * sizeof *left);
    lq_status status = matrix && left ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for lines");
    for (size_t b = 0; status == LQ_OK && b < s->bases; b++)
        status = lines_of(s, b, matrix, left, left + s->size[1] * s->pairs, error);
    if (status == LQ_OK) lq_lines_multiply(s);
    free(matrix);
    free(left);
    return status;
}
