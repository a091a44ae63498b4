/* Binomial limits through the incomplete beta function, design effects from the spread between blocks. */
#include "validate/certificate_confidence.h"

#include <math.h>

/* Continued fraction of the incomplete beta function by Lentz's method (Numerical Recipes sec. 6.4; DLMF
 * 8.17.22), for x below (a + 1)/(a + b + 2). */
static double beta_fraction(double a, double b, double x) {
    const double tiny = 1e-300;
    double c = 1.0, d = 1.0 - (a + b) * x / (a + 1.0);
    d = 1.0 / (fabs(d) < tiny ? tiny : d);
    double value = d;
    for (int i = 1; i < 10000; i++) {
        const double m = (double)i, even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double step = 1.0;
        for (int half = 0; half < 2; half++) {
            const double term = half ? odd : even;
            d = 1.0 + term * d;
            c = 1.0 + term / c;
            d = 1.0 / (fabs(d) < tiny ? tiny : d);
            c = fabs(c) < tiny ? tiny : c;
            step = c * d;
            value *= step;
        }
        if (fabs(step - 1.0) < 1e-14) break;
    }
    return value;
}

/* lgamma without its global sign; arguments are positive. */
static double log_gamma(double x) {
    int sign;
    return lgamma_r(x, &sign);
}

/* Regularised incomplete beta function I_x(a, b). */
static double beta_share(double a, double b, double x) {
    if (!(x > 0.0)) return 0.0;
    if (x >= 1.0) return 1.0;
    const double front = exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * log(x) + b * log1p(-x));
    if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
    return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

double lq_share_limit(double hits, double count, double confidence) {
    if (!(count > 0.0) || hits >= count) return 1.0;
    double low = hits / count, high = 1.0;
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (low + high);
        if (beta_share(hits + 1.0, count - hits, middle) < confidence) low = middle;
        else high = middle;
    }
    return high;
}

double lq_effective_points(const size_t *hits, size_t blocks, size_t per_block) {
    const double b = (double)blocks, all = b * (double)per_block;
    double sum = 0.0, spread = 0.0;
    for (size_t i = 0; i < blocks; i++) sum += (double)hits[i];
    for (size_t i = 0; i < blocks; i++) {
        const double d = (double)hits[i] - sum / b;
        spread += d * d;
    }
    const double share = sum / all;
    if (!(spread > 0.0) || blocks < 2) return b;
    const double variance = b / (b - 1.0) * spread / (all * all);
    return fmin(share * (1.0 - share) / variance, all);
}

double lq_quantile_rank(double n, double share, double confidence) {
    if (lq_share_limit(0.0, n, confidence) > 1.0 - share) return n;
    double low = 0.0, high = n * (1.0 - share);
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (lq_share_limit(middle, n, confidence) > 1.0 - share) high = middle;
        else low = middle;
    }
    return n - low;
}
