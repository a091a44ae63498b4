/* The loops behind kernels.h. LQ_KERNELS is the name of the function that returns this copy. */
#include "precompute/kernels.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Natural logarithm of a positive normal number, to 2 ulp, in operations that vectorise: x = 2^e m with m in
 * [1/sqrt 2, sqrt 2), log m = 2 artanh((m-1)/(m+1)). */
static inline double log_positive(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    const uint64_t fraction = (bits & 0xfffffffffffffu) | 0x3ff0000000000000u;
    const uint64_t biased = (bits >> 52) | 0x4330000000000000u; /* 2^52 + the biased exponent, as a double */
    double m, e;
    memcpy(&m, &fraction, sizeof m);
    memcpy(&e, &biased, sizeof e);
    e -= 4503599627370496.0 + 1023.0;
    const double wide = m > 1.4142135623730951 ? 1.0 : 0.0;
    e += wide;
    m -= 0.5 * wide * m;
    const double s = (m - 1.0) / (m + 1.0), s2 = s * s;
    double p = 1.0 / 21.0;
    for (int k = 19; k >= 1; k -= 2) p = p * s2 + 1.0 / k;
    return e * 0.69314718055994530942 + 2.0 * s * p;
}

static void map_cosines(const lq_cosine_map *map, size_t count, const double *restrict cosine,
                        double *restrict x) {
    const double inverse = map->inverse_alpha, scale = map->scale, shift = map->shift;
    const double half = map->half_angle ? 1.0 : 0.0, from = map->from, sign = map->root;
    if (map->root) {
        for (size_t i = 0; i < count; i++) {
            const double apart = sign * (cosine[i] - from);
            x[i] = scale * sqrt(apart > 0.0 ? apart : 0.0) + shift;
        }
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const double sine2 = (1.0 - cosine[i]) * (1.0 + cosine[i]);
        const double t = 2.0 * cosine[i] / (1.0 + sqrt(sine2));
        const double y = inverse * (cosine[i] + half * (t - cosine[i]));
        x[i] = log_positive(y + sqrt(y * y + 1.0));
    }
    if (map->rooted)
        for (size_t i = 0; i < count; i++) x[i] = sqrt(x[i] > 0.0 ? x[i] : 0.0);
    for (size_t i = 0; i < count; i++) x[i] = scale * x[i] + shift;
}

/* Add the moments of `groups` vectors of facets to sum[m]. The recurrence of T_m is started from the weight
 * instead of 1. Several vectors at once hide its latency, and share the load and store of a sum. */
static inline void moments_of(int groups, const double *x, const double *w, int count, lq_v8 *sum) {
    lq_v8 two_x[4], before[4], now[4];
    for (int g = 0; g < groups; g++) {
        memcpy(&now[g], x + g * LQ_LANES, sizeof now[g]);
        memcpy(&before[g], w + g * LQ_LANES, sizeof before[g]);
        two_x[g] = now[g] + now[g];
        now[g] *= before[g];
        sum[0] += before[g];
    }
    for (int m = 1; m < count; m++) {
        lq_v8 total = sum[m];
        for (int g = 0; g < groups; g++) {
            const lq_v8 next = two_x[g] * now[g] - before[g];
            total += now[g];
            before[g] = now[g];
            now[g] = next;
        }
        sum[m] = total;
    }
}

typedef long long lq_i8 __attribute__((vector_size(64)));

/* Raise each lane of `most` to |a - b|, unless that is not a number. */
static inline void raise_change(lq_v8 *most, const lq_v8 *a, const lq_v8 *b) {
    const lq_v8 change = (lq_v8)((lq_i8)(*a - *b) & INT64_MAX);
    const lq_i8 greater = change > *most;
    *most = (lq_v8)(((lq_i8)change & greater) | ((lq_i8)*most & ~greater));
}

/* Even and odd lanes, pairs and fours of v[0] and v[1], added; by address, as vectors wider than the
 * processor's have no agreed way to be passed. */
static inline void add_ones(const lq_v8 *v, lq_v8 *sum) {
    *sum = __builtin_shufflevector(v[0], v[1], 0, 8, 2, 10, 4, 12, 6, 14) +
           __builtin_shufflevector(v[0], v[1], 1, 9, 3, 11, 5, 13, 7, 15);
}

static inline void add_twos(const lq_v8 *v, lq_v8 *sum) {
    *sum = __builtin_shufflevector(v[0], v[1], 0, 1, 8, 9, 4, 5, 12, 13) +
           __builtin_shufflevector(v[0], v[1], 2, 3, 10, 11, 6, 7, 14, 15);
}

static inline void add_fours(const lq_v8 *v, lq_v8 *sum) {
    *sum = __builtin_shufflevector(v[0], v[1], 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(v[0], v[1], 4, 5, 6, 7, 12, 13, 14, 15);
}

/* The sums of the lanes of eight vectors: three rounds of adding halves. */
static inline void add_lanes(const lq_v8 *v, double *restrict out) {
    lq_v8 a[4], b[2], total;
    for (int i = 0; i < 4; i++) add_ones(v + 2 * i, a + i);
    for (int i = 0; i < 2; i++) add_twos(a + 2 * i, b + i);
    add_fours(b, &total);
    for (int l = 0; l < LQ_LANES; l++) out[l] += total[l];
}

static void moments(const lq_cosine_map *map, size_t count, const double *cosine, const double *weight,
                    int count_moments, double *out) {
    double x[LQ_FACETS_MAX], w[LQ_FACETS_MAX];
    lq_v8 sum[LQ_NODES_MAX + LQ_LANES];
    const size_t groups = (count + LQ_LANES - 1) / LQ_LANES;
    const int padded = (count_moments + LQ_LANES - 1) / LQ_LANES * LQ_LANES;
    map_cosines(map, count, cosine, x);
    for (size_t i = 0; i < groups * LQ_LANES; i++) w[i] = i < count ? weight[i] : 0.0;
    for (size_t i = count; i < groups * LQ_LANES; i++) x[i] = 0.0;
    memset(sum, 0, (size_t)padded * sizeof sum[0]);
    size_t g = 0;
    for (; g + 4 <= groups; g += 4) moments_of(4, x + g * LQ_LANES, w + g * LQ_LANES, count_moments, sum);
    for (; g + 2 <= groups; g += 2) moments_of(2, x + g * LQ_LANES, w + g * LQ_LANES, count_moments, sum);
    if (g < groups) moments_of(1, x + g * LQ_LANES, w + g * LQ_LANES, count_moments, sum);
    for (int m = 0; m < count_moments; m += LQ_LANES) {
        double eight[LQ_LANES] = {0.0};
        add_lanes(sum + m, eight);
        for (int l = 0; l < LQ_LANES && m + l < count_moments; l++) out[m + l] += eight[l];
    }
}

/* The same for three weights of each cosine: the polynomials are made once. */
static inline void moments3_of(int groups, const double *x, const double *w, int count, lq_v8 *sum) {
    lq_v8 two_x[4], before[4], now[4], weight[3][4];
    for (int g = 0; g < groups; g++) {
        memcpy(&now[g], x + g * LQ_LANES, sizeof now[g]);
        two_x[g] = now[g] + now[g];
        before[g] = (lq_v8){1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
        for (int k = 0; k < 3; k++) {
            memcpy(&weight[k][g], w + k * LQ_FACETS_MAX + g * LQ_LANES, sizeof weight[k][g]);
            sum[k] += weight[k][g];
        }
    }
    for (int m = 1; m < count; m++) {
        lq_v8 a = sum[3 * m], b = sum[3 * m + 1], c = sum[3 * m + 2];
        for (int g = 0; g < groups; g++) {
            const lq_v8 next = two_x[g] * now[g] - before[g];
            a += weight[0][g] * now[g];
            b += weight[1][g] * now[g];
            c += weight[2][g] * now[g];
            before[g] = now[g];
            now[g] = next;
        }
        sum[3 * m] = a;
        sum[3 * m + 1] = b;
        sum[3 * m + 2] = c;
    }
}

static void moments3(const lq_cosine_map *map, size_t count, const double *cosine,
                     const double *const *weight, int count_moments, double *const *out) {
    double x[LQ_FACETS_MAX], w[3 * LQ_FACETS_MAX];
    lq_v8 sum[3 * (LQ_NODES_MAX + LQ_LANES)];
    const size_t groups = (count + LQ_LANES - 1) / LQ_LANES;
    const int padded = (3 * count_moments + LQ_LANES - 1) / LQ_LANES * LQ_LANES;
    map_cosines(map, count, cosine, x);
    for (size_t i = count; i < groups * LQ_LANES; i++) x[i] = 0.0;
    for (size_t k = 0; k < 3; k++)
        for (size_t i = 0; i < groups * LQ_LANES; i++)
            w[k * LQ_FACETS_MAX + i] = i < count ? weight[k][i] : 0.0;
    memset(sum, 0, (size_t)padded * sizeof sum[0]);
    size_t g = 0;
    for (; g + 4 <= groups; g += 4) moments3_of(4, x + g * LQ_LANES, w + g * LQ_LANES, count_moments, sum);
    for (; g + 2 <= groups; g += 2) moments3_of(2, x + g * LQ_LANES, w + g * LQ_LANES, count_moments, sum);
    if (g < groups) moments3_of(1, x + g * LQ_LANES, w + g * LQ_LANES, count_moments, sum);
    for (int m = 0; m < 3 * count_moments; m += LQ_LANES) {
        double eight[LQ_LANES] = {0.0};
        add_lanes(sum + m, eight);
        for (int l = 0; l < LQ_LANES && m + l < 3 * count_moments; l++)
            out[(m + l) % 3][(m + l) / 3] += eight[l];
    }
}

static double escaping(double area_in, double mu_i, size_t count, const double *restrict mu_o,
                       const double *restrict area, const double *restrict weight) {
    double part[LQ_LANES] = {0.0}, total = 0.0;
    size_t i = 0;
    for (; i + LQ_LANES <= count; i += LQ_LANES)
        for (size_t l = 0; l < LQ_LANES; l++) {
            const double lit = area_in * mu_o[i + l], sum = lit + area[i + l] * mu_i;
            part[l] += weight[i + l] * (sum > 0.0 ? lit / sum : 1.0);
        }
    for (; i < count; i++) {
        const double lit = area_in * mu_o[i], sum = lit + area[i] * mu_i;
        total += weight[i] * (sum > 0.0 ? lit / sum : 1.0);
    }
    for (int l = 0; l < LQ_LANES; l++) total += part[l];
    return total;
}

static void spread(int curves, const double *restrict curve, int count, const double *restrict moment,
                   double *restrict sums) {
    for (int k = 0; k < curves; k++)
        for (int m = 0; m < count; m++) sums[k * count + m] += curve[k] * moment[m];
}

/* out = operators of curve 0 minus the absorptances times their coefficients; eight elements at a time, so
 * that a coefficient is loaded once for eight multiplications. */
static void combine(const lq_sylvester *s, const double *restrict operators, lq_v8 *restrict out) {
    for (size_t e = 0; e < s->stride; e += 8) {
        lq_v8 sum[8];
        const double *p = operators + e;
        for (int b = 0; b < 8; b++) sum[b] = (lq_v8){0.0} + p[b];
        for (int k = 1; k < s->curves; k++) {
            const lq_v8 c = s->coefficients[k];
            p += s->stride;
            for (int b = 0; b < 8; b++) sum[b] -= c * p[b];
        }
        for (int b = 0; b < 8; b++) out[e + (size_t)b] = sum[b];
    }
}

static void assemble(const lq_sylvester *s) {
    combine(s, s->dd, s->down);
    combine(s, s->du, s->source);
    combine(s, s->uu, s->up);
    for (int i = 0; i < s->nodes; i++)
        for (int j = 0; j < s->nodes; j++) {
            s->down[i * s->nodes + j] *= s->a_down[i];
            s->source[i * s->nodes + j] *= s->a_down[i];
            s->up[i * s->nodes + j] *= s->a_up[j];
        }
}

/* Row i of the sweep without what changes inside the row: partial_j = S_ij + sum_(k != i) A_ik R_kj. */
static void row_partial(const lq_sylvester *s, int i, lq_v8 *restrict partial) {
    const int n = s->nodes;
    const lq_v8 *a = s->down + (size_t)i * (size_t)n;
    for (int j = 0; j < n; j += 4) {
        const int width = n - j < 4 ? n - j : 4;
        lq_v8 sum[4] = {{0.0}};
        for (int b = 0; b < width; b++) sum[b] = s->source[i * n + j + b];
        if (width == 4) {
            for (int k = 0; k < n; k++) {
                if (k == i) continue;
                const lq_v8 f = a[k];
                const lq_v8 *r = s->r + (size_t)k * (size_t)n + j;
                for (int b = 0; b < 4; b++) sum[b] += f * r[b];
            }
        } else {
            for (int k = 0; k < n; k++)
                for (int b = 0; b < width && k != i; b++) sum[b] += a[k] * s->r[k * n + j + b];
        }
        for (int b = 0; b < width; b++) partial[j + b] = sum[b];
    }
}

static double largest_change(const lq_v8 *a, const lq_v8 *b) {
    double most = 0.0;
    for (int l = 0; l < LQ_LANES; l++) {
        const double change = fabs((*a)[l] - (*b)[l]);
        most = change > most ? change : most;
    }
    return most;
}

static double sweep(const lq_sylvester *s) {
    const int n = s->nodes;
    lq_v8 partial[LQ_NODES_MAX];
    double most = 0.0;
    for (int i = 0; i < n; i++) {
        lq_v8 *row = s->r + (size_t)i * (size_t)n;
        const lq_v8 own = s->down[i * n + i];
        row_partial(s, i, partial);
        for (int j = 0; j < n; j++) {
            const lq_v8 *b = s->up + (size_t)j * (size_t)n;
            lq_v8 even = partial[j], odd = {0.0};
            int k = 0;
            for (; k + 1 < n; k += 2) {
                even += row[k] * b[k];
                odd += row[k + 1] * b[k + 1];
            }
            if (k < n) even += row[k] * b[k];
            const lq_v8 self = b[j];
            const lq_v8 value = (even + odd - row[j] * self) / (s->a_down[i] + s->a_up[j] - own - self);
            const double change = largest_change(&value, &row[j]);
            most = change > most ? change : most;
            row[j] = value;
        }
    }
    return most;
}

static void survival(const lq_sylvester *s, lq_v8 *ratio) {
    const int n = s->nodes;
    for (int i = 0; i < n; i++) {
        lq_v8 later = {0.0}, remaining = {0.0};
        for (int j = 0; j < n; j++) {
            const double escape = 1.0 / (s->a_down[i] + s->a_up[j]);
            const lq_v8 source = s->source[i * n + j]; /* a_down du */
            later += s->r[i * n + j] - escape * source;
            remaining += (s->down[i * n + j] + s->a_up[j] * escape * source) / s->a_down[i];
        }
        if (s->loses) {
            ratio[i] = remaining - later;
            continue;
        }
        /* Where next to nothing remains, both sums are rounding and interpolation: the ratio of the node
         * before, closer to grazing, is carried on. (F = 1 gives 1 all the way.) */
        for (int l = 0; l < LQ_LANES; l++) {
            const double before = i > 0 ? ratio[i - 1][l] : 1.0;
            const double r = (later[l] + s->negligible * before) / (remaining[l] + s->negligible);
            ratio[i][l] = r > 0.0 ? (r < 1.0 ? r : 1.0) : 0.0;
        }
    }
}

static void read_energies(const lq_readout *readout, const lq_sylvester *s, const lq_v8 *ratio,
                          lq_v8 *restrict energy) {
    for (size_t m = 0; m < readout->count; m++) {
        const double *first = readout->escaping + m * (size_t)s->curves;
        const double *rest = readout->remaining + m * (size_t)s->curves;
        const double *weight = readout->weights + m * (size_t)s->nodes;
        lq_v8 escaping = (lq_v8){0.0} + first[0], remaining = (lq_v8){0.0} + rest[0], leaves = {0.0};
        for (int k = 1; k < s->curves; k++) {
            const lq_v8 c = s->coefficients[k];
            escaping -= c * first[k];
            remaining -= c * rest[k];
        }
        for (int i = 0; i < s->nodes; i++) leaves += weight[i] * ratio[i];
        energy[m] = s->loses ? escaping + remaining - leaves : escaping + remaining * leaves;
    }
}

/* E(u_k) of one node = direct + sum_l weights[k][l] C(u_l), at every depth; C and E are `step` apart. Four
 * depths at a time: all depth counts are multiples of four. */
static double travel_node(int depths, const double *weights, const lq_v8 *c, size_t step, const lq_v8 *direct,
                          lq_v8 *e) {
    lq_v8 change = {0.0};
    for (int k = 0; k < depths; k += 4) {
        const double *w = weights + k * depths;
        lq_v8 sum[4];
        for (int b = 0; b < 4; b++) sum[b] = direct[k + b];
        for (int l = 0; l < depths; l++) {
            const lq_v8 value = c[(size_t)l * step];
            for (int b = 0; b < 4; b++) sum[b] += w[b * depths + l] * value;
        }
        for (int b = 0; b < 4; b++) {
            lq_v8 *at = &e[(size_t)(k + b) * step];
            raise_change(&change, &sum[b], at);
            *at = sum[b];
        }
    }
    double most = 0.0;
    for (int l = 0; l < LQ_LANES; l++) most = change[l] > most ? change[l] : most;
    return most;
}

static double travel(const lq_two_sided *s, const double *survival) {
    const int n = s->nodes;
    const size_t step = 2 * (size_t)n, matrix = (size_t)s->depths * (size_t)s->depths;
    const lq_v8 none[LQ_DEPTHS_LIMIT] = {{0.0}};
    lq_v8 direct[LQ_DEPTHS_LIMIT];
    double most = 0.0;
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < s->depths; k++) direct[k] = survival[k * n + j] * s->reward[j];
        const double up = travel_node(s->depths, s->travel_up + (size_t)j * matrix, s->before + j, step,
                                      direct, s->own + j);
        const double down = travel_node(s->depths, s->travel_down + (size_t)j * matrix, s->before + n + j,
                                        step, none, s->own + n + j);
        most = up > most ? up : most;
        most = down > most ? down : most;
    }
    return most;
}

/* A vector of weights, wherever it starts. */
typedef double lq_v8_anywhere __attribute__((vector_size(64), aligned(8)));

/* E of one node at eight depths from `first` on: out[b] += sum_l weights[first + b][l] C(u_l). */
static void travel_eight(int depths, int first, const double *weights, const lq_v8 *c, size_t step,
                         double *out) {
    lq_v8 sum[LQ_LANES] = {{0.0}};
    const int blocks = (depths + LQ_LANES - 1) / LQ_LANES;
    const int rows = depths - first < LQ_LANES ? depths - first : LQ_LANES;
    for (int b = 0; b < rows; b++) {
        const double *w = weights + (first + b) * depths;
        for (int l = 0; l < blocks; l++)
            sum[b] += *(const lq_v8_anywhere *)(const void *)(w + l * LQ_LANES) * c[(size_t)l * step];
    }
    add_lanes(sum, out);
}

/* One direction q of a side, all depths: out[depth] comes with what is there without any hit. */
static double travel_packed_node(const lq_two_sided *s, int q, const double *weights, double *out) {
    const size_t step = 2 * (size_t)s->nodes;
    const int last = s->depths - 1, blocks = last / LQ_LANES;
    double most = 0.0;
    for (int k = 0; k <= last; k += LQ_LANES)
        travel_eight(s->depths, k, weights, s->before + q, step, out + k);
    for (int k = 0; k <= last; k++) {
        double *at = (double *)(s->own + (size_t)(k / LQ_LANES) * step + q) + k % LQ_LANES;
        const int back = last - k;
        const double change = fabs(out[k] - *at);
        most = change > most ? change : most;
        *at = out[k];
        ((double *)(s->mirrored + (size_t)(blocks - back / LQ_LANES) * step + q))[back % LQ_LANES] = out[k];
    }
    return most;
}

static double travel_packed(const lq_two_sided *s, const double *survival) {
    const int n = s->nodes;
    const size_t matrix = (size_t)s->depths * (size_t)s->depths;
    double most = 0.0;
    for (int j = 0; j < n; j++) {
        double rising[LQ_DEPTHS_LIMIT + LQ_LANES] = {0.0}, falling[LQ_DEPTHS_LIMIT + LQ_LANES] = {0.0};
        for (int k = 0; k < s->depths; k++) rising[k] = survival[k * n + j] * s->reward[j][0];
        const double up = travel_packed_node(s, j, s->travel_up + (size_t)j * matrix, rising);
        const double down = travel_packed_node(s, n + j, s->travel_down + (size_t)j * matrix, falling);
        most = up > most ? up : most;
        most = down > most ? down : most;
    }
    return most;
}

/* Four rows of a facet operator against the directions of both sides at one depth. */
static inline void meet_rows(int rows, int n, const double *operators, const lq_v8 *own, const lq_v8 *other,
                             lq_v8 *out) {
    lq_v8 sum[4] = {{0.0}};
    const double *p = operators;
    for (int q = 0; q < 2 * n; q++)
        for (int r = 0; r < rows; r++) sum[r] += p[r * 4 * n + q] * own[q];
    p += 2 * n;
    for (int q = 0; q < 2 * n; q++)
        for (int r = 0; r < rows; r++) sum[r] += p[r * 4 * n + q] * other[q];
    for (int r = 0; r < rows; r++) out[r] = sum[r];
}

static void meet(const lq_two_sided *s) {
    const int n = s->nodes;
    for (int k = 0; k < s->depths; k++) {
        const lq_v8 *own = s->own + (size_t)k * 2 * (size_t)n;
        const lq_v8 *other = s->other + (size_t)(s->depths - 1 - k) * 2 * (size_t)n;
        lq_v8 *c = s->before + (size_t)k * 2 * (size_t)n;
        /* All node counts are multiples of four. */
        for (int i = 0; i < n; i += 4) {
            meet_rows(4, n, s->rise + (size_t)i * 4 * (size_t)n, own, other, c + i);
            meet_rows(4, n, s->fall + (size_t)i * 4 * (size_t)n, own, other, c + n + i);
        }
    }
}

static void average(int depths, int directions, const double *restrict arrival, int backwards,
                    const lq_v8 *restrict e, lq_v8 *restrict out) {
    memset(out, 0, (size_t)directions * sizeof *out);
    for (int k = 0; k < depths; k++) {
        const double a = arrival[backwards ? depths - 1 - k : k];
        const lq_v8 *at = e + (size_t)k * (size_t)directions;
        for (int q = 0; q < directions; q++) out[q] += a * at[q];
    }
}

static void contract(int depths, int nodes, const double *restrict weights, const lq_v8 *restrict c,
                     lq_v8 *restrict out) {
    lq_v8 sum[4] = {{0.0}};
    for (int k = 0; k < depths; k++) {
        const double *weight = weights + (size_t)k * (size_t)nodes;
        const lq_v8 *at = c + (size_t)k * 2 * (size_t)nodes;
        for (int j = 0; j < nodes; j++) sum[j % 4] += weight[j] * at[j];
    }
    *out = sum[0] + sum[1] + (sum[2] + sum[3]);
}

static void arrive(int depths, int nodes, const double *restrict arrival, int backwards,
                   const double *restrict weight, const lq_v8 *restrict c, lq_v8 *restrict out) {
    lq_v8 total = *out;
    for (int k = 0; k < depths; k++) {
        const double a = arrival[backwards ? depths - 1 - k : k];
        const lq_v8 *at = c + (size_t)k * 2 * (size_t)nodes;
        lq_v8 sum[4] = {{0.0}};
        /* Node counts are multiples of four. */
        for (int j = 0; j < nodes; j += 4)
            for (int b = 0; b < 4; b++) sum[b] += weight[j + b] * at[j + b];
        total += a * (sum[0] + sum[1] + (sum[2] + sum[3]));
    }
    *out = total;
}

const lq_solver_kernels *LQ_KERNELS(void) {
    static const lq_solver_kernels kernels = {moments, moments3, escaping, spread,       assemble,
                                              sweep,   survival, travel,   meet,         travel_packed,
                                              average, contract, arrive,   read_energies};
    return &kernels;
}
