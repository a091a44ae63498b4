/* Transmission by quadrature over half vectors and azimuths.
 *
 *     t = -eta12 i + k h,   k = eta12 c - sqrt(1 - eta12^2 (1 - c^2)),   c = i.h > 0
 *
 * and in the disc only the parts of i and h across the normal matter. Around a half vector's cone the facets
 * that transmit downwards are those with c above a least value, known in closed form, so that every integral
 * ends where its integrand does. */
#include "fit/transmission.h"

#include "microfacet/panels.h"

#include <math.h>

/* Nodes of the rule that answers; the estimate is what a rule of two thirds of them is off by, twice. */
enum { NODES = 24, FEWER = 16 };
static const double pi = 3.14159265358979323846;

/* Of what is transmitted, about the point of the disc to which a smooth interface would send it (or its rim):
 * no cancellation in what a lobe spreads about it. */
typedef struct moments {
    double seen, mass, x, square, centre;
} moments;

static double clamp_cosine(double c) {
    return fmin(fmax(c, -1.0), 1.0);
}

/* The least c that transmits to the other side, of half vectors at cosine ch. Below the first bound
 * reflection is total; below the second the refracted ray rises, k ch > eta12 mu, which k, falling with c,
 * does not later. */
static double least_cosine(double mu, double ch, double eta12) {
    if (eta12 <= 1.0) return 0.0;
    const double critical = sqrt((eta12 - 1.0) * (eta12 + 1.0)), level = eta12 * mu / ch;
    const double total = critical / eta12;
    return level >= critical ? total
                             : fmax(total, (level * level + critical * critical) / (2.0 * eta12 * level));
}

/* The facets of one cone: sums over the azimuths that transmit, of both halves together. */
static void cone(moments *m, double mu, double s1, double ch, double sh, double eta12, const lq_gauss *rule,
                 double weight) {
    const double middle = mu * ch, swing = s1 * sh;
    const double lit = swing > 0.0 ? acos(clamp_cosine(-middle / swing)) : pi;
    m->seen += weight * (middle * lit + swing * sin(lit)) / pi;
    const double least = least_cosine(mu, ch, eta12);
    const double reach = swing > 0.0      ? acos(clamp_cosine((least - middle) / swing))
                         : middle > least ? pi
                                          : 0.0;
    for (int i = 0; i < rule->count; i++) {
        double slope;
        const double phi = lq_map_ends(0.0, reach, false, true, rule->node[i], &slope);
        const double c = middle + swing * cos(phi);
        const double inside = fmax(1.0 - eta12 * eta12 * (1.0 - c) * (1.0 + c), 0.0);
        const double k = eta12 * c - sqrt(inside), share = weight * rule->weight[i] * slope * c / pi;
        const double x = k * sh * cos(phi) - (eta12 * s1 - m->centre), y = k * sh * sin(phi);
        m->mass += share;
        m->x += share * x;
        m->square += share * (x * x + y * y);
    }
}

/* Where, in the plane of incidence, a refracted ray leaves along the horizon: theta_h + asin(sin(theta_i -
 * theta_h) / eta) = pi/2, falling between theta_i - critical and theta_i. */
static double horizon_angle(double theta_i, double eta, double critical) {
    double low = theta_i - critical, high = theta_i;
    for (int step = 0; step < 60; step++) {
        const double at = 0.5 * (low + high), out = at + asin(clamp_cosine(sin(theta_i - at) / eta));
        *(out > 0.5 * pi ? &low : &high) = at;
    }
    return 0.5 * (low + high);
}

/* Polar angles where the azimuths that transmit open, close, fill the circle, or end for another reason. */
static void split(lq_panels *panels, double theta_i, double mu, double eta) {
    lq_panels_add(panels, 0.5 * pi - theta_i, true);
    if (eta >= 1.0) return;
    const double critical = asin(eta), cosine = sqrt((1.0 - eta) * (1.0 + eta));
    lq_panels_add(panels, fabs(theta_i - critical), true);
    lq_panels_add(panels, theta_i + critical, true);
    if (theta_i > critical) lq_panels_add(panels, horizon_angle(theta_i, eta, critical), true);
    if (mu < cosine) lq_panels_add(panels, acos(mu / cosine), true);
}

static moments gather(const lq_ndf *ndf, double alpha, double eta, double mu, const lq_gauss *rule) {
    moments m = {0};
    lq_panels panels;
    const double s1 = lq_sine(mu), eta12 = 1.0 / eta;
    m.centre = fmin(eta12 * s1, 1.0);
    lq_panels_start(&panels, 0.0, 0.5 * pi);
    split(&panels, acos(mu), mu, eta);
    lq_panels_grade(&panels, 0.0, alpha, 4.0);
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule->count; i++) {
            double slope, density;
            const double theta = lq_panels_map(&panels, p, rule->node[i], &slope);
            const double s = sin(theta), c = cos(theta), s2 = s * s, c2 = c * c;
            ndf->density(ndf, alpha, 1, &c2, &s2, &density);
            cone(&m, mu, s1, c, s, eta12, rule, rule->weight[i] * slope * s * density);
        }
    return m;
}

static double variance_by(const lq_ndf *ndf, double alpha, double eta, double mu, int nodes, double *passed) {
    lq_gauss rule;
    lq_gauss_make(&rule, nodes);
    const moments m = gather(ndf, alpha, eta, mu, &rule);
    *passed = m.seen > 0.0 ? m.mass / m.seen : 0.0;
    if (!(m.mass > 0.0)) return NAN;
    const double mean = m.x / m.mass;
    return m.square / m.mass - mean * mean;
}

double lq_transmitted_variance(const lq_ndf *ndf, double alpha, double eta, double mu, double *passed,
                               double *estimate) {
    double share;
    const double value = variance_by(ndf, alpha, eta, mu, NODES, &share);
    if (passed) *passed = share;
    if (estimate) *estimate = 1e-14 + 2.0 * fabs(variance_by(ndf, alpha, eta, mu, FEWER, &share) - value);
    return value;
}

double lq_transmission_scale(double eta, double mu, double *ratio) {
    const double eta12 = 1.0 / eta, mu_t2 = 1.0 - eta12 * eta12 * (1.0 - mu) * (1.0 + mu);
    const double r = mu_t2 > 0.0 ? eta12 * mu / sqrt(mu_t2) : NAN;
    if (ratio) *ratio = r;
    return 0.5 * fabs(1.0 - r);
}

static double lobe_by(const lq_ndf *ndf, double beta, double alpha, double eta, int nodes) {
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, nodes);
    lq_panels_start(&panels, 0.0, 0.25 * pi);
    if (eta < 1.0) lq_panels_add(&panels, 0.5 * asin(eta), true);
    lq_panels_grade(&panels, 0.0, beta, 4.0);
    double sum = 0.0, moment = 0.0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule.count; i++) {
            double slope, density;
            const double theta = lq_panels_map(&panels, p, rule.node[i], &slope);
            const double s = sin(theta), c = cos(theta), s2 = s * s, c2 = c * c;
            ndf->density(ndf, beta, 1, &c2, &s2, &density);
            const double weight = rule.weight[i] * slope * s * c * density;
            const double out = 2.0 * s * c / eta;
            if (alpha <= 0.0) {
                if (out >= 1.0) continue;
                sum += weight;
                moment += weight * out * out;
                continue;
            }
            const moments m = gather(ndf, alpha, eta, cos(2.0 * theta), &rule);
            if (!(m.mass > 0.0)) continue;
            sum += weight * m.mass / m.seen;
            moment += weight * (m.square + m.centre * (m.centre * m.mass - 2.0 * m.x)) / m.seen;
        }
    return moment / sum;
}

double lq_transmitted_lobe_variance(const lq_ndf *ndf, double beta, double alpha, double eta,
                                    double *estimate) {
    const double value = lobe_by(ndf, beta, alpha, eta, NODES);
    if (estimate) *estimate = 1e-14 + 2.0 * fabs(lobe_by(ndf, beta, alpha, eta, FEWER) - value);
    return value;
}
