/* Cosines of critical angles, chosen by what a sweep of divisions over alpha and n left in energies
 * (docs/theory.md). */
#include "precompute/critical.h"

#include "microfacet/fresnel.h"

#include <math.h>
#include <stdbool.h>

/* Further from the real angles, kinks are so smooth that undivided axes do. */
static const double FAR = 0.15;

/* From this index on media nearly match. */
static const double MATCHING = 0.87;

/* Elements shorter than this are not worth their nodes. */
static const double SHORT = 0.03;

/* Insert a cosine, unless another one is near or it is an end of the axis. */
static void add(double *at, int *count, double cosine) {
    int i = *count;
    if (cosine < 1e-6 || cosine > 1.0 - 1e-6) return;
    for (int k = 0; k < *count; k++)
        if (fabs(at[k] - cosine) < SHORT) return;
    for (; i > 0 && at[i - 1] > cosine; i--) at[i] = at[i - 1];
    at[i] = cosine;
    ++*count;
}

lq_critical lq_critical_find(double alpha, double n, double kappa, bool fine) {
    lq_fresnel_singularity found[2];
    lq_fresnel_singularities(n, kappa, found);
    lq_critical k = {.distance = found[0].distance};
    const double c = cos(found[0].angle), sine = sin(found[0].angle);
    if (n >= 1.0 || k.distance > FAR || c < 1e-6 || sine < 1e-6) return k;
    const bool matching = n > MATCHING, wide = alpha >= fmin(0.2, 0.5 * c);
    const double turn = matching ? 2.0 * sine * c : sine;
    if (!wide) add(k.down, &k.down_count, c);
    if (wide || fine || (alpha >= 0.05 && c < 1.0 - SHORT)) add(k.down, &k.down_count, turn);
    if (matching && fine) add(k.down, &k.down_count, sine);
    add(k.up, &k.up_count, wide ? turn : sine);
    if (matching && fine) add(k.up, &k.up_count, sine);
    return k;
}
