/* Travel weights: product integration of the interpolation polynomials in t(u). */
#include "precompute/depth.h"

#include "microfacet/panels.h"

#include <math.h>

enum { NODES = 12 }; /* of the travel integrals, per panel */

static const double pi = 3.14159265358979323846;

static double chebyshev_angle(const lq_depths *depths, int i) {
    return pi * (depths->count - 1 - i + 0.5) / depths->count;
}

/* u(t) = t^4 (35 - 84 t + 70 t^2 - 20 t^3): t ~ u^(1/4) at both ends. */
static double depth_of(double t) {
    return t * t * t * t * (35.0 + t * (-84.0 + t * (70.0 - 20.0 * t)));
}

void lq_depths_make(lq_depths *depths, int count) {
    depths->count = count;
    lq_gauss_make(&depths->rule, NODES);
    for (int i = 0; i < count / 2; i++) {
        depths->u[i] = depth_of(0.5 * (1.0 + cos(chebyshev_angle(depths, i))));
        depths->u[count - 1 - i] = 1.0 - depths->u[i];
    }
}

/* The inverse on [0, 1/2], by Newton from the tangent at 0: u(t) is convex there, so the steps fall short of
 * nothing. */
static double depth_inverse(double u) {
    const double start = sqrt(sqrt(u / 35.0));
    double t = fmin(start * (1.0 + 0.6 * start), 0.5);
    for (int step = 0; step < 6; step++) {
        const double s = t * (1.0 - t), slope = 140.0 * s * s * s;
        if (slope > 0.0) t -= (depth_of(t) - u) / slope;
    }
    return t;
}

/* The angle of t on the Chebyshev circle: 2t - 1 = cos(angle). */
static double depth_angle(double u) {
    const double t = u <= 0.5 ? depth_inverse(u) : 1.0 - depth_inverse(1.0 - u);
    return acos(fmax(fmin(2.0 * t - 1.0, 1.0), -1.0));
}

/* Chebyshev moments in t of weighted depths, turned into weights on the points and scaled to add up to `sum`.
 */
typedef struct moments {
    double of[LQ_DEPTHS_MAX];
} moments;

static void add_depth(moments *m, int count, double u, double weight) {
    const double angle = depth_angle(fmax(fmin(u, 1.0), 0.0)), two_x = 2.0 * cos(angle);
    double before = weight, now = 0.5 * two_x * weight;
    m->of[0] += weight;
    for (int k = 1; k < count; k++) {
        const double next = two_x * now - before;
        m->of[k] += now;
        before = now;
        now = next;
    }
}

static void project(const lq_depths *depths, const moments *m, double sum, double *weights) {
    const int n = depths->count;
    const double scale = m->of[0] > 0.0 ? sum / m->of[0] : 0.0;
    for (int i = 0; i < n; i++) {
        /* sum_k m_k (2 - delta_k0)/n cos(k angle_i), by Clenshaw */
        const double two_x = 2.0 * cos(chebyshev_angle(depths, i));
        double b1 = 0.0, b2 = 0.0;
        for (int k = n - 1; k >= 1; k--) {
            const double b0 = 2.0 / n * m->of[k] + two_x * b1 - b2;
            b2 = b1;
            b1 = b0;
        }
        weights[i] = scale * (m->of[0] / n + 0.5 * two_x * b1 - b2);
    }
}

double lq_survival(double lambda, double from) {
    return from >= 1.0 ? 1.0 : exp(lambda * log(from));
}

/* v in [0,1], the peak of width `width` at v = 1. */
static void peak_panels(lq_panels *panels, double width) {
    lq_panels_start(panels, 0.0, 1.0);
    lq_panels_grade(panels, 1.0, width, 4.0);
}

/* u' = from v^4 makes t ~ u'^(1/4) analytic at 0; with a = 1 + lambda, dq = 4 a v^(4a - 1) dv. */
void lq_travel_down(const lq_depths *depths, double lambda, double from, double *weights) {
    const double a = 1.0 + lambda;
    lq_panels panels;
    moments m = {{0.0}};
    peak_panels(&panels, fmax(1.0 / (4.0 * a), 1e-9));
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < NODES; i++) {
            double slope;
            const double v = lq_panels_map(&panels, p, depths->rule.node[i], &slope);
            const double density = 4.0 * a * exp((4.0 * a - 1.0) * log(v));
            add_depth(&m, depths->count, from * v * v * v * v, depths->rule.weight[i] * slope * density);
        }
    project(depths, &m, 1.0, weights);
}

/* 1 - u' = (1 - from) (1 - x)^4 makes t analytic at u' = 1, x = 1; dq = -lambda (from/u')^lambda du'/u',
 * which peaks at x = 0. */
void lq_travel_up(const lq_depths *depths, double lambda, double from, double *weights) {
    lq_panels panels;
    moments m = {{0.0}};
    const double room = 1.0 - from;
    lq_panels_start(&panels, 0.0, 1.0);
    lq_panels_grade(&panels, 0.0, fmax(from / (4.0 * room * fmax(lambda, 1.0)), 1e-15), 4.0);
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < NODES; i++) {
            double slope;
            const double x = lq_panels_map(&panels, p, depths->rule.node[i], &slope);
            const double y = 1.0 - x, rest = room * x * (1.0 + y) * (1.0 + y * y), u = from + rest;
            const double density = exp(-lambda * log1p(rest / from)) * 4.0 * room * y * y * y / u;
            add_depth(&m, depths->count, u, depths->rule.weight[i] * slope * density);
        }
    /* A peak too narrow for any panel is the depth itself. */
    if (!(m.of[0] > 0.0)) add_depth(&m, depths->count, from, 1.0);
    project(depths, &m, -expm1(lambda * log(from)), weights);
}
