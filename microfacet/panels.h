/* Panels of a one-dimensional integral: break points, and which of them are singular.
 *
 * A break point is singular when the integrand goes there like a half-integer power of the distance (a
 * critical angle, the opening of an azimuth range). The nodes of a panel are then mapped quadratically
 * towards that end, which makes the integrand analytic again and keeps Gauss-Legendre spectral.
 */
#ifndef LACQUER_MICROFACET_PANELS_H
#define LACQUER_MICROFACET_PANELS_H

#include "microfacet/gauss.h"

#include <stdbool.h>

enum { LQ_PANELS_MAX = 512 };

typedef struct lq_panels {
    int count; /* of break points; panels are one fewer */
    double at[LQ_PANELS_MAX];
    bool singular[LQ_PANELS_MAX];
} lq_panels;

/* Start with the two ends of the interval. */
void lq_panels_start(lq_panels *panels, double from, double to);

/* Insert a break point; outside the interval it is ignored, on an existing one it only adds its
 * singularity. Past LQ_PANELS_MAX it is ignored too: the panel stays wider than wished. */
void lq_panels_add(lq_panels *panels, double at, bool singular);

/* Break points centre +- width ratio^k for k = 0, 1, ...: resolves a feature of that width whose tails fall
 * like a power. One that would fall close to a singular break point is left out: it would cut off that
 * point's own panel and leave the singularity just beyond the end of the next. Add the singular ones first.
 */
void lq_panels_grade(lq_panels *panels, double centre, double width, double ratio);

/* Bisect every panel that is wide against its distance to a singular break point not its own. */
void lq_panels_separate(lq_panels *panels);

/* Node `u` in [0,1] of panel `p`: its position; *slope gets d position / du. */
double lq_panels_map(const lq_panels *panels, int p, double u, double *slope);

/* The quadratic map itself, on [from, to] with the given singular ends. */
double lq_map_ends(double from, double to, bool singular_from, bool singular_to, double u, double *slope);

#endif
