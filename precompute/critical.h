/* Where the energies of a material with a critical angle (n < 1, small kappa) are not smooth, and how the
 * axes of the solver of conductor.h are divided there.
 *
 * F has a kink at cos d = c = sqrt(1 - n^2), which reaches the energies at these cosines:
 *  - rising at n: above it a ray meets no facet below the critical angle;
 *  - falling at n: the critical cone touches the horizon;
 *  - falling at s = sin 2d = 2 n c: light that critical facets reflect leaves along the horizon. It counts
 *    where media nearly match, since nothing but total reflection is worth anything then, and n hardly does;
 *  - falling at c, within alpha: the facets of a narrow lobe all lie there.
 */
#ifndef LACQUER_PRECOMPUTE_CRITICAL_H
#define LACQUER_PRECOMPUTE_CRITICAL_H

#include <stdbool.h>

enum { LQ_CRITICAL_MAX = 3 };

/* Cosines that divide the two axes, ascending; none where there is no critical angle. */
typedef struct lq_critical {
    double distance; /* of the branch point from the real angles; only where there are divisions */
    int down_count, up_count;
    double down[LQ_CRITICAL_MAX], up[LQ_CRITICAL_MAX];
} lq_critical;

/* `fine`: with the weak ones, which matter to many nodes alone. */
lq_critical lq_critical_find(double alpha, double n, double kappa, bool fine);

#endif
