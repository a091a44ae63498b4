/* Splines through sampled NDFs, what they hold, and their family over alpha. */
#include "microfacet/ndf_samples.h"

#include "microfacet/profile.h"
#include "system/number.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

typedef struct sampled {
    lq_profiled profiled;
    size_t count, columns;
    double *theta, *log_d, *slope, *alpha; /* log_d and slope: [column * count + i] */
    char *id;
    char note[LQ_MESSAGE_SIZE];
} sampled;

/* --------------------------------------------------------------------------------- splines */

/* Slope at x[0] of the polynomial through the first n of the points, taken with `step` 1 or -1. */
static double end_slope(const double *x, const double *y, size_t n, int step) {
    double sum = 0.0;
    for (size_t j = 1; j < n; j++) {
        /* derivative at x0 of the Lagrange polynomial j; that of 0 is minus their sum */
        double factor = 1.0 / (x[(long)j * step] - x[0]);
        for (size_t k = 1; k < n; k++)
            if (k != j) factor *= (x[0] - x[(long)k * step]) / (x[(long)j * step] - x[(long)k * step]);
        sum += factor * (y[(long)j * step] - y[0]);
    }
    return sum;
}

/* Hyman 1983: no steeper than three times either neighbour, and never against both. */
static double limited(double slope, double before, double after) {
    const double most = 3.0 * fmin(fabs(before), fabs(after));
    if (before * after > 0.0 && slope * before < 0.0) return 0.0;
    return fmin(fmax(slope, -most), most);
}

/* Slopes of the twice differentiable cubic spline through n points, by elimination; then limited. `work` has
 * room for n. */
static void spline_slopes(const double *x, const double *y, size_t n, double *slope, double *work) {
    const size_t of_end = n < 4 ? n : 4;
    slope[0] = x[0] == 0.0 ? 0.0 : end_slope(x, y, of_end, 1); /* D is even */
    if (n == 1) return;
    slope[n - 1] = end_slope(x + n - 1, y + n - 1, of_end, -1);
    work[0] = 0.0;
    for (size_t i = 1; i + 1 < n; i++) {
        const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
        const double d0 = (y[i] - y[i - 1]) / h0, d1 = (y[i + 1] - y[i]) / h1;
        const double diagonal = 2.0 * (h0 + h1) - h1 * work[i - 1];
        work[i] = h0 / diagonal;
        slope[i] = (3.0 * (h1 * d0 + h0 * d1) - h1 * slope[i - 1]) / diagonal;
    }
    for (size_t i = n - 1; i-- > 1;) slope[i] -= work[i] * slope[i + 1];
    for (size_t i = 1; i + 1 < n; i++)
        slope[i] =
            limited(slope[i], (y[i] - y[i - 1]) / (x[i] - x[i - 1]), (y[i + 1] - y[i]) / (x[i + 1] - x[i]));
}

/* Every run of positive samples is a spline of its own. */
static void fit_column(sampled *s, size_t column, double *work) {
    double *y = s->log_d + column * s->count, *slope = s->slope + column * s->count;
    for (size_t from = 0; from < s->count;) {
        size_t to = from;
        while (to < s->count && isfinite(y[to])) to++;
        if (to > from) spline_slopes(s->theta + from, y + from, to - from, slope + from, work);
        from = to > from ? to : from + 1;
    }
}

/* log D at `theta` in one column; -infinity where D is 0. */
static double log_density(const sampled *s, size_t column, double theta) {
    const double *x = s->theta, *y = s->log_d + column * s->count, *slope = s->slope + column * s->count;
    const size_t last = s->count - 1;
    if (theta <= x[0]) return y[0]; /* a first angle above 0 was given a sample at 0 */
    if (theta >= x[last]) return y[last] + fmin(slope[last], 0.0) * (theta - x[last]);
    size_t low = 0, high = last;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        *(x[middle] <= theta ? &low : &high) = middle;
    }
    const double h = x[high] - x[low], u = (theta - x[low]) / h, v = 1.0 - u;
    if (isfinite(y[low]) && isfinite(y[high]))
        return v * v * ((1.0 + 2.0 * u) * y[low] + u * h * slope[low]) +
               u * u * ((1.0 + 2.0 * v) * y[high] - v * h * slope[high]);
    if (isfinite(y[low])) return y[low] + log(v * v * (1.0 + 2.0 * u));
    if (isfinite(y[high])) return y[high] + log(u * u * (1.0 + 2.0 * v));
    return -INFINITY;
}

/* ----------------------------------------------------------------------------------- shapes */

static void shape_of_one(const lq_profiled *of, double alpha, size_t count, const double *cos2,
                         const double *sin2, double *d) {
    const sampled *s = of->ndf.parameters;
    (void)alpha;
    for (size_t i = 0; i < count; i++) d[i] = exp(log_density(s, 0, atan2(sqrt(sin2[i]), sqrt(cos2[i]))));
}

/* Weight times log(alpha^2 cos^4 D) of a column where tan(theta)/alpha is the same, less the log of alpha^2
 * cos^4 there. */
static double column_part(const sampled *s, size_t column, double weight, double alpha, double cos2,
                          double sin2) {
    const double ratio = s->alpha[column] / alpha;
    if (weight == 0.0) return 0.0;
    const double theta = atan2(ratio * sqrt(sin2), sqrt(cos2));
    return weight * (log_density(s, column, theta) + 2.0 * log(ratio / (cos2 + ratio * ratio * sin2)));
}

static void shape_of_family(const lq_profiled *of, double alpha, size_t count, const double *cos2,
                            const double *sin2, double *d) {
    const sampled *s = of->ndf.parameters;
    size_t k = 0;
    while (k + 2 < s->columns && alpha > s->alpha[k + 1]) k++;
    const double position = log(alpha / s->alpha[k]) / log(s->alpha[k + 1] / s->alpha[k]);
    const double w = fmin(fmax(position, 0.0), 1.0);
    for (size_t i = 0; i < count; i++)
        d[i] = exp(column_part(s, k, 1.0 - w, alpha, cos2[i], sin2[i]) +
                   column_part(s, k + 1, w, alpha, cos2[i], sin2[i]));
}

/* ----------------------------------------------------------------------------------- making */

/* integral m_z D of a column as given, the part of it beyond the last angle, and the angle that halves it. */
typedef struct contents {
    double whole, beyond, median;
} contents;

enum { STEPS = 9000 };

static contents contents_of(const sampled *s, size_t column) {
    const double step = 0.5 * pi / STEPS, last = s->theta[s->count - 1];
    contents c = {0.0, 0.0, 0.0};
    double sum = 0.0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < STEPS; i++) {
            const double theta = (i + 0.5) * step;
            const double part =
                2.0 * pi * step * sin(theta) * cos(theta) * exp(log_density(s, column, theta));
            if (pass == 0) {
                c.whole += part;
                if (theta > last) c.beyond += part;
            } else if (sum <= 0.5 * c.whole) {
                c.median = theta + step * ((0.5 * c.whole - sum) / part - 0.5);
                sum += part;
            }
        }
    return c;
}

static void release(lq_ndf *ndf) {
    sampled *s = (sampled *)ndf->parameters;
    lq_profiled_free(&s->profiled);
    free(s->theta);
    free(s->log_d);
    free(s->slope);
    free(s->alpha);
    free(s->id);
    free(s);
}

/* A sample at 0 from the parabola in theta through the first two, where the first angle is above 0. */
static double log_at_0(const double *theta, const double *d) {
    if (!(d[0] > 0.0 && d[1] > 0.0)) return log(d[0]);
    const double a = theta[0] * theta[0], b = theta[1] * theta[1];
    return log(d[0]) + a / (b - a) * log(d[0] / d[1]);
}

static bool copy_samples(sampled *s, const lq_ndf_samples *from) {
    const size_t extra = from->theta[0] > 0.0, count = from->count + extra;
    s->count = count;
    s->columns = from->columns;
    s->theta = malloc(count * sizeof *s->theta);
    s->log_d = malloc(count * from->columns * sizeof *s->log_d);
    s->slope = calloc(count * from->columns, sizeof *s->slope);
    s->alpha = calloc(from->columns, sizeof *s->alpha);
    s->id = strdup(from->id);
    double *work = malloc(count * sizeof *work);
    const bool ok = s->theta && s->log_d && s->slope && s->alpha && s->id && work;
    for (size_t c = 0; ok && c < s->columns; c++) {
        const double *d = from->d + c * from->count;
        double *y = s->log_d + c * count;
        if (from->alpha) s->alpha[c] = from->alpha[c];
        s->theta[0] = 0.0;
        y[0] = log_at_0(from->theta, d);
        for (size_t i = 0; i < from->count; i++) {
            s->theta[i + extra] = from->theta[i];
            y[i + extra] = log(d[i]);
        }
        fit_column(s, c, work);
    }
    free(work);
    return ok;
}

/* One roughness: that of the GGX whose slopes have the same median. Rounded, so that a text can hold it. */
static double median_roughness(double theta) {
    char text[32];
    lq_print(text, sizeof text, "%.4g", fmin(fmax(tan(theta), 1e-3), 1.0));
    return lq_strtod(text, NULL);
}

static void describe(sampled *s, const char *name) {
    double least = INFINITY, most = 0.0, beyond = 0.0, median = 0.0;
    for (size_t c = 0; c < s->columns; c++) {
        const contents held = contents_of(s, c);
        least = fmin(least, 1.0 / held.whole);
        most = fmax(most, 1.0 / held.whole);
        beyond = fmax(beyond, held.beyond / held.whole);
        median = held.median;
    }
    const double last = 180.0 / pi * s->theta[s->count - 1];
    const int used = s->columns == 1 ? lq_print(s->note, sizeof s->note, "%s: D scaled by %.6g", name, most)
                                     : lq_print(s->note, sizeof s->note, "%s: D scaled by %.6g to %.6g", name,
                                                least, most);
    size_t at = used > 0 && (size_t)used < sizeof s->note ? (size_t)used : sizeof s->note - 1;
    if (beyond > 0.0)
        at += (size_t)lq_print(s->note + at, sizeof s->note - at,
                               "; %.2g of it lies beyond %.4g degrees, extrapolated", beyond, last);
    lq_ndf *ndf = &s->profiled.ndf;
    if (s->columns == 1) {
        ndf->alpha_min = ndf->alpha_max = median_roughness(median);
        if (at < sizeof s->note)
            lq_print(s->note + at, sizeof s->note - at, "; one roughness, alpha = %g by its median slope",
                     ndf->alpha_min);
    } else {
        ndf->alpha_min = s->alpha[0];
        ndf->alpha_max = s->alpha[s->columns - 1];
    }
    ndf->note = s->note;
}

lq_status lq_ndf_samples_make(const lq_ndf **ndf, const lq_ndf_samples *samples, lq_error *error) {
    sampled *s = calloc(1, sizeof *s);
    if (!s) return lq_fail(error, LQ_NO_MEMORY, "no memory for an NDF");
    s->profiled.ndf.parameters = s;
    if (!copy_samples(s, samples)) {
        release(&s->profiled.ndf);
        return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu samples of an NDF", samples->count);
    }
    s->profiled.shape = s->columns == 1 ? shape_of_one : shape_of_family;
    s->profiled.ndf = (lq_ndf){.id = s->id,
                               .title = s->columns == 1 ? "measured: one distribution" : "measured family",
                               .source = s->id,
                               .parameters = s,
                               .density = lq_profiled_density,
                               .area_below = lq_profiled_area_below,
                               .areas_below = lq_profiled_areas_below,
                               .slope_quantile = lq_profiled_quantile,
                               .prepare = lq_profiled_prepare,
                               .release = release,
                               .pieces = true};
    describe(s, samples->name);
    *ndf = &s->profiled.ndf;
    return LQ_OK;
}
