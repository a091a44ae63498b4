/* Two bounces by quadrature over half vectors: for a given angle between normal and half vector the azimuth
 * integral is closed, because reflection is a polynomial in its cosine.
 *
 *     omega_2 = 2 k h - omega_1,  k = omega_1.h = a + b x,  a = c1 ch,  b = s1 sh,  x = cos phi
 *     sin^2 theta_2 = s1^2 + 4 k^2 sh^2 - 4 k sh s1 x           (no cancellation for narrow lobes)
 *     theta_2 < 90 degrees  <=>  x > -cot(2 theta_h) cot(theta_1)
 */
#include "fit/bounce.h"

#include "microfacet/panels.h"

#include <math.h>

enum { FINE = 20, COARSE = 14 };
static const double half_pi = 1.57079632679489661923;

/* D at the nodes of one panel; positions and weights (slope included) come with it. */
static void density_on_panel(const lq_ndf *ndf, double alpha, const lq_panels *panels, int p,
                             const lq_gauss *rule, double *angle, double *weight) {
    double cos2[LQ_GAUSS_MAX], sin2[LQ_GAUSS_MAX], density[LQ_GAUSS_MAX];
    for (int i = 0; i < rule->count; i++) {
        angle[i] = lq_panels_map(panels, p, rule->node[i], &weight[i]);
        const double s = sin(angle[i]), c = cos(angle[i]);
        sin2[i] = s * s;
        cos2[i] = c * c;
        weight[i] *= rule->weight[i] * s;
    }
    ndf->density(ndf, alpha, (size_t)rule->count, cos2, sin2, density);
    for (int i = 0; i < rule->count; i++) weight[i] *= density[i];
}

static void add_azimuths(double theta, double theta_h, double weight, double *sum, double *moment) {
    const double c1 = cos(theta), s1 = sin(theta), ch = cos(theta_h), sh = sin(theta_h);
    double x = -1.0;
    if (2.0 * theta_h + theta > half_pi) x = -(c1 * cos(2.0 * theta_h)) / (s1 * 2.0 * ch * sh);
    x = fmin(fmax(x, -1.0), 1.0);
    const double phi = acos(x), y = sqrt((1.0 - x) * (1.0 + x));
    const double i0 = phi, i1 = y, i2 = 0.5 * (phi + y * x), i3 = y - y * y * y / 3.0;
    const double a = c1 * ch, b = s1 * sh;
    const double m0 = s1 * s1 + 4.0 * sh * sh * a * a, m1 = 8.0 * sh * sh * a * b - 4.0 * sh * s1 * a;
    const double m2 = 4.0 * sh * sh * b * b - 4.0 * sh * s1 * b;
    *sum += weight * (a * i0 + b * i1);
    *moment += weight * (a * m0 * i0 + (b * m0 + a * m1) * i1 + (b * m1 + a * m2) * i2 + b * m2 * i3);
}

static double variance_at(const lq_ndf *ndf, double alpha, double theta, const lq_gauss *rule) {
    lq_panels panels;
    const double top = 0.5 * (half_pi + theta);
    lq_panels_start(&panels, 0.0, top);
    lq_panels_add(&panels, 0.5 * (half_pi - theta), true);
    lq_panels_add(&panels, top, true);
    lq_panels_grade(&panels, 0.0, alpha, 4.0);
    double sum = 0.0, moment = 0.0;
    for (int p = 0; p + 1 < panels.count; p++) {
        double angle[LQ_GAUSS_MAX], weight[LQ_GAUSS_MAX];
        density_on_panel(ndf, alpha, &panels, p, rule, angle, weight);
        for (int i = 0; i < rule->count; i++) add_azimuths(theta, angle[i], weight[i], &sum, &moment);
    }
    return sum > 0.0 ? moment / sum : NAN;
}

double lq_bounce_variance(const lq_ndf *ndf, double alpha, double theta) {
    lq_gauss rule;
    lq_gauss_make(&rule, FINE);
    return variance_at(ndf, alpha, theta, &rule);
}

/* The first lobe lives on half vectors within 45 degrees, omega_1 at twice their angle. */
static void start_lobe(lq_panels *panels, double alpha) {
    lq_panels_start(panels, 0.0, 0.5 * half_pi);
    lq_panels_grade(panels, 0.0, alpha, 4.0);
}

static double two_bounces(const lq_ndf *ndf, double alpha, int nodes) {
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, nodes);
    start_lobe(&panels, alpha);
    lq_panels_add(&panels, 0.5 * half_pi, true);
    double sum = 0.0, moment = 0.0;
    for (int p = 0; p + 1 < panels.count; p++) {
        double angle[LQ_GAUSS_MAX], weight[LQ_GAUSS_MAX];
        density_on_panel(ndf, alpha, &panels, p, &rule, angle, weight);
        for (int i = 0; i < rule.count; i++) {
            const double w = weight[i] * cos(angle[i]);
            sum += w;
            moment += w * variance_at(ndf, alpha, 2.0 * angle[i], &rule);
        }
    }
    return moment / sum;
}

double lq_two_bounce_variance(const lq_ndf *ndf, double alpha, double *estimate) {
    if (estimate) *estimate = 0.0;
    if (alpha <= 0.0) return 0.0;
    const double fine = two_bounces(ndf, alpha, FINE);
    if (estimate) *estimate = fabs(fine - two_bounces(ndf, alpha, COARSE)) + 1e-15;
    return fine;
}

double lq_lobe_fourth_moment(const lq_ndf *ndf, double alpha, double *variance) {
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, 24);
    start_lobe(&panels, alpha);
    double sum = 0.0, second = 0.0, fourth = 0.0;
    for (int p = 0; p + 1 < panels.count; p++) {
        double angle[LQ_GAUSS_MAX], weight[LQ_GAUSS_MAX];
        density_on_panel(ndf, alpha, &panels, p, &rule, angle, weight);
        for (int i = 0; i < rule.count; i++) {
            const double s = sin(2.0 * angle[i]), w = weight[i] * cos(angle[i]);
            sum += w;
            second += w * s * s;
            fourth += w * s * s * s * s;
        }
    }
    if (variance) *variance = second / sum;
    return fourth / sum;
}
