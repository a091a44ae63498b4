/* The Koenigs limit on Chebyshev interpolants of ln v1 and ln v2, which are analytic in ln alpha. */
#include "fit/curve.h"

#include "fit/bounce.h"
#include "microfacet/lobe.h"
#include "microfacet/root.h"
#include "system/number.h"

#include <math.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;

static double chebyshev(const double *coefficient, double alpha) {
    const double span = -log(LQ_CURVE_LEAST);
    const double x = 1.0 + 2.0 * log(alpha) / span;
    double b1 = 0.0, b2 = 0.0;
    for (int k = LQ_CURVE_DEGREE; k > 0; k--) {
        const double b = 2.0 * x * b1 - b2 + coefficient[k];
        b2 = b1;
        b1 = b;
    }
    return x * b1 - b2 + coefficient[0];
}

static void transform(const double *values, double *coefficient) {
    const int count = LQ_CURVE_DEGREE + 1;
    for (int k = 0; k < count; k++) {
        double sum = 0.0;
        for (int j = 0; j < count; j++) sum += values[j] * cos(pi * k * (j + 0.5) / count);
        coefficient[k] = sum * (k > 0 ? 2.0 : 1.0) / count;
    }
}

/* What the last coefficients say about those that are left out. */
static double tail(const double *coefficient) {
    double sum = 0.0;
    for (int k = LQ_CURVE_DEGREE - 7; k <= LQ_CURVE_DEGREE; k++) sum += fabs(coefficient[k]);
    return sum;
}

static lq_status measure(lq_curve *curve, lq_error *error) {
    enum { COUNT = LQ_CURVE_DEGREE + 1 };
    double v1[COUNT], v2[COUNT], off[COUNT] = {0};
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < COUNT; j++) {
        const double alpha = pow(LQ_CURVE_LEAST, 0.5 - 0.5 * cos(pi * (j + 0.5) / COUNT));
        v1[j] = lq_lobe_variance(curve->ndf, alpha);
        v2[j] = lq_two_bounce_variance(curve->ndf, alpha, j % 16 == 0 ? &off[j] : NULL);
        off[j] /= v2[j];
    }
    double worst = 0.0;
    for (int j = 0; j < COUNT; j++) {
        if (!(v1[j] > 0.0 && v2[j] > 0.0 && v2[j] <= 1.0)) {
            lq_print(error->text, sizeof error->text,
                     "NDF '%.100s' gives variances no lobe has: v1 = %g, v2 = %g", curve->ndf->id, v1[j],
                     v2[j]);
            return LQ_NOT_CONVERGED;
        }
        worst = fmax(worst, off[j]);
        v1[j] = log(v1[j]);
        v2[j] = log(v2[j]);
    }
    transform(v1, curve->v1);
    transform(v2, curve->v2);
    curve->accuracy = worst + tail(curve->v1) + tail(curve->v2) + 1e-14;
    return LQ_OK;
}

typedef struct crossing {
    const double *series;
    double value;
} crossing;

static double level_gap(const void *user, double log_alpha) {
    const crossing *l = user;
    return chebyshev(l->series, exp(log_alpha)) - l->value;
}

/* phi^-1(alpha): v2 of it is v1(alpha), both as ln. */
static double step_down(const lq_curve *curve, double alpha, double value) {
    const crossing l = {curve->v2, value};
    const double high = log(alpha), low = fmax(high - 1.0, log(LQ_CURVE_LEAST) - 1.0);
    const double above = level_gap(&l, high);
    if (above <= 0.0) return alpha;
    return exp(lq_root(level_gap, &l, low, level_gap(&l, low), high, above, 2e-15));
}

/* phi(alpha): v1 of it is v2(alpha). */
static double step_up(const lq_curve *curve, double alpha) {
    const crossing l = {curve->v1, chebyshev(curve->v2, alpha)};
    const double low = log(alpha), high = log(curve->pole), above = level_gap(&l, high);
    const double below = level_gap(&l, low);
    if (above <= 0.0 || below >= 0.0) return curve->pole;
    return exp(lq_root(level_gap, &l, low, below, high, above, 2e-15));
}

double lq_curve_limit(const lq_curve *curve, double alpha, double *error) {
    double relative = 0.0;
    int n = 0;
    if (error) *error = 0.0;
    if (alpha <= 0.0) return 0.0;
    if (alpha >= curve->pole) {
        if (error) *error = INFINITY;
        return INFINITY;
    }
    /* 4e-5 and not the end of the interpolants: one step down from there is still on them */
    while (alpha > 4.0 * LQ_CURVE_LEAST) {
        const double level = chebyshev(curve->v1, alpha);
        const double next = step_down(curve, alpha, level);
        const double fall = level - chebyshev(curve->v1, next);
        if (!(fall > 2.0 * curve->accuracy) || n > 1000) { /* at the pole */
            if (error) *error = INFINITY;
            return INFINITY;
        }
        relative += curve->accuracy * log(2.0) / fall;
        alpha = next;
        n++;
    }
    /* Where no step was taken the NDF itself is asked; every other end is a roughness of its own, and an NDF
     * that tabulates would keep a table for each. */
    const double end = n == 0 ? lq_lobe_variance(curve->ndf, alpha) : exp(chebyshev(curve->v1, alpha));
    if (error) *error = relative + (n > 0 ? curve->accuracy : 0.0) + 2.0 * end;
    return ldexp(end, n);
}

/* x = ln(alpha / (pole - alpha)) */
static double from_logit(const lq_curve *curve, double x) {
    return curve->pole / (1.0 + exp(-x));
}

static double logit(const lq_curve *curve, double alpha) {
    return log(alpha / (curve->pole - alpha));
}

/* The lowest alpha where v2 = v1, from below; 1 where there is none. */
static double find_pole(const lq_curve *curve) {
    double low = 0.01;
    while (low < 1.0 && chebyshev(curve->v2, low) - chebyshev(curve->v1, low) > 2.0 * curve->accuracy)
        low += 1.0 / 512.0;
    if (low > 1.0 - 1.0 / 128.0) return 1.0; /* within the noise of a pole at 1 itself */
    double high = low;
    low -= 1.0 / 512.0;
    for (int step = 0; step < 50; step++) {
        const double middle = 0.5 * (low + high);
        const double gain = chebyshev(curve->v2, middle) - chebyshev(curve->v1, middle);
        *(gain > 0.0 ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

lq_status lq_curve_make(lq_curve *curve, const lq_ndf *ndf, lq_error *error) {
    curve->ndf = ndf;
    if (ndf->alpha_min > LQ_CURVE_LEAST || (ndf->alpha_max > 0.0 && ndf->alpha_max < 1.0)) {
        lq_print(error->text, sizeof error->text,
                 "NDF '%.100s' has roughnesses from %g to %g: its mapping is a limit at alpha = 0 and needs "
                 "all of (0, 1]",
                 ndf->id, ndf->alpha_min, ndf->alpha_max);
        return LQ_BAD_INPUT;
    }
    lq_status status = measure(curve, error);
    if (status != LQ_OK) return status;
    if (lq_lobe_variance(ndf, LQ_CURVE_LEAST) > 1e-3) {
        lq_print(error->text, sizeof error->text,
                 "NDF '%.100s': v1(%g) = %.3g is not small, its mapping has no limit at alpha = 0", ndf->id,
                 LQ_CURVE_LEAST, lq_lobe_variance(ndf, LQ_CURVE_LEAST));
        return LQ_BAD_INPUT;
    }
    curve->pole = find_pole(curve);
    const double low = logit(curve, LQ_CURVE_LEAST), high = logit(curve, LQ_CURVE_TOP * curve->pole);
#pragma omp parallel for schedule(dynamic, 16)
    for (int i = 0; i < LQ_CURVE_NODES; i++)
        curve->log_f[i] = log(
            lq_curve_limit(curve, from_logit(curve, low + (high - low) * i / (LQ_CURVE_NODES - 1)), NULL));
    for (int i = 1; i < LQ_CURVE_NODES; i++)
        if (!(curve->log_f[i] > curve->log_f[i - 1])) {
            lq_print(error->text, sizeof error->text, "NDF '%.100s': f does not rise near alpha = %g",
                     ndf->id, from_logit(curve, low + (high - low) * i / (LQ_CURVE_NODES - 1)));
            return LQ_NOT_CONVERGED;
        }
    return LQ_OK;
}

double lq_curve_f(const lq_curve *curve, double alpha) {
    if (alpha <= 0.0) return 0.0;
    if (alpha < 2.0 * LQ_CURVE_LEAST) return lq_lobe_variance(curve->ndf, alpha);
    if (alpha > LQ_CURVE_TOP * curve->pole) return lq_curve_limit(curve, alpha, NULL);
    const double low = logit(curve, LQ_CURVE_LEAST), high = logit(curve, LQ_CURVE_TOP * curve->pole);
    const double at = (logit(curve, alpha) - low) / (high - low) * (LQ_CURVE_NODES - 1);
    int i = (int)at - 1;
    if (i < 0) i = 0;
    if (i > LQ_CURVE_NODES - 4) i = LQ_CURVE_NODES - 4;
    const double t = at - i, *y = curve->log_f + i;
    return exp(-y[0] * (t - 1) * (t - 2) * (t - 3) / 6 + y[1] * t * (t - 2) * (t - 3) / 2 -
               y[2] * t * (t - 1) * (t - 3) / 2 + y[3] * t * (t - 1) * (t - 2) / 6);
}

double lq_curve_inverse(const lq_curve *curve, double f) {
    if (f <= 0.0) return 0.0;
    if (!(f < INFINITY)) return curve->pole;
    const double top = LQ_CURVE_TOP * curve->pole, reached = lq_curve_f(curve, top);
    int doublings = 0;
    for (; f >= reached; doublings++) f *= 0.5;
    double low = -40.0, high = logit(curve, top); /* -40: 4e-18 */
    for (int step = 0; step < 60; step++) {
        const double middle = 0.5 * (low + high);
        *(lq_curve_f(curve, from_logit(curve, middle)) < f ? &low : &high) = middle;
    }
    double alpha = from_logit(curve, 0.5 * (low + high));
    for (int n = 0; n < doublings; n++) alpha = step_up(curve, alpha);
    return alpha;
}

double lq_curve_two_bounces(const lq_curve *curve, double alpha) {
    return lq_lobe_roughness(curve->ndf, lq_two_bounce_variance(curve->ndf, alpha, NULL));
}
