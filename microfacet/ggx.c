/* GGX: D = a^2 / (pi (a^2 cos^2 + sin^2)^2), and Smith's projected area in a form without cancellation. */
#include "microfacet/ggx.h"

#include "microfacet/kernels.h"

#include <math.h>

static void density(const lq_ndf *ndf, double alpha, size_t count, const double *cos2, const double *sin2,
                    double *d) {
    (void)ndf;
    lq_microfacet_kernels_get()->ggx_density(alpha, count, cos2, sin2, d);
}

static void areas_below(const lq_ndf *ndf, double alpha, size_t count, const double *mu, double *area) {
    (void)ndf;
    lq_microfacet_kernels_get()->ggx_areas_below(alpha, count, mu, area);
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
    .areas_below = areas_below,
    .slope_quantile = slope_quantile,
};
