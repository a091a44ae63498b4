/* refine.c - Gauss-Newton by blocks: the plane's bases, then the bases of the separated axes.
 *
 * With the residual r and its slope d by one stream at every sample, weights w, one block of unknowns solves
 *
 *     rows of p:      sum_c w d^2 q_c q_c^T  dp = sum_c w d r q_c
 *     columns of q:   sum_r w d^2 p_r p_r^T  dq = sum_r w d r p_r
 *     lines of q:     the same normal matrices, contracted with the other line of every product
 *
 * which for a plain value is alternating least squares, written as increments: what rounding the normal
 * matrices have costs iterations and no accuracy. All sums run over a fixed order.
 *
 * Largest errors: after every sweep w <- w^KEEP (|r| / rms)^((1 - KEEP)(power - 2)), a damped form of
 * Lawson's iteration (Lawson 1961; Rice & Usow 1968) whose fixed point minimises the norm of that power.
 */
#include "pca/refine.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/normal.h"
#include "pca/refine_lines.h"
#include "system/blas.h"
#include "system/status.h"

enum { CHUNK = 32 }; /* rows or columns a thread takes at a time: fixed, whatever the number of threads */

static const double KEEP = 0.9; /* damping of the weights */
static const double RATIO_MIN = 0.05, RATIO_MAX = 20.0;
static const float STEP_MAX = 0.25f; /* of a stream in one step, where the slope says more */

/* ------------------------------------------------------------------ samples */

/* Residual at one sample and its slope by each stream. */
static void residual(const lq_fit *fit, size_t column, float sample, float s0, float s1, float *r, float *d0,
                     float *d1) {
    static const float ln2 = 0.69314718f;
    *d1 = 0.0f;
    if (fit->value == LQ_VALUE_PLAIN) {
        *r = sample - s0;
        *d0 = 1.0f;
    } else if (fit->value == LQ_VALUE_SQUARE) {
        *r = sample - s0 * s0;
        *d0 = fmaxf(2.0f * s0, 0.02f); /* a root of zero has no slope */
    } else {
        const float depth = (float)fit->depth[column], path = exp2f(s1);
        const float passed = exp2f(depth * path);
        *r = sample - s0 * passed;
        *d0 = passed;
        *d1 = s0 * passed * depth * path * (ln2 * ln2);
    }
}

/* Streams of `count` rows from `row`, each in a buffer of count x its columns. */
static void stream_rows(const lq_stream *stream, const float *q, size_t row, size_t count, float *out,
                        float *p) {
    for (size_t i = 0; i < count * stream->bases; i++) p[i] = (float)stream->p[row * stream->bases + i];
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, (int)count, (int)stream->columns, (int)stream->bases,
                1.0f, p, (int)stream->bases, q, (int)stream->bases, 0.0f, out, (int)stream->columns);
}

static void to_float(const double *from, float *to, size_t count) {
    for (size_t i = 0; i < count; i++) to[i] = (float)from[i];
}

/* Weighted normal sums of stream k over the samples of some rows: w d^2 and w d r, summed over the samples
 * that share a column of the stream. The sum of r^2 of each row goes to `squares`, |r| to `size`. */
typedef struct sums {
    float *normal, *gradient; /* count x columns of the stream */
    double *squares;
    float *size;    /* count x columns of the samples; NULL: not asked */
    double largest; /* |r| */
} sums;

static void sum_samples(const lq_fit *fit, int k, const float *weights, size_t row, size_t count,
                        float *const *values, sums *s) {
    const lq_stream *stream = &fit->streams[k];
    memset(s->normal, 0, count * stream->columns * sizeof *s->normal);
    memset(s->gradient, 0, count * stream->columns * sizeof *s->gradient);
    s->largest = 0.0;
    for (size_t i = 0; i < count; i++) {
        const float *samples = fit->samples + (row + i) * fit->columns;
        const float *w = weights ? weights + (row + i) * fit->columns : NULL;
        double squares = 0.0;
        for (size_t c = 0; c < fit->columns; c++) {
            const float s0 = values[0][i * fit->streams[0].columns + fit->streams[0].column[c]];
            const float s1 = fit->stream_count > 1
                                 ? values[1][i * fit->streams[1].columns + fit->streams[1].column[c]]
                                 : 0.0f;
            float r, d[2];
            residual(fit, c, samples[c], s0, s1, &r, &d[0], &d[1]);
            const size_t at = i * stream->columns + stream->column[c];
            const float weight = w ? w[c] : 1.0f, limit = STEP_MAX * fabsf(d[k]);
            s->normal[at] += weight * d[k] * d[k];
            s->gradient[at] +=
                weight * d[k] * (fit->value == LQ_VALUE_PLAIN ? r : fminf(fmaxf(r, -limit), limit));
            squares += (double)(r * r);
            s->largest = fmax(s->largest, (double)fabsf(r));
            if (s->size) s->size[i * fit->columns + c] = fabsf(r);
        }
        s->squares[i] = squares;
    }
}

/* ------------------------------------------------------------------ the work space */

/* out[i][ab] = v[i][a] v[i][b] for all a <= b of `bases`. */
static void outer_products(const double *v, size_t count, size_t bases, float *out) {
    for (size_t i = 0; i < count; i++)
        for (size_t a = 0; a < bases; a++)
            for (size_t b = a; b < bases; b++) *out++ = (float)(v[i * bases + a] * v[i * bases + b]);
}

static size_t packed_size(size_t bases) {
    return bases * (bases + 1) / 2;
}

/* What one thread needs for CHUNK rows. */
typedef struct bench {
    float *values[LQ_MAX_STREAMS], *p, *normal, *gradient, *size, *matrices, *right;
    double *full, *step, squares[CHUNK];
} bench;

static void bench_free(bench *b) {
    for (int k = 0; k < LQ_MAX_STREAMS; k++) free(b->values[k]);
    free(b->p);
    free(b->normal);
    free(b->gradient);
    free(b->size);
    free(b->matrices);
    free(b->right);
    free(b->full);
    free(b->step);
}

static bool bench_make(const lq_fit *fit, bench *b) {
    memset(b, 0, sizeof *b);
    bool made = true;
    for (int k = 0; k < fit->stream_count; k++) {
        b->values[k] = malloc(CHUNK * fit->streams[k].columns * sizeof(float));
        made = made && b->values[k];
    }
    b->p = malloc(CHUNK * LQ_MAX_BASES * sizeof *b->p);
    b->normal = malloc(CHUNK * fit->columns * sizeof *b->normal);
    b->gradient = malloc(CHUNK * fit->columns * sizeof *b->gradient);
    b->size = malloc(CHUNK * fit->columns * sizeof *b->size);
    b->matrices = malloc(CHUNK * packed_size(LQ_MAX_BASES) * sizeof *b->matrices);
    b->right = malloc(CHUNK * LQ_MAX_BASES * sizeof *b->right);
    b->full = malloc((size_t)LQ_MAX_BASES * LQ_MAX_BASES * sizeof *b->full);
    b->step = malloc(LQ_MAX_BASES * sizeof *b->step);
    return made && b->p && b->normal && b->gradient && b->size && b->matrices && b->right && b->full &&
           b->step;
}

/* One pass over all samples. */
typedef struct pass {
    lq_fit *fit;
    int k;          /* the stream in question */
    bool update_p;  /* solve for its rows */
    bool reweight;  /* take |r| of this pass into the weights */
    float *weights; /* rows x columns, or NULL: all one */
    double rms;     /* of the pass before; what ratios refer to */
    float *q[LQ_MAX_STREAMS], *outer;
    float *normal, *gradient; /* rows x stream columns, kept for the update of q; NULL: not kept */
    double *squares, *largest;
} pass;

static void reweigh(const pass *x, size_t row, size_t count, const float *size) {
    const float grow = (float)((1.0 - KEEP) * (x->fit->power - 2.0)), scale = (float)(1.0 / x->rms);
    float *w = x->weights + row * x->fit->columns;
    for (size_t i = 0; i < count * x->fit->columns; i++) {
        const float ratio = fminf(fmaxf(size[i] * scale, (float)RATIO_MIN), (float)RATIO_MAX);
        w[i] = exp2f((float)KEEP * log2f(w[i]) + grow * log2f(ratio));
    }
}

static void update_rows(const pass *x, bench *b, size_t row, size_t count) {
    lq_stream *s = &x->fit->streams[x->k];
    const size_t packed = packed_size(s->bases);
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, (int)count, (int)packed, (int)s->columns, 1.0f,
                b->normal, (int)s->columns, x->outer, (int)packed, 0.0f, b->matrices, (int)packed);
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, (int)count, (int)s->bases, (int)s->columns, 1.0f,
                b->gradient, (int)s->columns, x->q[x->k], (int)s->bases, 0.0f, b->right, (int)s->bases);
    for (size_t i = 0; i < count; i++) {
        for (size_t a = 0; a < s->bases; a++) b->step[a] = (double)b->right[i * s->bases + a];
        if (!lq_normal_solve(b->matrices + i * packed, s->bases, b->full, b->step)) continue;
        for (size_t a = 0; a < s->bases; a++) s->p[(row + i) * s->bases + a] += b->step[a];
    }
}

static void pass_chunk(const pass *x, bench *b, size_t row) {
    const lq_fit *fit = x->fit;
    const lq_stream *stream = &fit->streams[x->k];
    const size_t count = row + CHUNK < fit->rows ? CHUNK : fit->rows - row;
    for (int k = 0; k < fit->stream_count; k++)
        stream_rows(&fit->streams[k], x->q[k], row, count, b->values[k], b->p);
    sums s = {b->normal, b->gradient, b->squares, x->reweight && x->weights ? b->size : NULL, 0.0};
    sum_samples(fit, x->k, x->weights, row, count, b->values, &s);
    memcpy(x->squares + row, b->squares, count * sizeof *x->squares);
    x->largest[row / CHUNK] = s.largest;
    if (s.size) reweigh(x, row, count, s.size);
    if (x->normal) {
        memcpy(x->normal + row * stream->columns, b->normal, count * stream->columns * sizeof(float));
        memcpy(x->gradient + row * stream->columns, b->gradient, count * stream->columns * sizeof(float));
    }
    if (x->update_p) update_rows(x, b, row, count);
}

static lq_status run_pass(pass *x, lq_error *error) {
    const lq_fit *fit = x->fit;
    bool failed = false;
    for (int k = 0; k < fit->stream_count; k++)
        to_float(fit->streams[k].q, x->q[k], fit->streams[k].columns * fit->streams[k].bases);
    outer_products(fit->streams[x->k].q, fit->streams[x->k].columns, fit->streams[x->k].bases, x->outer);
#pragma omp parallel if (lq_blas_reentrant())
    {
        bench b;
        if (bench_make(fit, &b)) {
#pragma omp for schedule(dynamic, 1)
            for (size_t row = 0; row < fit->rows; row += CHUNK) pass_chunk(x, &b, row);
        } else {
#pragma omp atomic write
            failed = true;
#pragma omp for schedule(dynamic, 1)
            for (size_t row = 0; row < fit->rows; row += CHUNK) {
            } /* every thread must come by */
        }
        bench_free(&b);
    }
    if (failed) return lq_fail(error, LQ_NO_MEMORY, "no memory to refine factors");
    double sum = 0.0;
    for (size_t row = 0; row < fit->rows; row++) sum += x->squares[row];
    x->rms = fmax(sqrt(sum / ((double)fit->rows * (double)fit->columns)), 1e-12);
    return LQ_OK;
}

/* ------------------------------------------------------------------ the separated side */

/* matrices[c] = sum_r normal[r][c] p_r p_r^T (packed), right[c] = sum_r gradient[r][c] p_r. */
static void column_sums(const pass *x, const float *outer, const float *p, float *matrices, float *right) {
    const lq_stream *s = &x->fit->streams[x->k];
    const size_t packed = packed_size(s->bases), rows = x->fit->rows;
#pragma omp parallel for schedule(static) if (lq_blas_reentrant())
    for (size_t c = 0; c < s->columns; c += CHUNK) {
        const size_t count = c + CHUNK < s->columns ? CHUNK : s->columns - c;
        cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, (int)count, (int)packed, (int)rows, 1.0f,
                    x->normal + c, (int)s->columns, outer, (int)packed, 0.0f, matrices + c * packed,
                    (int)packed);
        cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, (int)count, (int)s->bases, (int)rows, 1.0f,
                    x->gradient + c, (int)s->columns, p, (int)s->bases, 0.0f, right + c * s->bases,
                    (int)s->bases);
    }
}

static lq_status update_columns(const pass *x, lq_error *error) {
    lq_stream *s = &x->fit->streams[x->k];
    const size_t packed = packed_size(s->bases), rows = x->fit->rows;
    float *outer = malloc(rows * packed * sizeof *outer), *p = malloc(rows * s->bases * sizeof *p);
    float *matrices = malloc(s->columns * packed * sizeof *matrices);
    float *right = malloc(s->columns * s->bases * sizeof *right);
    lq_status status = LQ_OK;
    if (outer && p && matrices && right) {
        outer_products(s->p, rows, s->bases, outer);
        to_float(s->p, p, rows * s->bases);
        column_sums(x, outer, p, matrices, right);
        status = lq_columns_step(s, matrices, right, error);
    } else {
        status = lq_fail(error, LQ_NO_MEMORY, "no memory to refine factors");
    }
    free(outer);
    free(p);
    free(matrices);
    free(right);
    return status;
}

/* ------------------------------------------------------------------ sweeps */

static bool pass_make(pass *x, lq_fit *fit, bool with_columns) {
    *x = (pass){.fit = fit, .rms = 1.0};
    size_t columns = 1, packed = 1, bases = 1;
    for (int k = 0; k < fit->stream_count; k++) {
        const lq_stream *s = &fit->streams[k];
        columns = s->columns > columns ? s->columns : columns;
        bases = s->bases > bases ? s->bases : bases;
        packed = packed_size(bases);
        x->q[k] = malloc(s->columns * s->bases * sizeof(float));
        if (!x->q[k]) return false;
    }
    const size_t samples = fit->rows * fit->columns;
    x->outer = malloc(columns * packed * sizeof *x->outer);
    x->squares = malloc(fit->rows * sizeof *x->squares);
    x->largest = malloc((fit->rows / CHUNK + 1) * sizeof *x->largest);
    if (with_columns) {
        x->normal = malloc(fit->rows * columns * sizeof *x->normal);
        x->gradient = malloc(fit->rows * columns * sizeof *x->gradient);
        if (!x->normal || !x->gradient) return false;
    }
    if (fit->power > 2.0) {
        x->weights = malloc(samples * sizeof *x->weights);
        if (!x->weights) return false;
        for (size_t i = 0; i < samples; i++) x->weights[i] = 1.0f;
    }
    return x->outer && x->squares && x->largest;
}

static void pass_free(pass *x) {
    for (int k = 0; k < LQ_MAX_STREAMS; k++) free(x->q[k]);
    free(x->outer);
    free(x->squares);
    free(x->largest);
    free(x->normal);
    free(x->gradient);
    free(x->weights);
}

/* The unknowns of a fit, one after the other. */
static size_t unknowns(const lq_fit *fit) {
    size_t count = 0;
    for (int k = 0; k < fit->stream_count; k++) {
        const lq_stream *s = &fit->streams[k];
        count += (fit->rows + s->columns + s->pairs * (s->size[0] + s->size[1])) * s->bases;
    }
    return count;
}

static double *copy_block(double *block, size_t count, double *saved, bool save) {
    memcpy(save ? saved : block, save ? block : saved, count * sizeof *block);
    return saved + count;
}

static void copy_unknowns(lq_fit *fit, double *saved, bool save) {
    for (int k = 0; k < fit->stream_count; k++) {
        lq_stream *s = &fit->streams[k];
        saved = copy_block(s->p, fit->rows * s->bases, saved, save);
        saved = copy_block(s->q, s->columns * s->bases, saved, save);
        for (int a = 0; a < 2 && s->pairs > 0; a++)
            saved = copy_block(s->lines[a], s->bases * s->pairs * s->size[a], saved, save);
    }
}

/* The best state met: reweighting does not fall steadily. */
typedef struct best {
    double error;         /* of `saved`, in the norm asked for */
    double *saved, *last; /* `last` was copied before the sweep that measures it */
} best;

static double pass_error(const pass *x) {
    double largest = 0.0;
    for (size_t i = 0; i * CHUNK < x->fit->rows; i++) largest = fmax(largest, x->largest[i]);
    return x->fit->power > 2.0 ? largest : x->rms;
}

static void keep_better(const pass *x, best *b) {
    const double error = pass_error(x);
    if (!(error < b->error)) return;
    double *swap = b->saved;
    b->error = error;
    b->saved = b->last;
    b->last = swap;
}

/* Rows, then columns, of one stream. */
static lq_status sweep_stream(pass *x, int k, bool first, bool only_p, best *b, lq_error *error) {
    float *normal = x->normal, *gradient = x->gradient;
    x->k = k;
    x->update_p = true;
    x->reweight = k == 0 && !first;
    x->normal = x->gradient = NULL;
    lq_status status = run_pass(x, error);
    x->normal = normal;
    x->gradient = gradient;
    x->update_p = x->reweight = false;
    if (status == LQ_OK && k == 0) keep_better(x, b); /* the sums of this pass are of what it started from */
    if (status != LQ_OK || only_p) return status;
    status = run_pass(x, error);
    return status == LQ_OK ? update_columns(x, error) : status;
}

static lq_status run_sweeps(pass *x, int sweeps, bool only_p, const lq_progress *progress, best *b,
                            lq_error *error) {
    lq_status status = LQ_OK;
    for (int i = 0; i < sweeps && status == LQ_OK; i++) {
        copy_unknowns(x->fit, b->last, true);
        for (int k = 0; k < x->fit->stream_count && status == LQ_OK; k++)
            status = sweep_stream(x, k, i == 0, only_p, b, error);
        if (status == LQ_OK && progress && progress->report &&
            !progress->report(progress->user, (double)(i + 1) / sweeps))
            status = lq_fail(error, LQ_CANCELLED, "cancelled");
    }
    if (status != LQ_OK || sweeps == 0) return status;
    copy_unknowns(x->fit, b->last, true);
    status = run_pass(x, error);
    if (status == LQ_OK) keep_better(x, b);
    if (status == LQ_OK) copy_unknowns(x->fit, b->saved, false);
    return status;
}

lq_status lq_fit_refine(lq_fit *fit, int sweeps, bool only_p, const lq_progress *progress, lq_error *error) {
    pass x;
    const size_t count = unknowns(fit);
    best b = {INFINITY, malloc(count * sizeof(double)), malloc(count * sizeof(double))};
    lq_blas_begin();
    const bool made = pass_make(&x, fit, !only_p);
    const lq_status status = made && b.saved && b.last
                                 ? run_sweeps(&x, sweeps, only_p, progress, &b, error)
                                 : lq_fail(error, LQ_NO_MEMORY, "no memory to refine factors");
    lq_blas_end();
    pass_free(&x);
    free(b.saved);
    free(b.last);
    return status;
}

lq_status lq_fit_errors(const lq_fit *fit, double *largest, double *rms, lq_error *error) {
    pass x;
    lq_fit plain = *fit;
    plain.power = 2.0;
    lq_blas_begin();
    lq_status status = pass_make(&x, &plain, false) ? run_pass(&x, error)
                                                    : lq_fail(error, LQ_NO_MEMORY, "no memory for errors");
    *largest = 0.0;
    for (size_t i = 0; status == LQ_OK && i * CHUNK < fit->rows; i++) *largest = fmax(*largest, x.largest[i]);
    *rms = x.rms;
    lq_blas_end();
    pass_free(&x);
    return status;
}
