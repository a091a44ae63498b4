/* Travel weights: product integration of the interpolation polynomials in t. */
#include "precompute/depth.h"

#include "microfacet/panels.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static double chebyshev_angle(const lq_depths *depths, int i) {
    return pi * (depths->count - 1 - i + 0.5) / depths->count;
}

/* A depth u = I_t(8, 8), t ~ u^(1/8) at both ends. */
typedef struct depth {
    double u, log_u, slope; /* slope: du/dt */
} depth;

/* I_t(8, 8) / (t^8 (1 - t)^7) with r = t / (1 - t): no term is negative. */
static double beta_series(double r) {
    return 6435.0 + r * (5005.0 + r * (3003.0 + r * (1365.0 + r * (455.0 + r * (105.0 + r * (15.0 + r))))));
}

static double incomplete_beta(double t) {
    const double s = 1.0 - t, square = t * s * t * s;
    return square * square * square * t * s * t * beta_series(t / s);
}

static depth depth_at(double t) {
    const double s = 1.0 - t, square = t * s * t * s, slope = 51480.0 * square * square * square * t * s;
    const double near = incomplete_beta(fmin(t, s)), u = t <= 0.5 ? near : 1.0 - near;
    return (depth){u, t <= 0.5 ? log(near) : log1p(-near), slope};
}

/* t where u << 1. */
static double shallow(double u) {
    return sqrt(sqrt(sqrt(u / 6435.0)));
}

void lq_depths_make(lq_depths *depths, int count) {
    depths->count = count;
    /* Polynomials of degree count - 1, and a density that is one of some dozen degrees on every panel. */
    lq_gauss_make(&depths->rule, count / 2 + 8);
    for (int i = 0; i < count; i++) depths->two_x[i] = 2.0 * cos(chebyshev_angle(depths, i));
    for (int i = 0; i < count / 2; i++) {
        depths->t[i] = 0.5 * (1.0 + cos(chebyshev_angle(depths, i)));
        depths->t[count - 1 - i] = 1.0 - depths->t[i];
        depths->u[i] = depth_at(depths->t[i]).u;
        depths->u[count - 1 - i] = 1.0 - depths->u[i];
    }
}

double lq_survival(double lambda, double from) {
    return from >= 1.0 ? 1.0 : exp(lambda * log(from));
}

double lq_reflected_escape(double lambda_i, double lambda_o) {
    return (1.0 + lambda_i) / (1.0 + lambda_i + lambda_o);
}

double lq_refracted_escape(double lambda_i, double lambda_o) {
    return (1.0 + lambda_i) *
           exp(lgamma(1.0 + lambda_i) + lgamma(1.0 + lambda_o) - lgamma(2.0 + lambda_i + lambda_o));
}

/* Chebyshev moments in t of weighted depths. */
typedef struct moments {
    double of[LQ_DEPTHS_MAX];
} moments;

static void add_depths(moments *m, int degrees, int count, const double *t, const double *weight) {
    double before[LQ_GAUSS_MAX], now[LQ_GAUSS_MAX], two_x[LQ_GAUSS_MAX];
    for (int i = 0; i < count; i++) {
        two_x[i] = 4.0 * t[i] - 2.0;
        before[i] = weight[i];
        now[i] = 0.5 * two_x[i] * weight[i];
        m->of[0] += weight[i];
    }
    for (int k = 1; k < degrees; k++) {
        double sum = 0.0;
        for (int i = 0; i < count; i++) {
            const double next = two_x[i] * now[i] - before[i];
            sum += now[i];
            before[i] = now[i];
            now[i] = next;
        }
        m->of[k] += sum;
    }
}

/* Moments turned into weights on the points, scaled to add up to `sum`. */
static void project(const lq_depths *depths, const moments *m, double sum, double *weights) {
    const int n = depths->count;
    const double scale = m->of[0] > 0.0 ? sum / m->of[0] : 0.0;
    /* sum_k m_k (2 - delta_k0)/n cos(k angle_i) by Clenshaw, all points abreast */
    double b1[LQ_DEPTHS_MAX] = {0.0}, b2[LQ_DEPTHS_MAX] = {0.0};
    for (int k = n - 1; k >= 1; k--) {
        const double next = 2.0 / n * m->of[k];
        for (int i = 0; i < n; i++) {
            const double b0 = next + depths->two_x[i] * b1[i] - b2[i];
            b2[i] = b1[i];
            b1[i] = b0;
        }
    }
    for (int i = 0; i < n; i++) weights[i] = scale * (m->of[0] / n + 0.5 * depths->two_x[i] * b1[i] - b2[i]);
}

/* Moments of exp(power (ln u - ln u0)) power/u du over the panels. */
static void add_power(const lq_depths *depths, const lq_panels *panels, double power, double log_from,
                      moments *m) {
    const int nodes = depths->rule.count;
    for (int p = 0; p + 1 < panels->count; p++) {
        double t[LQ_GAUSS_MAX], weight[LQ_GAUSS_MAX];
        for (int i = 0; i < nodes; i++) {
            double slope;
            t[i] = lq_panels_map(panels, p, depths->rule.node[i], &slope);
            const depth d = depth_at(t[i]);
            weight[i] = depths->rule.weight[i] * slope * fabs(power) * exp(power * (d.log_u - log_from)) *
                        d.slope / d.u;
        }
        add_depths(m, depths->count, nodes, t, weight);
    }
}

/* The distance in t over which u^power falls by e. At the shallow end, where du/dt vanishes, 1 - u does. */
static double decay(double t, const depth *d, double power) {
    return fmin(d->u / (power * d->slope), fmax(shallow(1.0 / power), 0.25 * (1.0 - t)));
}

static void power_panels(lq_panels *panels, double from, double to, double peak, double width) {
    lq_panels_start(panels, from, to);
    lq_panels_grade(panels, peak, fmax(width, 1e-15), 2.0);
}

static void down(const lq_depths *depths, double lambda, double t, const depth *d, double *weights) {
    lq_panels panels;
    moments m = {{0.0}};
    power_panels(&panels, 0.0, t, t, decay(t, d, 1.0 + lambda));
    add_power(depths, &panels, 1.0 + lambda, d->log_u, &m);
    /* A peak too narrow for any panel is the depth itself. */
    if (!(m.of[0] > 0.5)) {
        const double all = 1.0;
        m = (moments){{0.0}};
        add_depths(&m, depths->count, 1, &t, &all);
    }
    project(depths, &m, 1.0, weights);
}

void lq_travel_down(const lq_depths *depths, double lambda, int k, double *weights) {
    const depth d = depth_at(depths->t[k]);
    down(depths, lambda, depths->t[k], &d, weights);
}

void lq_arrival(const lq_depths *depths, double lambda, double *weights) {
    const depth top = {1.0, 0.0, 0.0};
    down(depths, lambda, 1.0, &top, weights);
}

void lq_travel_up(const lq_depths *depths, double lambda, int k, double *weights) {
    lq_panels panels;
    moments m = {{0.0}};
    const double t = depths->t[k], one = 1.0;
    const depth d = depth_at(t);
    const double hits = -expm1(lambda * d.log_u);
    power_panels(&panels, t, 1.0, t, fmin(d.u / (lambda * d.slope), t));
    add_power(depths, &panels, -lambda, d.log_u, &m);
    if (!(m.of[0] > 0.5 * hits)) {
        m = (moments){{0.0}};
        add_depths(&m, depths->count, 1, &t, &one);
    }
    project(depths, &m, hits, weights);
}

/* (1 + lambda_i) times the integral over v in (from, to) of (v / to)^lambda_o (1 - v)^lambda_i dv / to. The
 * power of v is the variable. */
static double refracted_between(double lambda_i, double lambda_o, double from, double to) {
    static const double node[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const double power = 1.0 + lambda_o, least = from > 0.0 ? exp(power * log(from / to)) : 0.0;
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        const double v = to * exp(log(least + (1.0 - least) * node[i]) / power);
        sum += weight[i] * exp(lambda_i * log1p(-fmin(v, 1.0 - 1e-16)));
    }
    return (1.0 - least) * (1.0 + lambda_i) / power * sum;
}

/* Light arrives at v = 1 - u with the density (1 + lambda_i) (1 - v)^lambda_i and goes on to its next facet
 * at v' with lambda_o v^lambda_o v'^(-lambda_o - 1): the integral over v < v' is carried along with v'. */
void lq_refracted_hits(const lq_depths *depths, double lambda_i, double lambda_o, double *weights) {
    const int nodes = depths->rule.count;
    lq_panels panels;
    moments m = {{0.0}};
    double arrived = 0.0, last = 0.0;
    power_panels(&panels, 0.0, 1.0, 0.0, 0.5 * shallow(1.0 / (1.0 + lambda_i)));
    for (int p = 0; p + 1 < panels.count; p++) {
        double t[LQ_GAUSS_MAX], weight[LQ_GAUSS_MAX];
        for (int i = 0; i < nodes; i++) {
            double slope;
            t[i] = lq_panels_map(&panels, p, depths->rule.node[i], &slope);
            const depth d = depth_at(t[i]);
            arrived *= last > 0.0 ? exp((1.0 + lambda_o) * (log(last) - d.log_u)) : 0.0;
            arrived += refracted_between(lambda_i, lambda_o, last, d.u);
            weight[i] = depths->rule.weight[i] * slope * lambda_o * arrived * d.slope;
            last = d.u;
        }
        add_depths(&m, depths->count, nodes, t, weight);
    }
    project(depths, &m, 1.0 - lq_refracted_escape(lambda_i, lambda_o), weights);
}
