/* Lobe variance by quadrature: at normal incidence the lobe is D(m) cos theta_m over normals within 45
 * degrees. */
#include "microfacet/lobe.h"

#include "microfacet/ggx.h"
#include "microfacet/panels.h"
#include "microfacet/root.h"

#include <math.h>

enum { NODES = 24 }; /* a panel */

/* f_r cos theta_o domega_o = D(m)/4 domega_o, and domega_o = 4 cos theta_m dm with theta_o = 2 theta_m. */
static double variance_by(const lq_gauss *rule, const lq_ndf *ndf, double alpha) {
    if (alpha <= 0.0) return 0.0;
    lq_panels panels;
    lq_panels_start(&panels, 0.0, 0.78539816339744830962);
    lq_panels_grade(&panels, 0.0, alpha, 4.0);
    double sum = 0.0, moment = 0.0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < rule->count; i++) {
            double slope, density;
            const double theta = lq_panels_map(&panels, p, rule->node[i], &slope);
            const double s = sin(theta), c = cos(theta), s2 = s * s, c2 = c * c;
            ndf->density(ndf, alpha, 1, &c2, &s2, &density);
            const double weight = rule->weight[i] * slope * density * s * c;
            sum += weight;
            moment += weight * 4.0 * s2 * c2;
        }
    return moment / sum;
}

double lq_lobe_variance(const lq_ndf *ndf, double alpha) {
    lq_gauss rule;
    lq_gauss_make(&rule, NODES);
    return variance_by(&rule, ndf, alpha);
}

/* The rule is made once for all steps to the root. */
typedef struct wanted {
    lq_gauss rule;
    const lq_ndf *ndf;
    double variance;
} wanted;

static double variance_gap(const void *user, double alpha) {
    const wanted *w = user;
    return variance_by(&w->rule, w->ndf, alpha) - w->variance;
}

double lq_lobe_roughness(const lq_ndf *ndf, double variance) {
    /* An NDF of one roughness has no other to offer: then GGX stands in. */
    if (ndf->alpha_max > 0.0 && ndf->alpha_min == ndf->alpha_max) ndf = &lq_ggx;
    wanted w = {.ndf = ndf, .variance = variance};
    lq_gauss_make(&w.rule, NODES);
    const double above = variance_gap(&w, 1.0);
    if (variance <= 0.0) return 0.0;
    if (above <= 0.0) return 1.0;
    return lq_root(variance_gap, &w, 0.0, -variance, 1.0, above, 1e-15);
}
