/* The lobe of a rough mirror over the angle of the reflected ray: what total internal reflection asks about.
 *
 * Light at angle theta_i falls on a mirror (F = 1) with separable masking. Of the reflected direction only
 * its angle theta matters, so the azimuth is integrated once:
 *
 *     p(theta) = sin theta / (1 + Lambda(theta)) * integral over azimuth of D(h)/4
 *
 * with h halfway between both rays, because (v.m) D(m) dm = D(h)/4 domega. Unlike the facets around v,
 * directions around z have no edge: every h is visible and upright, and a critical angle is one value of
 * theta. p is kept as Chebyshev series on panels that grow away from the peak and from the horizon; its
 * integral is then a series too.
 */
#ifndef LACQUER_PRECOMPUTE_ANGLE_LOBE_H
#define LACQUER_PRECOMPUTE_ANGLE_LOBE_H

#include "microfacet/gauss.h"
#include "microfacet/ndf.h"

enum { LQ_ANGLE_LOBE_PANELS = 96, LQ_ANGLE_LOBE_TERMS = 48 };

/* How finely: the series per panel and the azimuth, both to be refined together. */
typedef struct lq_angle_lobe_rule {
    int terms;
    lq_gauss ring;                                            /* nodes per piece of azimuth */
    double node[LQ_ANGLE_LOBE_TERMS];                         /* Chebyshev, on [-1,1] */
    double cosine[LQ_ANGLE_LOBE_TERMS * LQ_ANGLE_LOBE_TERMS]; /* of term k at node j, [k * terms + j] */
} lq_angle_lobe_rule;

typedef struct lq_angle_lobe {
    int panels, terms;
    double at[LQ_ANGLE_LOBE_PANELS + 1];                       /* break points in theta, from 0 to pi/2 */
    double below[LQ_ANGLE_LOBE_PANELS + 1];                    /* integral of p from 0 to each */
    double density[LQ_ANGLE_LOBE_PANELS][LQ_ANGLE_LOBE_TERMS]; /* series of p on each panel */
    double integral[LQ_ANGLE_LOBE_PANELS]
                   [LQ_ANGLE_LOBE_TERMS + 1]; /* series of its integral from the panel's start */
} lq_angle_lobe;

/* 2 <= terms <= LQ_ANGLE_LOBE_TERMS, ring_nodes up to LQ_GAUSS_MAX. */
void lq_angle_lobe_rule_make(lq_angle_lobe_rule *rule, int terms, int ring_nodes);

/* mu in [0,1], alpha in (0,1]. Not normalised: the total is sigma E, E the separable albedo. */
void lq_angle_lobe_make(lq_angle_lobe *lobe, const lq_ndf *ndf, double alpha, double mu,
                        const lq_angle_lobe_rule *rule);

/* The panel that holds theta, searched upwards from panel `from`. */
int lq_angle_lobe_panel(const lq_angle_lobe *lobe, double theta, int from);
/* p, theta on the given panel. */
double lq_angle_lobe_density(const lq_angle_lobe *lobe, int panel, double theta);
/* Energy below theta, and in all. */
double lq_angle_lobe_below(const lq_angle_lobe *lobe, double theta);
double lq_angle_lobe_total(const lq_angle_lobe *lobe);

#endif
