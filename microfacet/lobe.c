/* Lobe variance by quadrature: at normal incidence the lobe is D(m) cos theta_m over normals within 45
 * degrees. */
#include "microfacet/lobe.h"

#include "microfacet/ggx.h"
#include "microfacet/panels.h"

#include <math.h>

/* f_r cos theta_o domega_o = D(m)/4 domega_o, and domega_o = 4 cos theta_m dm with theta_o = 2 theta_m. */
double lq_lobe_variance(const lq_ndf *ndf, double alpha) {
    if (alpha <= 0.0) return 0.0;
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, 24);
    lq_panels_start(&panels, 0.0, 0.78539816339744830962);
    lq_panels_grade(&panels, 0.0, alpha, 4.0);
    double sum = 0.0, moment = 0.0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule.count; i++) {
            double slope, density;
            const double theta = lq_panels_map(&panels, p, rule.node[i], &slope);
            const double s = sin(theta), c = cos(theta), s2 = s * s, c2 = c * c;
            ndf->density(ndf, alpha, 1, &c2, &s2, &density);
            const double weight = rule.weight[i] * slope * density * s * c;
            sum += weight;
            moment += weight * 4.0 * s2 * c2;
        }
    return moment / sum;
}

double lq_lobe_roughness(const lq_ndf *ndf, double variance) {
    /* An NDF of one roughness has no other to offer: then GGX stands in. */
    if (ndf->alpha_max > 0.0 && ndf->alpha_min == ndf->alpha_max) ndf = &lq_ggx;
    double low = 0.0, high = 1.0, below = variance, above = lq_lobe_variance(ndf, 1.0) - variance;
    if (variance <= 0.0) return 0.0;
    if (above <= 0.0) return 1.0;
    /* The Illinois variant of regula falsi: an NDF may tabulate each roughness it is asked for. */
    for (int step = 0, side = 0; step < 60 && high - low > 1e-14; step++) {
        const double at = (low * above + high * below) / (above + below);
        const double gap = lq_lobe_variance(ndf, at) - variance;
        if (gap == 0.0 || at == low || at == high) return at;
        if (gap < 0.0) {
            low = at;
            below = -gap;
            if (side < 0) above *= 0.5;
            side = -1;
        } else {
            high = at;
            above = gap;
            if (side > 0) below *= 0.5;
            side = 1;
        }
        if (fabs(gap) < 1e-15) return at;
    }
    return 0.5 * (low + high);
}
