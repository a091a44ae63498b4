/* GTR: density and distribution in closed form, projected areas from D.
 *
 * With q = a^2 cos^2 + sin^2, dq = (1 - a^2) d(sin^2), and L = ln a^2:
 *     D = c / q^gamma,   integral m_z D beyond q = (q^(1-gamma) - 1) / (a^(2(1-gamma)) - 1),
 *     c = (1 - a^2)(gamma - 1) / (pi (a^(2(1-gamma)) - 1))
 * which are differences of powers near 1 for gamma -> 1 and for a -> 1: h(x) = (exp(x) - 1)/x takes both.
 */
#include "microfacet/gtr.h"

#include "microfacet/profile.h"
#include "system/number.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

typedef struct gtr {
    lq_profiled profiled;
    double gamma;
    char id[2 * LQ_NAME_SIZE];
} gtr;

/* (exp(x) - 1) / x */
static double h(double x) {
    return fabs(x) < 1e-5 ? 1.0 + 0.5 * x * (1.0 + x / 3.0) : expm1(x) / x;
}

/* ln(1 + x y) / y for x > -1/y, the inverse of (exp(x y) - 1) / y. */
static double inverse_power(double x, double y) {
    return fabs(x * y) < 1e-9 ? x * (1.0 - 0.5 * x * y) : log1p(x * y) / y;
}

static void density(const lq_ndf *ndf, double alpha, size_t count, const double *cos2, const double *sin2,
                    double *d) {
    const gtr *g = ndf->parameters;
    const double a2 = alpha * alpha, l = 2.0 * log(alpha), power = 1.0 - g->gamma;
    const double c = h(l) / (pi * h(l * power)); /* (1 - a^2)/L over ... : L cancels */
    for (size_t i = 0; i < count; i++) d[i] = c * pow(a2 * cos2[i] + sin2[i], -g->gamma);
}

/* ln q by (q^p - 1)/p = (1 - xi)(a^2p - 1)/p, p = 1 - gamma; then cos^2 = (1 - q)/(1 - a^2). */
static double slope_quantile(const lq_ndf *ndf, double alpha, double xi) {
    const gtr *g = ndf->parameters;
    const double l = 2.0 * log(alpha), p = 1.0 - g->gamma;
    const double whole = l * h(l * p);
    const double log_q = inverse_power((1.0 - xi) * whole, p);
    /* q/a^2 the same way from the other end: neither difference cancels. */
    const double log_rise = inverse_power(-xi * l * h(-l * p), p);
    const double falls = l < 0.0 ? h(log_q) * log_q / (h(l) * l) : 1.0 - xi;
    const double rises = l < 0.0 ? -exp(l) * h(log_rise) * log_rise / (h(l) * l) : xi;
    return sqrt(fmax(rises, 0.0) / falls);
}

static void release(lq_ndf *ndf) {
    gtr *g = (gtr *)ndf->parameters;
    lq_profiled_free(&g->profiled);
    free(g);
}

lq_status lq_gtr_open(const lq_ndf **ndf, double gamma, lq_error *error) {
    if (!(gamma >= LQ_GTR_GAMMA_MIN && gamma <= LQ_GTR_GAMMA_MAX))
        return lq_fail(error, LQ_BAD_INPUT, "gtr: gamma = %g is out of range; accepted: %g to %g", gamma,
                       LQ_GTR_GAMMA_MIN, LQ_GTR_GAMMA_MAX);
    gtr *g = calloc(1, sizeof *g);
    if (!g) return lq_fail(error, LQ_NO_MEMORY, "no memory for an NDF");
    g->gamma = gamma;
    lq_print(g->id, sizeof g->id, "gtr:gamma=%.15g", gamma);
    g->profiled.ndf = (lq_ndf){.id = g->id,
                               .title = "GTR: generalised Trowbridge-Reitz",
                               .source = "Burley 2012, sec. 5.4 and app. B",
                               .parameters = g,
                               .density = density,
                               .area_below = lq_profiled_area_below,
                               .areas_below = lq_profiled_areas_below,
                               .slope_quantile = slope_quantile,
                               .prepare = lq_profiled_prepare,
                               .release = release};
    *ndf = &g->profiled.ndf;
    return LQ_OK;
}
