/* Quadrature over the facets that a direction sees.
 *
 * The direction v is the one the light comes FROM (v = -omega): above the horizon for a ray that goes down,
 * below it for one that goes up. Facets are counted in polar coordinates around v,
 *     m = cos d v + sin d e(psi),     dm = sin d dd dpsi,
 * because everything Fresnel depends on d alone: a critical angle is one break point of the outer
 * integral, exact, and one inner integral serves every material. Reflection keeps the azimuth,
 *     omega_r = cos 2d v + sin 2d e(psi),
 * and refraction too, with the angle d - t in place of 2d and a minus sign in front.
 *
 * Two choices make it converge geometrically for any roughness (docs/theory.md, "Facet quadrature"):
 *  - the azimuth is integrated in chi, tan(psi/2) = lambda tan(chi/2), lambda chosen so that the pole of
 *    GGX becomes constant: a narrow lobe is as cheap as a wide one;
 *  - the panels of d grow geometrically away from the peak d = theta.
 */
#ifndef LACQUER_MICROFACET_FACETS_H
#define LACQUER_MICROFACET_FACETS_H

#include "microfacet/ndf.h"
#include "microfacet/panels.h"

#include <stddef.h>

enum { LQ_FAN_MAX = 256, LQ_FACET_CUTS_MAX = 12 };

/* The facets at one angle d from v, above and below the split of the azimuth. */
typedef struct lq_fan {
    double d, cos_d, sin_d;
    double cos_image, sin_image; /* of the angle between v and the image: 2d, or d - t */
    int up;                      /* facets [0, up) send light away from the surface, ... */
    int count;                   /* ... facets [up, count) back towards it */
    /* Of each facet: |cosine| of the direction it sends light to, z component of e(psi), and its weight
     * (v.m) D(m) dm, not normalised. The cosines of each of the two parts run monotonically. */
    _Alignas(64) double mirror[LQ_FAN_MAX];
    _Alignas(64) double e_z[LQ_FAN_MAX];
    _Alignas(64) double weight[LQ_FAN_MAX];
} lq_fan;

typedef void lq_fan_visitor(void *user, const lq_fan *fan);

typedef struct lq_facet_rule {
    lq_gauss outer; /* nodes per panel of d */
    lq_gauss inner; /* nodes per piece of azimuth: two pieces at most, up to LQ_FAN_MAX / 4 each */
    lq_gauss part;  /* nodes per part of a piece that cosines divide (lq_facet_cuts) */
} lq_facet_rule;

/* Cosines, ascending, at which what light is worth that leaves the surface is not smooth: azimuth and d are
 * divided where facets send light there. For light that goes back towards the surface, d alone is: azimuth
 * smooths kinks that are weak. */
typedef struct lq_facet_cuts {
    int count, back_count;
    double cosine[LQ_FACET_CUTS_MAX], back[LQ_FACET_CUTS_MAX];
} lq_facet_cuts;

void lq_facet_rule_make(lq_facet_rule *rule, int outer, int inner);

/* Visit every fan seen from v at height v_z in [-1,1] (v_z = 0 counts as above), sin_v = sqrt(1 - v_z^2),
 * alpha in (0,1]. `extra` (may be NULL) holds further break points in d on [0, pi/2]: those of the Fresnel
 * curves. The sum of all weights is sigma(v) to the accuracy of the rule. */
void lq_facets_visit(const lq_ndf *ndf, double alpha, double v_z, double sin_v, const lq_facet_rule *rule,
                     const lq_panels *extra, lq_fan_visitor *visit, void *user);

/* The same for light that the facets refract into a medium of index eta (relative, not 1): fans past the
 * critical angle are left out, and "away from the surface" is meant in the other medium, whose cosines
 * `mirror` holds. */
void lq_facets_visit_refracted(const lq_ndf *ndf, double alpha, double eta, double v_z, double sin_v,
                               const lq_facet_rule *rule, const lq_panels *extra, lq_fan_visitor *visit,
                               void *user);

/* Both, with cosines that divide the integral; eta = 0: reflection. `cuts` may be NULL. */
typedef struct lq_facet_view {
    const lq_ndf *ndf;
    double alpha, eta;
    double v_z, sin_v;
    const lq_facet_rule *rule;
    const lq_panels *extra;
    const lq_facet_cuts *cuts;
} lq_facet_view;

void lq_facets_visit_view(const lq_facet_view *view, lq_fan_visitor *visit, void *user);

#endif
