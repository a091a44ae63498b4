/* Beckmann: D = exp(-tan^2/a^2) / (pi a^2 cos^4), and Smith's projected area with no cancellation. */
#include "microfacet/beckmann.h"

#include <math.h>

static const double inverse_pi = 0.31830988618379067154, inverse_root_pi = 0.56418958354775628695;

static void density(const lq_ndf *ndf, double alpha, size_t count, const double *cos2, const double *sin2,
                    double *d) {
    (void)ndf;
    const double inverse = 1.0 / (alpha * alpha), scale = inverse_pi * inverse;
    for (size_t i = 0; i < count; i++) {
        const double slope2 = cos2[i] > 0.0 ? sin2[i] / cos2[i] : INFINITY;
        const double fall = exp(-inverse * slope2);
        d[i] = fall > 0.0 ? scale * fall / (cos2[i] * cos2[i]) : 0.0;
    }
}

/* 1 - sqrt(pi) a exp(a^2) erfc(a) for a >= 5: r/(a + r), r = (1/2)/(a + 1/(a + (3/2)/(a + ...))), the
 * continued fraction of erfc. */
static double rest_of_tail(double a) {
    double r = 0.0;
    for (int k = 12; k > 0; k--) r = 0.5 * k / (a + r);
    return r / (a + r);
}

/* mu Lambda = (a s exp(-x^2)/sqrt(pi) - mu erfc(x)) / 2 with x = mu / (a s). The two terms agree to 1/(2
 * x^2), so that far out their difference is taken from the continued fraction. */
static double area_below(const lq_ndf *ndf, double alpha, double mu, double sin_theta) {
    (void)ndf;
    const double stretch = alpha * sin_theta;
    if (stretch == 0.0) return 0.0;
    const double x = mu / stretch;
    if (x > 28.0) return 0.0; /* exp(-784) */
    const double wide = stretch * exp(-x * x) * inverse_root_pi;
    return 0.5 * (x < 5.0 ? wide - mu * erfc(x) : wide * rest_of_tail(x));
}

static void areas_below(const lq_ndf *ndf, double alpha, size_t count, const double *mu, double *area) {
    for (size_t i = 0; i < count; i++) area[i] = area_below(ndf, alpha, mu[i], lq_sine(mu[i]));
}

/* integral of m_z D within theta_m is 1 - exp(-tan^2 theta_m / a^2). */
static double slope_quantile(const lq_ndf *ndf, double alpha, double xi) {
    (void)ndf;
    return alpha * sqrt(-log1p(-xi));
}

const lq_ndf lq_beckmann = {
    .id = "beckmann",
    .title = "Beckmann: normally distributed slopes, alpha = sqrt(2) rms slope",
    .source = "Walter et al. 2007, eq. 25-26",
    .density = density,
    .area_below = area_below,
    .areas_below = areas_below,
    .slope_quantile = slope_quantile,
};
