/* GGX: D = a^2 / (pi (a^2 cos^2 + sin^2)^2), and Smith's projected area in a form without cancellation. */
#include "microfacet/ggx.h"

#include <math.h>

static const double inverse_pi = 0.31830988618379067154;

static void density(const lq_ndf *ndf, double alpha, size_t count, const double *restrict cos2,
                    const double *restrict sin2, double *restrict d) {
    (void)ndf;
    const double a2 = alpha * alpha;
    for (size_t i = 0; i < count; i++) {
        const double q = a2 * cos2[i] + sin2[i];
        d[i] = inverse_pi * a2 / (q * q);
    }
}

/* mu Lambda = (sqrt(mu^2 + a^2 sin^2) - mu) / 2, as the quotient that keeps its digits for small a. */
static double area_below(const lq_ndf *ndf, double alpha, double mu, double sin_theta) {
    (void)ndf;
    const double stretch = alpha * sin_theta;
    if (stretch == 0.0) return 0.0;
    return 0.5 * stretch * stretch / (hypot(mu, stretch) + mu);
}

/* integral of m_z D within theta_m is t^2 / (a^2 + t^2), t = tan theta_m. */
static double slope_quantile(const lq_ndf *ndf, double alpha, double xi) {
    (void)ndf;
    return alpha * sqrt(xi / (1.0 - xi));
}

const lq_ndf lq_ggx = {
    .id = "ggx",
    .title = "GGX (Trowbridge-Reitz): alpha is the slope scale itself",
    .source = "Walter et al. 2007, eq. 33-34",
    .density = density,
    .area_below = area_below,
    .slope_quantile = slope_quantile,
};
