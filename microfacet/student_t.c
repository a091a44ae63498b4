/* Student-t: everything in closed form; the projected area, an incomplete beta function, is tabulated.
 *
 * With A^2 = (gamma - 1) alpha^2 and slopes (x, y):
 *     P(x, y) = (gamma - 1)/pi A^(2 gamma - 2) (A^2 + x^2 + y^2)^-gamma,      D = P / cos^4,
 * and the marginal of one slope, x = A t, has density C (1 + t^2)^(1/2 - gamma) in t,
 * C = Gamma(gamma - 1/2) / (sqrt(pi) Gamma(gamma - 1)).
 */
#include "microfacet/student_t.h"

#include "microfacet/profile.h"
#include "system/number.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846, root_pi = 1.77245385090551602730;

typedef struct student_t {
    lq_profiled profiled;
    double gamma;
    double marginal; /* C */
    char id[2 * LQ_NAME_SIZE];
} student_t;

static void density(const lq_ndf *ndf, double alpha, size_t count, const double *cos2, const double *sin2,
                    double *d) {
    const student_t *t = ndf->parameters;
    const double g = t->gamma, a2 = (g - 1.0) * alpha * alpha, scale = (g - 1.0) / (pi * a2);
    for (size_t i = 0; i < count; i++) {
        /* (A^2/(A^2 + tan^2))^gamma / cos^4, with cos^2 taken into the fraction where it would vanish */
        const double under = a2 * cos2[i] + sin2[i];
        d[i] = scale * pow(a2 / under, g) * pow(cos2[i], g - 2.0);
    }
}

/* integral from t to infinity of (1 + t^2)^(1/2 - gamma), which is half the incomplete beta function of
 * x = 1/(1 + t^2) at (gamma - 1, 1/2): its continued fraction (modified Lentz) where x is small, the whole
 * less the other side where it is not. */
static double beta_fraction(double a, double b, double x) {
    double c = 1.0, d = 1.0 / (1.0 - (a + b) * x / (a + 1.0)), value = d;
    for (int m = 1; m < 400; m++) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1.0 / (1.0 + even * d);
        c = 1.0 + even / c;
        value *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1.0 / (1.0 + odd * d);
        c = 1.0 + odd / c;
        value *= d * c;
        if (fabs(d * c - 1.0) < 1e-16) break;
    }
    return value;
}

static double tail(const student_t *of, double t) {
    const double a = of->gamma - 1.0, x = 1.0 / (1.0 + t * t), y = t * t * x;
    const double edge = pow(x, a) * sqrt(y);
    if (x < (a + 1.0) / (a + 2.5)) return 0.5 * edge * beta_fraction(a, 0.5, x) / a;
    return 0.5 * (1.0 / of->marginal - edge * beta_fraction(0.5, a, y) / 0.5);
}

/* s A C [ (1 + t^2)^(3/2 - gamma) / (2 gamma - 3) - t tail(t) ],  t = mu / (s A) */
static double exact_area(const lq_profiled *of, double alpha, double mu, double sin_theta) {
    const student_t *t = of->ndf.parameters;
    const double stretch = sin_theta * alpha * sqrt(t->gamma - 1.0);
    if (stretch == 0.0) return 0.0;
    const double at = mu / stretch;
    const double first = pow(1.0 + at * at, 1.5 - t->gamma) / (2.0 * t->gamma - 3.0);
    return stretch * t->marginal * fmax(first - at * tail(t, at), 0.0);
}

/* integral of m_z D beyond theta_m is (1 + tan^2 / A^2)^(1 - gamma). */
static double slope_quantile(const lq_ndf *ndf, double alpha, double xi) {
    const student_t *t = ndf->parameters;
    return alpha * sqrt((t->gamma - 1.0) * expm1(-log1p(-xi) / (t->gamma - 1.0)));
}

static void release(lq_ndf *ndf) {
    student_t *t = (student_t *)ndf->parameters;
    lq_profiled_free(&t->profiled);
    free(t);
}

lq_status lq_student_t_open(const lq_ndf **ndf, double gamma, lq_error *error) {
    if (!(gamma >= LQ_STUDENT_T_GAMMA_MIN && gamma <= LQ_STUDENT_T_GAMMA_MAX))
        return lq_fail(error, LQ_BAD_INPUT, "student-t: gamma = %g is out of range; accepted: %g to %g",
                       gamma, LQ_STUDENT_T_GAMMA_MIN, LQ_STUDENT_T_GAMMA_MAX);
    student_t *t = calloc(1, sizeof *t);
    if (!t) return lq_fail(error, LQ_NO_MEMORY, "no memory for an NDF");
    t->gamma = gamma;
    t->marginal = exp(lgamma(gamma - 0.5) - lgamma(gamma - 1.0)) / root_pi;
    lq_print(t->id, sizeof t->id, "student-t:gamma=%.15g", gamma);
    t->profiled.exact_area = exact_area;
    t->profiled.ndf = (lq_ndf){.id = t->id,
                               .title = "Student-t slopes",
                               .source = "Ribardiere et al. 2017",
                               .parameters = t,
                               .density = density,
                               .area_below = lq_profiled_area_below,
                               .areas_below = lq_profiled_areas_below,
                               .slope_quantile = slope_quantile,
                               .prepare = lq_profiled_prepare,
                               .release = release};
    *ndf = &t->profiled.ndf;
    return LQ_OK;
}
