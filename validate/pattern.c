/* Noise or bias: correlation of neighbouring residuals, and the reference looked up at shifted nodes. */
#include "validate/pattern.h"

#include "system/status.h"
#include "validate/compare.h"

#include <math.h>
#include <stdlib.h>

/* Beyond this many rms an entry is an accident of its own, not part of the pattern. */
static const double outlying = 8.0;
/* Neighbours that share less of their variance than this count as independent; sqrt(1/1000 entries) is
 * three times less. */
static const double uncorrelated = 0.1;

typedef struct residuals {
    const lq_axis *axes;
    int axis_count;
    size_t count;
    const float *values, *reference;
    double *d; /* NaN: left out */
} residuals;

const char *lq_sampling_name(lq_sampling sampling) {
    static const char *const names[LQ_SAMPLINGS] = {"(i+1/2)/N", "i/N", "(i+1)/N", "half a cell up",
                                                    "half a cell down"};
    return sampling < LQ_SAMPLINGS ? names[sampling] : NULL;
}

const char *lq_verdict_text(lq_verdict verdict) {
    static const char *const texts[] = {
        [LQ_AGREES] = "the two agree within their tolerances",
        [LQ_SPOTS] = "isolated wrong entries: all others agree",
        [LQ_MISPLACED] = "misplaced nodes: another sampling of an axis explains most of the difference",
        [LQ_NOISE] = "noise: neighbours are uncorrelated and the mean is 0",
        [LQ_OFFSET] = "noise around an offset: neighbours are uncorrelated, but the mean is not 0",
        [LQ_SHARED] = "smooth errors of both signs: a bias, or noise of samples that neighbours share",
        [LQ_BIAS] = "bias: smooth errors of one sign",
    };
    return texts[verdict];
}

/* ---------------------------------------------------------------------------- the residuals */

static void measure_all(residuals *r, lq_pattern *p, double *max) {
    double square = 0.0;
    *max = 0.0;
    for (size_t i = 0; i < r->count; i++) {
        r->d[i] = (double)r->values[i] - (double)r->reference[i];
        const double size = isfinite(r->d[i]) ? fabs(r->d[i]) : INFINITY;
        *max = fmax(*max, size);
        if (isfinite(size)) square += size * size;
    }
    p->read_rms = sqrt(square / (double)r->count);
}

/* Few entries beyond the allowance, each of them far beyond what scatters within it. */
static size_t count_spots(const residuals *r, double allowance) {
    size_t beyond = 0;
    double square = 0.0, least = INFINITY;
    for (size_t i = 0; i < r->count; i++) {
        const double size = isfinite(r->d[i]) ? fabs(r->d[i]) : INFINITY;
        if (size <= allowance) {
            square += size * size;
            continue;
        }
        beyond++;
        least = fmin(least, size);
    }
    const bool few = beyond == 1 || 100 * beyond <= r->count;
    const bool far = r->count > beyond && least > outlying * sqrt(square / (double)(r->count - beyond));
    return few && far ? beyond : 0;
}

/* Zeros that are none: a texel never written, a guard against division. */
static void count_zeros(const residuals *r, double allowance, lq_pattern *p) {
    const double small = fmax(10.0 * allowance, 1e-3);
    for (size_t i = r->count; i-- > 0;) {
        if (r->values[i] != 0.0f || !(fabs((double)r->reference[i]) > small)) continue;
        p->zeros++;
        p->zero_at = i;
    }
}

/* The rms again and again without what lies beyond, until nothing more does. */
static void drop_outliers(residuals *r, lq_pattern *p) {
    size_t kept = 0, before;
    double limit = INFINITY;
    do {
        double sum = 0.0, square = 0.0;
        before = kept;
        kept = 0;
        for (size_t i = 0; i < r->count; i++) {
            if (!(fabs(r->d[i]) <= limit)) r->d[i] = NAN;
            if (isnan(r->d[i])) continue;
            kept++;
            sum += r->d[i];
            square += r->d[i] * r->d[i];
        }
        p->mean = kept ? sum / (double)kept : 0.0;
        p->rms = kept ? sqrt(square / (double)kept) : 0.0;
        limit = outlying * p->rms;
    } while (kept != before);
    p->outliers = r->count - kept;
}

/* ------------------------------------------------------------------------------ correlation */

static size_t stride_of(const residuals *r, int axis) {
    size_t stride = 1;
    for (int a = 0; a < axis; a++) stride *= r->axes[a].size;
    return stride;
}

static double correlate(const residuals *r, int axis) {
    const size_t stride = stride_of(r, axis), size = r->axes[axis].size;
    double product = 0.0, square = 0.0;
    for (size_t i = 0; i < r->count; i++) {
        if (i / stride % size + 1 == size) continue;
        const double a = r->d[i], b = r->d[i + stride];
        if (isnan(a) || isnan(b)) continue;
        product += a * b;
        square += 0.5 * (a * a + b * b);
    }
    return square > 0.0 ? product / square : 0.0;
}

/* A first-order autoregressive chain of N has N (1-r)/(1+r) independent members. */
static void correlate_all(const residuals *r, lq_pattern *p) {
    int used = 0;
    p->independent = 1.0;
    for (int a = 0; a < r->axis_count; a++) {
        if (r->axes[a].size < 2) continue;
        const double c = p->correlation[a] = correlate(r, a), positive = fmax(c, 0.0);
        p->shared += c;
        p->independent *= fmax((double)r->axes[a].size * (1.0 - positive) / (1.0 + positive), 1.0);
        used++;
    }
    if (used > 0) p->shared /= used;
    p->z_mean = p->rms > 0.0 ? p->mean / (p->rms / sqrt(p->independent)) : 0.0;
}

/* ---------------------------------------------------------------------------------- shifts */

static double shifted_node(lq_sampling sampling, size_t i, size_t size) {
    const double at = (double)i, cells = (double)(size - 1), n = (double)size;
    const double moved[LQ_SAMPLINGS] = {(at + 0.5) * cells / n, at * cells / n, (at + 1.0) * cells / n,
                                        at + 0.5, at - 0.5};
    return fmin(fmax(moved[sampling], 0.0), cells);
}

/* rms against the reference interpolated along one axis at the places that node index stands for. */
static double resample(const residuals *r, int axis, lq_sampling sampling) {
    const size_t stride = stride_of(r, axis), size = r->axes[axis].size;
    double square = 0.0;
    for (size_t i = 0; i < r->count; i++) {
        const size_t node = i / stride % size;
        const double at = shifted_node(sampling, node, size);
        const size_t cell = (size_t)at < size - 1 ? (size_t)at : size - 2;
        const float *start = r->reference + (i - node * stride) + cell * stride;
        const double low = (double)start[0], high = (double)start[stride];
        const double d = (double)r->values[i] - (low + (high - low) * (at - (double)cell));
        if (isfinite(d)) square += d * d;
    }
    return sqrt(square / (double)r->count);
}

static void resample_all(const residuals *r, lq_pattern *p) {
    double best = p->read_rms;
    p->best_axis = -1;
    for (int a = 0; a < r->axis_count; a++)
        for (int s = 0; s < LQ_SAMPLINGS && r->axes[a].size > 1; s++) {
            p->sampled[a][s] = resample(r, a, (lq_sampling)s);
            if (!(p->sampled[a][s] < best)) continue;
            best = p->sampled[a][s];
            p->best_axis = a;
            p->best_sampling = (lq_sampling)s;
        }
}

/* --------------------------------------------------------------------------------- verdict */

static lq_verdict judge(const lq_pattern *p, double max, double allowance) {
    if (max <= allowance) return LQ_AGREES;
    if (p->spots > 0) return LQ_SPOTS;
    if (p->best_axis >= 0 && p->sampled[p->best_axis][p->best_sampling] < 0.5 * p->read_rms)
        return LQ_MISPLACED;
    const bool centred = fabs(p->z_mean) < lq_z_limit(1);
    if (p->shared < uncorrelated) return centred ? LQ_NOISE : LQ_OFFSET;
    return centred ? LQ_SHARED : LQ_BIAS;
}

lq_status lq_pattern_of(const lq_table *table, const lq_table *reference, int channel, double allowance,
                        lq_pattern *pattern, lq_error *error) {
    *pattern = (lq_pattern){.outliers = 0};
    residuals r = {table->axes,
                   table->axis_count,
                   lq_table_entries(table),
                   table->channels[channel],
                   reference->channels[channel],
                   NULL};
    if (r.count != lq_table_entries(reference))
        return lq_fail(error, LQ_BAD_INPUT, "tables over different axes have no pattern of differences");
    r.d = malloc(r.count * sizeof *r.d);
    if (!r.d) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu differences", r.count);
    double max;
    measure_all(&r, pattern, &max);
    pattern->spots = count_spots(&r, allowance);
    count_zeros(&r, allowance, pattern);
    drop_outliers(&r, pattern);
    correlate_all(&r, pattern);
    resample_all(&r, pattern);
    pattern->verdict = judge(pattern, max, allowance);
    free(r.d);
    return LQ_OK;
}
