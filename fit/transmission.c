/* Transmission by quadrature over half vectors and azimuths.
 *
 *     t = -eta12 i + (eta12 c - sqrt(1 - eta12^2 (1 - c^2))) h,   c = i.h > 0
 *
 * and in the disc only the parts of i and h across the normal matter. */
#include "fit/transmission.h"

#include "microfacet/panels.h"

#include <math.h>

enum { AZIMUTHS = 48, NODES = 16 };
static const double pi = 3.14159265358979323846;

typedef struct moments {
    double seen, mass, x, square;
} moments;

/* One facet at polar angle theta_h, azimuth phi to the plane of incidence. */
static void cross(moments *m, double mu, double s1, double ch, double sh, double phi, double eta12,
                  double weight) {
    const double hx = sh * cos(phi), hy = sh * sin(phi), c = mu * ch + s1 * hx;
    if (c <= 0.0) return;
    weight *= c;
    m->seen += weight;
    const double inside = 1.0 - eta12 * eta12 * (1.0 - c * c);
    if (inside <= 0.0) return;
    const double k = eta12 * c - sqrt(inside), x = k * hx - eta12 * s1, y = k * hy;
    const double z = k * ch - eta12 * mu;
    if (z >= 0.0) return; /* towards the side it came from */
    m->mass += weight;
    m->x += weight * x;
    m->square += weight * (x * x + y * y);
}

static moments gather(const lq_ndf *ndf, double alpha, double eta, double mu, const lq_gauss *rule) {
    moments m = {0};
    lq_panels panels;
    const double s1 = lq_sine(mu);
    lq_panels_start(&panels, 0.0, 0.5 * pi);
    lq_panels_add(&panels, 0.5 * pi - acos(mu), true);
    if (eta < 1.0) /* the critical angle, where it meets the plane of incidence */
        lq_panels_add(&panels, fabs(asin(eta) - acos(mu)), true);
    lq_panels_grade(&panels, 0.0, alpha, 4.0);
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule->count; i++) {
            double weight, density;
            const double theta = lq_panels_map(&panels, p, rule->node[i], &weight);
            const double s = sin(theta), c = cos(theta), s2 = s * s, c2 = c * c;
            ndf->density(ndf, alpha, 1, &c2, &s2, &density);
            weight *= rule->weight[i] * s * density / AZIMUTHS;
            for (int j = 0; j < AZIMUTHS; j++)
                cross(&m, mu, s1, c, s, pi * (j + 0.5) / AZIMUTHS, 1.0 / eta, weight);
        }
    return m;
}

double lq_transmitted_variance(const lq_ndf *ndf, double alpha, double eta, double mu, double *passed) {
    lq_gauss rule;
    lq_gauss_make(&rule, NODES);
    /* the mean along x is taken out with respect to the smooth direction: no cancellation */
    const moments m = gather(ndf, alpha, eta, mu, &rule);
    if (passed) *passed = m.seen > 0.0 ? m.mass / m.seen : 0.0;
    if (!(m.mass > 0.0)) return NAN;
    const double mean = m.x / m.mass;
    return m.square / m.mass - mean * mean;
}

double lq_transmission_scale(double eta, double mu, double *ratio) {
    const double eta12 = 1.0 / eta, mu_t2 = 1.0 - eta12 * eta12 * (1.0 - mu) * (1.0 + mu);
    const double r = mu_t2 > 0.0 ? eta12 * mu / sqrt(mu_t2) : NAN;
    if (ratio) *ratio = r;
    return 0.5 * fabs(1.0 - r);
}

double lq_transmitted_lobe_variance(const lq_ndf *ndf, double beta, double alpha, double eta) {
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, NODES);
    lq_panels_start(&panels, 0.0, 0.25 * pi);
    if (eta < 1.0) lq_panels_add(&panels, 0.5 * asin(eta), true);
    lq_panels_grade(&panels, 0.0, beta, 4.0);
    double sum = 0.0, moment = 0.0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule.count; i++) {
            double weight, density;
            const double theta = lq_panels_map(&panels, p, rule.node[i], &weight);
            const double s = sin(theta), c = cos(theta), s2 = s * s, c2 = c * c;
            ndf->density(ndf, beta, 1, &c2, &s2, &density);
            weight *= rule.weight[i] * s * c * density;
            const double sine = 2.0 * s * c, out = sine / eta;
            if (alpha <= 0.0) {
                if (out >= 1.0) continue;
                sum += weight;
                moment += weight * out * out;
                continue;
            }
            const moments m = gather(ndf, alpha, eta, cos(2.0 * theta), &rule);
            if (!(m.mass > 0.0)) continue;
            sum += weight * m.mass / m.seen;
            moment += weight * m.square / m.seen;
        }
    return moment / sum;
}
