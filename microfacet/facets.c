/* Facet quadrature: panels of d around v, pieces of azimuth inside each. */
#include "microfacet/facets.h"

#include "microfacet/kernels.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* What stays fixed while one direction is integrated. */
typedef struct view {
    const lq_ndf *ndf;
    double alpha;
    double eta;               /* of the refraction; 0: reflection */
    double v_z, sin_v, theta; /* the direction and its angle to the z axis, in [0, pi] */
    const lq_gauss *inner, *part;
    const lq_facet_cuts *cuts; /* may be NULL */
    const lq_microfacet_kernels *kernels;
} view;

/* One piece of azimuth, in half-angles h = chi/2 of the mapped azimuth. */
typedef struct piece {
    double from, to;
    bool singular_from, singular_to;
} piece;

/* The angle d at which refraction turns light by |d - t| = |pi/2 - theta|, that is, along the horizon from an
 * extreme facet: from sin(d - turn) = sin d / eta. Negative where there is none. */
static double refracted_horizon(const view *w) {
    const double side = w->sin_v - 1.0 / w->eta, along = w->eta > 1.0 ? side : -side;
    return along > 0.0 ? atan2(fabs(w->v_z), along) : -1.0;
}

/* Where the azimuth range of a fan opens or closes: d at which the extreme facets (psi = 0 or pi) are
 * upright (m_z = 0) or send light along the horizon. The integrand has a square root there. */
static void add_horizon_crossings(lq_panels *panels, const view *w) {
    lq_panels_add(panels, 0.5 * pi - w->theta, true); /* m_z = 0 at psi = pi */
    if (w->eta > 0.0) {
        lq_panels_add(panels, refracted_horizon(w), true);
        return;
    }
    lq_panels_add(panels, 0.5 * (0.5 * pi - w->theta), true); /* psi = pi */
    lq_panels_add(panels, 0.5 * (0.5 * pi + w->theta), true); /* psi = 0 */
}

/* The angle d at which refraction turns light by `turn`: sin(d - turn) = sin d / eta. Negative where there is
 * none. */
static double refracted_turn(const view *w, double turn) {
    const double side = cos(turn) - 1.0 / w->eta, across = sin(turn);
    const bool turns = w->eta > 1.0 ? across > 0.0 && side > 0.0 : across < 0.0 && side < 0.0;
    return turns ? atan2(fabs(across), fabs(side)) : -1.0;
}

/* Where the extreme facets send light to a cosine at which its worth is cut: an azimuth begins or ends to
 * divide. */
static void add_cuts(lq_panels *panels, const view *w) {
    for (int i = 0; w->cuts && i < w->cuts->count; i++) {
        const double angle = acos(w->cuts->cosine[i]);
        const double turns[3] = {w->theta - angle, w->theta + angle, angle - w->theta};
        for (int t = 0; t < 3; t++)
            lq_panels_add(panels, w->eta > 0.0 ? refracted_turn(w, turns[t]) : 0.5 * turns[t], false);
    }
}

/* The same of light that is reflected back. Rising light never is. */
static void add_back_cuts(lq_panels *panels, const view *w) {
    if (!w->cuts || w->eta > 0.0 || w->v_z < 0.0) return;
    for (int i = 0; i < w->cuts->back_count; i++) {
        const double angle = acos(-w->cuts->back[i]);
        const double turns[3] = {angle + w->theta, angle - w->theta, 2.0 * pi - angle - w->theta};
        for (int t = 0; t < 3; t++) lq_panels_add(panels, 0.5 * turns[t], false);
    }
}

/* Masking changes over reflected cosines of the size of the incident one: at grazing incidence that is a
 * thin layer of facets around those that reflect along the horizon. */
static void grade_grazing(lq_panels *panels, double theta) {
    const double elevation = 0.5 * pi - theta;
    if (elevation > 0.0) lq_panels_grade(panels, 0.5 * (0.5 * pi + theta), fmax(elevation, 1e-9), 5.0);
}

static void add_extra(lq_panels *panels, const lq_panels *extra, bool singular) {
    for (int i = 0; extra && i < extra->count; i++)
        if (extra->singular[i] == singular) lq_panels_add(panels, extra->at[i], singular);
}

/* False where no facet sends light on. */
static bool make_panels(const view *w, const lq_panels *extra, lq_panels *panels) {
    const bool critical = w->eta > 0.0 && w->eta < 1.0;
    const double from = fmax(w->theta - 0.5 * pi, 0.0), to = critical ? asin(w->eta) : 0.5 * pi;
    if (from >= to) return false;
    lq_panels_start(panels, from, to);
    panels->singular[0] = from > 0.0; /* the range of azimuth opens like a square root */
    panels->singular[1] = critical;   /* so does the angle of refraction */
    add_horizon_crossings(panels, w);
    add_extra(panels, extra, true);
    lq_panels_grade(panels, w->theta, w->alpha, 4.0);
    grade_grazing(panels, w->theta);
    add_extra(panels, extra, false);
    add_cuts(panels, w);
    add_back_cuts(panels, w);
    lq_panels_separate(panels);
    return true;
}

/* chi/2 of the azimuth with cos psi = `cos_psi`, clamped to [0, pi/2]. */
static double half_chi(double cos_psi, double lambda) {
    if (cos_psi >= 1.0) return 0.0;
    if (cos_psi <= -1.0) return 0.5 * pi;
    return atan2(sqrt(1.0 - cos_psi), lambda * sqrt(1.0 + cos_psi));
}

/* cos psi where cos b v_z + sin b sin_v cos psi = 0. Past +-1 there is none: then it tells, as 2 or -2,
 * whether the near side of the split (psi = 0) is empty or everything, the near side being the upper one for
 * sin b >= 0. */
static double crossing(double cos_b, double sin_b, const view *w) {
    const double level = -cos_b * w->v_z, reach = sin_b * w->sin_v;
    if (reach != 0.0) return level / reach;
    return (level < 0.0) == (sin_b >= 0.0) ? -2.0 : 2.0;
}

/* Half-angles, ascending, at which a piece of rising light is divided: where it passes a cut. */
static int divisions(const view *w, const piece *p, double cos_b, double sin_b, double lambda, double *at) {
    const double reach = sin_b * w->sin_v;
    int count = 0;
    for (int i = 0; w->cuts && i < w->cuts->count && reach != 0.0; i++) {
        /* Light falls as the azimuth grows where it is turned upwards: the highest cosine comes first then.
         */
        const double cosine = w->cuts->cosine[reach > 0.0 ? w->cuts->count - 1 - i : i];
        const double h = half_chi((cosine - cos_b * w->v_z) / reach, lambda);
        if (h > p->from && h < p->to) at[count++] = h;
    }
    return count;
}

/* Cubic map towards a singular end: the reflected cosine vanishes there, linearly, and what is integrated
 * (masking, interpolation in a root of the cosine) changes over cosines as small as the incident one.
 * Measured on E(mu, alpha): 10 x smaller errors than with the quadratic map at the same nodes. */
static int piece_nodes(const piece *p, const lq_gauss *rule, double *h, double *dh) {
    const double width = p->to - p->from;
    if (!(width > 0.0)) return 0;
    for (int i = 0; i < rule->count; i++) {
        const double u = rule->node[i], w = rule->weight[i] * width;
        const double to_end = 1.0 - u;
        if (p->singular_from) {
            h[i] = p->from + width * u * u * u;
            dh[i] = 3.0 * u * u * w;
        } else if (p->singular_to) {
            h[i] = p->to - width * to_end * to_end * to_end;
            dh[i] = 3.0 * to_end * to_end * w;
        } else {
            h[i] = p->from + width * u;
            dh[i] = w;
        }
    }
    return rule->count;
}

/* Quadratic map towards the end of a part where light leaves along a cut, from above: there its worth has a
 * root. */
static int part_nodes(double from, double to, bool root_from, const lq_gauss *rule, double *h, double *dh) {
    const double width = to - from;
    for (int i = 0; i < rule->count; i++) {
        const double u = rule->node[i], w = rule->weight[i] * width, to_end = 1.0 - u;
        h[i] = root_from ? from + width * u * u : to - width * to_end * to_end;
        dh[i] = 2.0 * (root_from ? u : to_end) * w;
    }
    return rule->count;
}

/* The parts of a divided piece, as many of them as there is room for; the lowest cosines lie at its end or,
 * where `ascends`, at its start. */
static int divided_nodes(const view *w, const piece *p, const double *at, int count, bool ascends, double *h,
                         double *dh) {
    int nodes = 0;
    double from = p->from;
    for (int i = 0; i <= count; i++) {
        const bool last = i == count || nodes + 2 * w->part->count > LQ_FAN_MAX - w->inner->count;
        const double to = last ? p->to : at[i];
        const piece part = {from, to, p->singular_from && i == 0, p->singular_to && last};
        const bool at_cut = ascends ? i > 0 : !last;
        nodes += at_cut ? part_nodes(from, to, ascends, w->part, h + nodes, dh + nodes)
                        : piece_nodes(&part, w->part, h + nodes, dh + nodes);
        if (last) break;
        from = to;
    }
    return nodes;
}

/* Cosine and sine of the angle between v and the image direction: 2d, or d - t. Refracted light goes to
 * -(cos(d - t) v + sin(d - t) e), which in the other medium, its z axis turned over, is the mirror's form
 * again. sin(d - t) comes from eta cos t - cos d = (eta^2 - 1) / (eta cos t + cos d), which does not cancel
 * at eta -> 1. */
static void image_angle(const view *w, const lq_fan *fan, double *cosine, double *sine) {
    const double c = fan->cos_d, s = fan->sin_d;
    if (w->eta == 0.0) {
        *cosine = (c - s) * (c + s);
        *sine = 2.0 * s * c;
        return;
    }
    const double gap = (w->eta - 1.0) * (w->eta + 1.0);
    const double eta_cos_t = sqrt(fmax(gap + c * c, 0.0));
    *cosine = (c * eta_cos_t + s * s) / w->eta;
    *sine = s * gap / (w->eta * (eta_cos_t + c));
}

static void fan_make(const view *w, double d, double weight, lq_fan *fan) {
    fan->d = d;
    fan->cos_d = cos(d);
    fan->sin_d = sin(d);
    double cos_image, sin_image;
    image_angle(w, fan, &cos_image, &sin_image);
    fan->cos_image = cos_image;
    fan->sin_image = sin_image;

    /* GGX has 1/(1 - k^2 m_z^2)^2, k^2 = 1 - alpha^2; lambda flattens the nearer pole, m_z = 1/k. */
    const double a2 = w->alpha * w->alpha, k = sqrt(fmax(1.0 - a2, 0.0)), gap = a2 / (1.0 + k);
    const double near = sin(0.5 * (d - w->theta)), far = sin(0.5 * (d + w->theta));
    lq_fan_constants c;
    c.lambda2 = (gap + 2.0 * k * near * near) / (gap + 2.0 * k * far * far);
    c.lambda = sqrt(c.lambda2);
    c.tilt0 = 2.0 * near * near;
    c.tilt1 = 2.0 * fan->sin_d * w->sin_v;
    c.mirror0 = cos_image * w->v_z;
    c.mirror1 = sin_image;
    c.sin_v = w->sin_v;

    /* The image rises above the horizon on the near side of the split, or on the far side if it turns the
     * other way (light that enters a rarer medium). */
    const bool near_up = sin_image >= 0.0;
    const double horizon = half_chi(crossing(cos_image, sin_image, w), c.lambda);
    const double upright = half_chi(crossing(fan->cos_d, fan->sin_d, w), c.lambda);
    const piece nearer = {0.0, fmin(horizon, upright), false, horizon <= upright};
    const piece farther = {horizon, upright, true, false};
    const piece *above = near_up ? &nearer : &farther, *below = near_up ? &farther : &nearer;

    double h[LQ_FAN_MAX], cos2[LQ_FAN_MAX], sin2[LQ_FAN_MAX], density[LQ_FAN_MAX], at[LQ_FACET_CUTS_MAX];
    const int divided = divisions(w, above, cos_image, sin_image, c.lambda, at);
    fan->up = divided ? divided_nodes(w, above, at, divided, sin_image < 0.0, h, fan->weight)
                      : piece_nodes(above, w->inner, h, fan->weight);
    fan->count = fan->up + piece_nodes(below, w->inner, h + fan->up, fan->weight + fan->up);
    w->kernels->place_facets(&c, (size_t)fan->count, h, fan->weight, fan->mirror, fan->e_z, cos2, sin2);
    w->ndf->density(w->ndf, w->alpha, (size_t)fan->count, cos2, sin2, density);
    /* Twice: both signs of the azimuth. */
    const double scale = 2.0 * weight * fan->cos_d * fan->sin_d;
    for (int i = 0; i < fan->count; i++) fan->weight[i] *= scale * density[i];
}

void lq_facet_rule_make(lq_facet_rule *rule, int outer, int inner) {
    lq_gauss_make(&rule->outer, outer);
    lq_gauss_make(&rule->inner, inner);
    lq_gauss_make(&rule->part, 4 + inner / 2);
}

static void visit_all(const view *w, const lq_gauss *outer, const lq_panels *extra, lq_fan_visitor *visit,
                      void *user) {
    lq_panels panels;
    if (!make_panels(w, extra, &panels)) return;
    lq_fan fan;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int i = 0; i < outer->count; i++) {
            double slope;
            const double d = lq_panels_map(&panels, p, outer->node[i], &slope);
            fan_make(w, d, outer->weight[i] * slope, &fan);
            visit(user, &fan);
        }
}

void lq_facets_visit(const lq_ndf *ndf, double alpha, double v_z, double sin_v, const lq_facet_rule *rule,
                     const lq_panels *extra, lq_fan_visitor *visit, void *user) {
    lq_facets_visit_refracted(ndf, alpha, 0.0, v_z, sin_v, rule, extra, visit, user);
}

void lq_facets_visit_refracted(const lq_ndf *ndf, double alpha, double eta, double v_z, double sin_v,
                               const lq_facet_rule *rule, const lq_panels *extra, lq_fan_visitor *visit,
                               void *user) {
    const lq_facet_view v = {ndf, alpha, eta, v_z, sin_v, rule, extra, NULL};
    lq_facets_visit_view(&v, visit, user);
}

void lq_facets_visit_view(const lq_facet_view *v, lq_fan_visitor *visit, void *user) {
    const view w = {.ndf = v->ndf,
                    .alpha = v->alpha,
                    .eta = v->eta,
                    .v_z = v->v_z,
                    .sin_v = v->sin_v,
                    .theta = atan2(v->sin_v, v->v_z),
                    .inner = &v->rule->inner,
                    .part = &v->rule->part,
                    .cuts = v->cuts,
                    .kernels = lq_microfacet_kernels_get()};
    visit_all(&w, &v->rule->outer, v->extra, visit, user);
}
