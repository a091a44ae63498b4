/* Restarted GMRES on lanes of eight. */
#include "precompute/krylov.h"

#include "precompute/nodes.h"

#include <math.h>
#include <stdlib.h>

enum { BASIS = 60 }; /* products between restarts: 100 MB at the finest level */

typedef struct arnoldi {
    size_t size;
    bool joined;
    lq_v8 *v;                  /* [k * size]: orthonormal */
    lq_v8 h[BASIS + 1][BASIS]; /* what the products came to, rotated to a triangle */
    lq_v8 c[BASIS], s[BASIS];  /* the rotations */
    lq_v8 g[BASIS + 1];        /* the residual, rotated: |g[k]| is left after k products */
} arnoldi;

static void dot(size_t n, bool joined, const lq_v8 *a, const lq_v8 *b, lq_v8 *out) {
    lq_v8 sum = {0.0};
    double all = 0.0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    for (int l = 0; l < LQ_LANES; l++) all += sum[l];
    *out = joined ? (lq_v8){0.0} + all : sum;
}

/* The norm, and its inverse: 0 for 0, so that a lane that is done stays as it is. */
static void norm_of(size_t n, bool joined, const lq_v8 *a, lq_v8 *norm, lq_v8 *inverse) {
    dot(n, joined, a, a, norm);
    for (int l = 0; l < LQ_LANES; l++) {
        (*norm)[l] = sqrt((*norm)[l]);
        (*inverse)[l] = (*norm)[l] > 1e-300 ? 1.0 / (*norm)[l] : 0.0;
    }
}

static double largest(const lq_v8 *x) {
    double most = 0.0;
    for (int l = 0; l < LQ_LANES; l++) most = fmax(most, fabs((*x)[l]));
    return most;
}

/* v[0] and g[0] from the residual of x. */
static void restart(arnoldi *a, lq_krylov_apply *apply, void *user, const lq_v8 *b, const lq_v8 *x) {
    lq_v8 *r = a->v, scale;
    apply(user, x, r);
    for (size_t i = 0; i < a->size; i++) r[i] += b[i] - x[i];
    norm_of(a->size, a->joined, r, &a->g[0], &scale);
    for (size_t i = 0; i < a->size; i++) r[i] *= scale;
}

/* v[k + 1] from (1 - M) v[k], by modified Gram-Schmidt. */
static void extend(arnoldi *a, lq_krylov_apply *apply, void *user, int k) {
    const size_t n = a->size;
    const lq_v8 *v = a->v + (size_t)k * n;
    lq_v8 *w = a->v + (size_t)(k + 1) * n, scale;
    apply(user, v, w);
    for (size_t i = 0; i < n; i++) w[i] = v[i] - w[i];
    for (int j = 0; j <= k; j++) {
        const lq_v8 *u = a->v + (size_t)j * n;
        lq_v8 h;
        dot(n, a->joined, u, w, &h);
        for (size_t i = 0; i < n; i++) w[i] -= h * u[i];
        a->h[j][k] = h;
    }
    norm_of(n, a->joined, w, &a->h[k + 1][k], &scale);
    for (size_t i = 0; i < n; i++) w[i] *= scale;
}

/* Column k of h: the rotations so far, and the one that clears what lies below the diagonal. */
static void rotate(arnoldi *a, int k) {
    for (int j = 0; j < k; j++) {
        const lq_v8 top = a->h[j][k], low = a->h[j + 1][k];
        a->h[j][k] = a->c[j] * top + a->s[j] * low;
        a->h[j + 1][k] = a->c[j] * low - a->s[j] * top;
    }
    const lq_v8 both[2] = {a->h[k][k], a->h[k + 1][k]};
    lq_v8 scale;
    norm_of(2, false, both, &a->h[k][k], &scale);
    a->c[k] = both[0] * scale;
    a->s[k] = both[1] * scale;
    a->g[k + 1] = -a->s[k] * a->g[k];
    a->g[k] = a->c[k] * a->g[k];
}

/* x += the combination of v[0 .. count - 1] with the smallest residual. */
static void add_solution(const arnoldi *a, int count, lq_v8 *x) {
    lq_v8 y[BASIS];
    for (int k = count - 1; k >= 0; k--) {
        lq_v8 rest = a->g[k];
        for (int j = k + 1; j < count; j++) rest -= a->h[k][j] * y[j];
        for (int l = 0; l < LQ_LANES; l++) y[k][l] = a->h[k][k][l] > 0.0 ? rest[l] / a->h[k][k][l] : 0.0;
    }
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < a->size; i++) x[i] += y[k] * a->v[(size_t)k * a->size + i];
}

double lq_krylov_solve(lq_krylov_apply *apply, void *user, size_t size, bool joined, const lq_v8 *b, lq_v8 *x,
                       int most, double tolerance) {
    arnoldi *a = (arnoldi *)(void *)lq_zeros(sizeof *a / sizeof(double));
    lq_v8 norm, inverse;
    double left = -1.0;
    if (a) a->size = size;
    if (a) a->joined = joined;
    if (a) a->v = (lq_v8 *)(void *)lq_zeros((BASIS + 1) * size * LQ_LANES);
    norm_of(size, joined, b, &norm, &inverse);
    const double scale = largest(&norm) > 0.0 ? 1.0 / largest(&norm) : 1.0;
    for (int used = 0; a && a->v && used < most;) {
        restart(a, apply, user, b, x);
        used++;
        left = largest(&a->g[0]) * scale;
        int k = 0;
        for (; k < BASIS && used < most && left > tolerance; k++, used++) {
            extend(a, apply, user, k);
            rotate(a, k);
            left = largest(&a->g[k + 1]) * scale;
        }
        if (k == 0) break;
        add_solution(a, k, x);
        if (left <= tolerance) break;
    }
    if (a) free(a->v);
    free(a);
    return left;
}
