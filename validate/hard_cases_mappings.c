/* Ends and the pole of the roughness mapping f (B18 App. A), and of the phase function's variance (B18 eq.
 * 21). */
#include "validate/hard_cases.h"

#include "fit/curve.h"
#include "fit/phase.h"
#include "microfacet/lobe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void judge(const lq_hard_run *run, const char *group, const char *asked, double value, double limit,
                  double within) {
    lq_hard_result result = {group, "", value, value, limit - within, limit + within, false};
    snprintf(result.asked, sizeof result.asked, "%s", asked);
    result.passed = value >= result.low && value <= result.high;
    run->report(run->user, &result);
}

/* Close below the pole two bounces are so near to one that f grows without end; it must not fall, and its
 * inverse must come back. */
static void judge_curve(const lq_hard_run *run, const lq_curve *curve) {
    static const double close[] = {0.9, 0.99, 0.999, 0.9999, 0.99999};
    double rises = 1.0, back = 0.0, before = 0.0;
    for (size_t i = 0; i < sizeof close / sizeof *close; i++) {
        const double alpha = close[i] * curve->pole, f = lq_curve_f(curve, alpha);
        if (!(f > before || isinf(f))) rises = 0.0; /* beyond a double: infinite, as documented */
        before = f;
        if (isfinite(f)) back = fmax(back, fabs(lq_curve_inverse(curve, f) / alpha - 1.0));
    }
    judge(run, "alpha = 0", "f alpha=0", lq_curve_f(curve, 0.0), 0.0, 0.0);
    judge(run, "alpha = 0", "f-inverse f=0", lq_curve_inverse(curve, 0.0), 0.0, 0.0);
    judge(run, "alpha = 1e-4", "f(alpha) / variance of one bounce at alpha=1e-4",
          lq_curve_f(curve, 1e-4) / lq_lobe_variance(curve->ndf, 1e-4), 1.0, 1e-4);
    judge(run, "pole of f", "1 / f at the pole (alpha = 1 for ggx)", 1.0 / lq_curve_f(curve, curve->pole),
          0.0, 0.0);
    judge(run, "pole of f", "1 where f rises over 0.9 to 0.99999 of the pole", rises, 1.0, 0.0);
    judge(run, "pole of f", "f-inverse(f(alpha)) / alpha - 1 over the same", back, 0.0, 1e-6);
}

/* g = 0 scatters evenly: E[sin^2] of a hemisphere is 2/3. */
static void judge_phase(const lq_hard_run *run) {
    judge(run, "g = 0, 1", "forward variance of Henyey-Greenstein g=0", lq_phase_variance(0.0, NULL),
          2.0 / 3.0, 1e-12);
    judge(run, "g = 0, 1", "forward variance of Henyey-Greenstein g=1e-6", lq_phase_variance(1e-6, NULL),
          2.0 / 3.0, 1e-6);
    judge(run, "g = 0, 1", "forward variance of Henyey-Greenstein g=1-1e-6",
          lq_phase_variance(1.0 - 1e-6, NULL), 0.0, 1e-5);
    judge(run, "g = 0, 1", "forward variance of Henyey-Greenstein g=1", lq_phase_variance(1.0, NULL), 0.0,
          0.0);
}

lq_status lq_hard_mappings(const lq_hard_run *run, lq_error *error) {
    const lq_ndf *ndf;
    lq_error none = {""};
    lq_curve *curve = malloc(sizeof *curve);
    lq_status status = lq_ndf_open(&ndf, run->ndf, error);
    /* An NDF without roughnesses down to 0 has no f. */
    if (status == LQ_OK && curve && lq_curve_make(curve, ndf, &none) == LQ_OK) judge_curve(run, curve);
    if (status == LQ_OK) judge_phase(run);
    if (status == LQ_OK) lq_ndf_close(ndf);
    free(curve);
    return status;
}
