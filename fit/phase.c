/* The variance of a phase function by quadrature: stable at every g, where the closed form cancels. */
#include "fit/phase.h"

#include "microfacet/panels.h"

#include <math.h>

static double variance_by(double g, int nodes) {
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, nodes);
    lq_panels_start(&panels, 0.0, 1.57079632679489661923);
    lq_panels_grade(&panels, 0.0, 1.0 - g, 4.0);
    double sum = 0.0, moment = 0.0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule.count; i++) {
            double weight;
            const double theta = lq_panels_map(&panels, p, rule.node[i], &weight), s = sin(theta);
            const double half = sin(0.5 * theta);
            const double base = (1.0 - g) * (1.0 - g) + 4.0 * g * half * half; /* 1 + g^2 - 2 g cos theta */
            weight *= rule.weight[i] * s / (base * sqrt(base));
            sum += weight;
            moment += weight * s * s;
        }
    return moment / sum;
}

double lq_phase_variance(double g, double *estimate) {
    const double value = g < 1.0 ? variance_by(g, 24) : 0.0;
    if (estimate) *estimate = g < 1.0 ? 1e-15 + 2.0 * fabs(variance_by(g, 16) - value) : 0.0;
    return value;
}
