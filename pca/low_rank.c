/* low_rank.c - subspace iteration for the leading singular vectors, small dense problems by LAPACKE.
 *
 * Halko, Martinsson & Tropp 2011, algorithm 4.4: V <- orth(M^T (M V)), repeated; then M ~ (M V) V^T, turned
 * into singular vectors by the eigenvectors of the small (M V)^T (M V).
 */
#include "pca/low_rank.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "system/blas.h"
#include "system/status.h"

enum {
    SPARE = 8,  /* vectors beyond the rank: they let the last wanted ones converge */
    POWERS = 4, /* with SPARE, tables of these smooth functions are at the rms of the full SVD to 1e-3 */
    ROWS_A_TIME = 128 /* fixed, so that sums have one order for any number of threads */
};

static double *matrix(size_t rows, size_t columns) {
    return calloc(rows * columns, sizeof(double));
}

static lq_status no_memory(size_t rows, size_t columns, lq_error *error) {
    return lq_fail(error, LQ_NO_MEMORY, "no memory for a matrix of %zu x %zu", rows, columns);
}

/* ------------------------------------------------------------------ products with the large matrix */

/* out (rows x r) = m v: rows are independent. */
static void times(const float *m, size_t rows, size_t columns, const float *v, size_t r, float *out) {
#pragma omp parallel for schedule(static) if (lq_blas_reentrant())
    for (size_t row = 0; row < rows; row += ROWS_A_TIME) {
        const size_t count = row + ROWS_A_TIME < rows ? ROWS_A_TIME : rows - row;
        cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, (int)count, (int)r, (int)columns, 1.0f,
                    m + row * columns, (int)columns, v, (int)r, 0.0f, out + row * r, (int)r);
    }
}

/* out (columns x r) = m^T u: blocks of columns are independent. */
static void transposed_times(const float *m, size_t rows, size_t columns, const float *u, size_t r,
                             float *out) {
#pragma omp parallel for schedule(static) if (lq_blas_reentrant())
    for (size_t column = 0; column < columns; column += ROWS_A_TIME) {
        const size_t count = column + ROWS_A_TIME < columns ? ROWS_A_TIME : columns - column;
        cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, (int)count, (int)r, (int)rows, 1.0f, m + column,
                    (int)columns, u, (int)r, 0.0f, out + column * r, (int)r);
    }
}

/* ------------------------------------------------------------------ small problems */

/* The orthonormal basis of the columns of v (n x r, r <= n), in place. */
static bool orthonormalise(double *v, size_t n, size_t r) {
    double *tau = matrix(r, 1);
    const bool done = tau && LAPACKE_dgeqrf(LAPACK_ROW_MAJOR, (int)n, (int)r, v, (int)r, tau) == 0 &&
                      LAPACKE_dorgqr(LAPACK_ROW_MAJOR, (int)n, (int)r, (int)r, v, (int)r, tau) == 0;
    free(tau);
    return done;
}

/* Eigenvectors of the symmetric a (n x n) as columns in place, largest eigenvalue first in `values`. */
static bool eigenvectors(double *a, size_t n, double *values) {
    if (LAPACKE_dsyevd(LAPACK_ROW_MAJOR, 'V', 'U', (int)n, a, (int)n, values) != 0) return false;
    for (size_t i = 0; i < n / 2; i++) {
        const size_t j = n - 1 - i;
        const double swap = values[i];
        values[i] = values[j];
        values[j] = swap;
        for (size_t row = 0; row < n; row++) {
            const double entry = a[row * n + i];
            a[row * n + i] = a[row * n + j];
            a[row * n + j] = entry;
        }
    }
    return true;
}

static void multiply(const double *a, size_t rows, size_t inner, const double *b, size_t columns,
                     double *out) {
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, (int)rows, (int)columns, (int)inner, 1.0, a,
                (int)inner, b, (int)columns, 0.0, out, (int)columns);
}

/* out (n x n) = a^T a of a (rows x n). */
static void gram(const double *a, size_t rows, size_t n, double *out) {
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, (int)n, (int)n, (int)rows, 1.0, a, (int)n, a, (int)n,
                0.0, out, (int)n);
}

/* Each column of `right` gets its largest entry positive; the product stays. */
static void fix_signs(double *left, size_t rows, double *right, size_t columns, size_t rank) {
    for (size_t k = 0; k < rank; k++) {
        double largest = 0.0;
        for (size_t c = 0; c < columns; c++)
            if (fabs(right[c * rank + k]) > fabs(largest)) largest = right[c * rank + k];
        if (largest >= 0.0) continue;
        for (size_t c = 0; c < columns; c++) right[c * rank + k] = -right[c * rank + k];
        for (size_t p = 0; p < rows; p++) left[p * rank + k] = -left[p * rank + k];
    }
}

/* ------------------------------------------------------------------ subspace iteration */

typedef struct subspace {
    size_t r;
    float *v, *u;   /* columns x r, rows x r */
    double *basis;  /* columns x r, orthonormal */
    double *mapped; /* rows x r: m basis */
} subspace;

static void start(double *v, size_t columns, size_t r) {
    for (size_t i = 0; i < columns * r; i++) {
        uint64_t z = (i + 1) * 0x9e3779b97f4a7c15u; /* splitmix64 (Steele et al. 2014) */
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        v[i] = (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
    }
}

static void to_float(const double *from, float *to, size_t count) {
    for (size_t i = 0; i < count; i++) to[i] = (float)from[i];
}

static void to_double(const float *from, double *to, size_t count) {
    for (size_t i = 0; i < count; i++) to[i] = (double)from[i];
}

static bool iterate(const float *m, size_t rows, size_t columns, subspace *s) {
    start(s->basis, columns, s->r);
    if (!orthonormalise(s->basis, columns, s->r)) return false;
    for (int i = 0; i <= POWERS; i++) {
        to_float(s->basis, s->v, columns * s->r);
        times(m, rows, columns, s->v, s->r, s->u);
        if (i == POWERS) break;
        transposed_times(m, rows, columns, s->u, s->r, s->v);
        to_double(s->v, s->basis, columns * s->r);
        if (!orthonormalise(s->basis, columns, s->r)) return false;
    }
    to_double(s->u, s->mapped, rows * s->r);
    return true;
}

/* The leading `rank` of the subspace, as singular vectors. */
static bool rotate(const subspace *s, size_t rows, size_t columns, size_t rank, double *left, double *right) {
    const size_t r = s->r, kept = rank < r ? rank : r;
    double *small = matrix(r, r), *values = matrix(r, 1), *turn = matrix(r, rank);
    bool done = small && values && turn;
    if (done) gram(s->mapped, rows, r, small);
    done = done && eigenvectors(small, r, values);
    for (size_t i = 0; done && i < r; i++)
        for (size_t k = 0; k < kept; k++) turn[i * rank + k] = small[i * r + k];
    if (done) multiply(s->mapped, rows, r, turn, rank, left);
    if (done) multiply(s->basis, columns, r, turn, rank, right);
    free(small);
    free(values);
    free(turn);
    return done;
}

lq_status lq_low_rank(const float *m, size_t rows, size_t columns, size_t rank, double *left, double *right,
                      lq_error *error) {
    const size_t most = rows < columns ? rows : columns;
    subspace s = {.r = rank + SPARE < most ? rank + SPARE : most};
    lq_blas_begin();
    s.v = malloc(columns * s.r * sizeof *s.v);
    s.u = malloc(rows * s.r * sizeof *s.u);
    s.basis = matrix(columns, s.r);
    s.mapped = matrix(rows, s.r);
    lq_status status = LQ_OK;
    if (!s.v || !s.u || !s.basis || !s.mapped) status = no_memory(rows, s.r, error);
    else if (!iterate(m, rows, columns, &s) || !rotate(&s, rows, columns, rank, left, right))
        status = lq_fail(error, LQ_BAD_INPUT,
                         "no singular vectors of a %zu x %zu matrix: it holds infinities", rows, columns);
    if (status == LQ_OK) fix_signs(left, rows, right, columns, rank);
    lq_blas_end();
    free(s.v);
    free(s.u);
    free(s.basis);
    free(s.mapped);
    return status;
}

/* ------------------------------------------------------------------ canonical form */

/* root = a^(1/2) and inverse = a^(-1/2) of a Gram matrix, with what is below its rounding left out. */
static bool roots(double *a, size_t n, double *root, double *inverse) {
    double *values = matrix(n, 1), *scaled = matrix(n, n);
    bool done = values && scaled && eigenvectors(a, n, values);
    for (int side = 0; done && side < 2; side++) {
        for (size_t i = 0; i < n; i++)
            for (size_t k = 0; k < n; k++) {
                const double size = values[k] > 1e-14 * values[0] ? sqrt(values[k]) : 0.0;
                scaled[i * n + k] = a[i * n + k] * (side == 0 ? size : size > 0.0 ? 1.0 / size : 0.0);
            }
        cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, (int)n, (int)n, (int)n, 1.0, scaled, (int)n, a,
                    (int)n, 0.0, side == 0 ? root : inverse, (int)n);
    }
    free(values);
    free(scaled);
    return done;
}

/* left <- left S^(1/2) W and right <- right S^(-1/2) W, S the Gram matrix of `right`, W the eigenvectors of
 * the Gram matrix of the new left. */
static bool turn_both(double *left, size_t rows, double *right, size_t columns, size_t rank, double *space) {
    double *s = space, *root = s + rank * rank, *inverse = root + rank * rank, *w = inverse + rank * rank;
    double *values = w + rank * rank, *first = values + rank, *second = first + rows * rank;
    gram(right, columns, rank, s);
    if (!roots(s, rank, root, inverse)) return false;
    multiply(left, rows, rank, root, rank, first);
    multiply(right, columns, rank, inverse, rank, second);
    gram(first, rows, rank, w);
    if (!eigenvectors(w, rank, values)) return false;
    multiply(first, rows, rank, w, rank, left);
    multiply(second, columns, rank, w, rank, right);
    return true;
}

lq_status lq_canonical(double *left, size_t rows, double *right, size_t columns, size_t rank,
                       lq_error *error) {
    double *space = matrix(rank, 4 * rank + 1 + rows + columns);
    lq_blas_begin();
    lq_status status = space ? LQ_OK : no_memory(rows, rank, error);
    if (status == LQ_OK && !turn_both(left, rows, right, columns, rank, space))
        status = lq_fail(error, LQ_BAD_INPUT, "no singular vectors of a %zu x %zu product", rows, columns);
    if (status == LQ_OK) fix_signs(left, rows, right, columns, rank);
    lq_blas_end();
    free(space);
    return status;
}
