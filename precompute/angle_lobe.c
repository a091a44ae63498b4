/* The lobe of a rough mirror: rings of azimuth at Chebyshev angles, and the series through them. */
#include "precompute/angle_lobe.h"

#include "microfacet/panels.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* -------------------------------------------------------------------------------- one ring */

/* h runs over half the azimuth, measured from where the lobe peaks. With N the sum of both directions,
 * N_z^2 = upright, N_x^2 + N_y^2 = tilt0 + tilt1 sin^2 h; GGX has its poles at sin h = +-i reach. The map
 * h = reach sinh u spreads a peak of that width, and its tails, over pieces of u of bounded length. */
typedef struct ring_shape {
    double upright, tilt0, tilt1, reach;
} ring_shape;

/* Beyond this the peak is wider than the ring and the map does nothing. */
static const double widest_reach = 4.0;
/* Length of a piece of u: 8 nodes reach 3e-7 of the peak, 16 reach rounding. */
static const double piece_length = 4.0;

static ring_shape shape_ring(double alpha, double theta_i, double theta_o) {
    const double half = 0.5 * (theta_o - theta_i), mean = 0.5 * (theta_o + theta_i);
    const double c2 = 4.0 * cos(mean) * cos(mean), s = sin(half), c = cos(half);
    ring_shape r = {.upright = c2 * c * c, .tilt0 = c2 * s * s, .tilt1 = 4.0 * sin(theta_i) * sin(theta_o)};
    const double floor2 = alpha * alpha * r.upright + r.tilt0, cap2 = widest_reach * widest_reach;
    r.reach = floor2 < cap2 * r.tilt1 ? sqrt(floor2 / r.tilt1) : widest_reach;
    return r;
}

/* integral of D over one piece [from, from + length] of u. */
static double ring_piece(const ring_shape *r, const lq_ndf *ndf, double alpha, double from, double length,
                         const lq_gauss *rule) {
    double cos2[LQ_GAUSS_MAX], sin2[LQ_GAUSS_MAX], width[LQ_GAUSS_MAX], density[LQ_GAUSS_MAX];
    for (int i = 0; i < rule->count; i++) {
        const double up = exp(from + length * rule->node[i]), down = 1.0 / up;
        const double s = sin(0.5 * r->reach * (up - down));
        const double tilt = r->tilt0 + r->tilt1 * s * s, inverse = 1.0 / (r->upright + tilt);
        width[i] = 0.5 * r->reach * (up + down) * length * rule->weight[i];
        cos2[i] = r->upright * inverse;
        sin2[i] = tilt * inverse;
    }
    ndf->density(ndf, alpha, (size_t)rule->count, cos2, sin2, density);
    double sum = 0.0;
    for (int i = 0; i < rule->count; i++) sum += width[i] * density[i];
    return sum;
}

/* integral of D/4 over the whole azimuth: four half-angles make the turn. */
static double ring(const lq_ndf *ndf, double alpha, double theta_i, double theta_o, const lq_gauss *rule) {
    const ring_shape r = shape_ring(alpha, theta_i, theta_o);
    if (!(r.upright > 0.0) || !(r.reach > 0.0)) return 0.0;
    const double end = asinh(0.5 * pi / r.reach);
    const int pieces = (int)ceil(end / piece_length);
    const double length = end / pieces;
    double sum = 0.0;
    for (int i = 0; i < pieces; i++) sum += ring_piece(&r, ndf, alpha, i * length, length, rule);
    return sum;
}

static double density_at(const lq_ndf *ndf, double alpha, double theta_i, double theta,
                         const lq_gauss *rule) {
    const double mu = cos(theta), sine = sin(theta);
    if (!(mu > 0.0)) return 0.0;
    const double masking = mu / (mu + ndf->area_below(ndf, alpha, mu, sine));
    return sine * masking * ring(ndf, alpha, theta_i, theta, rule);
}

/* --------------------------------------------------------------------------------- series */

void lq_angle_lobe_rule_make(lq_angle_lobe_rule *rule, int terms, int ring_nodes) {
    rule->terms = terms;
    lq_gauss_make(&rule->ring, ring_nodes);
    for (int j = 0; j < terms; j++) rule->node[j] = -cos(pi * (j + 0.5) / terms);
    for (int k = 0; k < terms; k++)
        for (int j = 0; j < terms; j++)
            rule->cosine[k * terms + j] = (k % 2 ? -1.0 : 1.0) * cos(pi * k * (j + 0.5) / terms);
}

/* Values at the nodes to coefficients; the first one is stored halved, as a sum wants it. */
static void fit_series(const lq_angle_lobe_rule *rule, const double *values, double *series) {
    const int n = rule->terms;
    for (int k = 0; k < n; k++) {
        double sum = 0.0;
        for (int j = 0; j < n; j++) sum += values[j] * rule->cosine[k * n + j];
        series[k] = (k == 0 ? 1.0 : 2.0) / n * sum;
    }
}

/* integral of the series from x = -1, times `scale` = dtheta/dx. */
static void integrate_series(const double *series, int n, double scale, double *integral) {
    double start = 0.0;
    for (int k = 1; k <= n; k++) {
        const double below = k == 1 ? 2.0 * series[0] : series[k - 1],
                     above = k + 1 < n ? series[k + 1] : 0.0;
        integral[k] = scale * (below - above) / (2.0 * k);
        start += (k % 2 ? 1.0 : -1.0) * integral[k];
    }
    integral[0] = start;
}

/* Clenshaw 1955. */
static double sum_series(const double *series, int n, double x) {
    double b1 = 0.0, b2 = 0.0;
    for (int k = n - 1; k > 0; k--) {
        const double b = series[k] + 2.0 * x * b1 - b2;
        b2 = b1;
        b1 = b;
    }
    return series[0] + x * b1 - b2;
}

/* Position on a panel, in [-1,1]. */
static double on_panel(const lq_angle_lobe *lobe, int panel, double theta) {
    const double from = lobe->at[panel], to = lobe->at[panel + 1];
    return fmin(fmax((2.0 * theta - from - to) / (to - from), -1.0), 1.0);
}

/* ---------------------------------------------------------------------------------- lobe */

/* The nearest poles of p are 2 alpha off the peak (GGX: tan(theta_o - theta_i)/2 = i alpha) and alpha off
 * the horizon (masking). */
static void place_panels(lq_angle_lobe *lobe, double alpha, double theta) {
    lq_panels panels;
    lq_panels_start(&panels, 0.0, 0.5 * pi);
    lq_panels_add(&panels, theta, false);
    lq_panels_grade(&panels, theta, alpha, 4.0);
    lq_panels_grade(&panels, 0.5 * pi, alpha, 4.0);
    lobe->panels = panels.count - 1 < LQ_ANGLE_LOBE_PANELS ? panels.count - 1 : LQ_ANGLE_LOBE_PANELS;
    for (int p = 0; p < lobe->panels; p++) lobe->at[p] = panels.at[p];
    lobe->at[lobe->panels] = 0.5 * pi;
}

void lq_angle_lobe_make(lq_angle_lobe *lobe, const lq_ndf *ndf, double alpha, double mu,
                        const lq_angle_lobe_rule *rule) {
    const double theta_i = atan2(lq_sine(mu), mu);
    const int n = rule->terms;
    place_panels(lobe, alpha, theta_i);
    lobe->terms = n;
    lobe->below[0] = 0.0;
    for (int p = 0; p < lobe->panels; p++) {
        const double centre = 0.5 * (lobe->at[p] + lobe->at[p + 1]), half = centre - lobe->at[p];
        double values[LQ_ANGLE_LOBE_TERMS];
        for (int j = 0; j < n; j++)
            values[j] = density_at(ndf, alpha, theta_i, centre + half * rule->node[j], &rule->ring);
        fit_series(rule, values, lobe->density[p]);
        integrate_series(lobe->density[p], n, half, lobe->integral[p]);
        lobe->below[p + 1] = lobe->below[p] + sum_series(lobe->integral[p], n + 1, 1.0);
    }
}

int lq_angle_lobe_panel(const lq_angle_lobe *lobe, double theta, int from) {
    while (from + 1 < lobe->panels && theta > lobe->at[from + 1]) from++;
    return from;
}

double lq_angle_lobe_density(const lq_angle_lobe *lobe, int panel, double theta) {
    return sum_series(lobe->density[panel], lobe->terms, on_panel(lobe, panel, theta));
}

double lq_angle_lobe_below(const lq_angle_lobe *lobe, double theta) {
    const int p = lq_angle_lobe_panel(lobe, theta, 0);
    return lobe->below[p] + sum_series(lobe->integral[p], lobe->terms + 1, on_panel(lobe, p, theta));
}

double lq_angle_lobe_total(const lq_angle_lobe *lobe) {
    return lobe->below[lobe->panels];
}
