/* media.c - cuts of cosine axes. */
#include "stack/media.h"

#include <math.h>
#include <string.h>

#include "microfacet/fresnel.h"
#include "precompute/first_bounce.h"

/* Steps of more than this are as wide as the nodes are apart anyway. */
static const double CUT_ALPHA = 0.5;

/* Of less than this, a step is narrower than what others integrate it with. */
static const double SHARP_ALPHA = 0.25;

/* Of less than this, nodes resolve it from below only if they are dense there. */
static const double STEP_ALPHA = 0.15;

/* Cuts closer than this to each other or to an end of the axis are one. */
static const double CUTS_APART = 1e-6;

/* Put a cut in its place; the narrowest step counts. */
static void add_cut(lq_plan_axis *axis, double cosine, double width) {
    int i = 0;
    if (!(cosine > CUTS_APART && cosine < 1.0 - CUTS_APART)) return;
    while (i < axis->cut_count && axis->cut[i] < cosine - CUTS_APART) i++;
    if (i < axis->cut_count && axis->cut[i] < cosine + CUTS_APART) {
        axis->width[i] = fmin(axis->width[i], width);
        return;
    }
    if (axis->cut_count + 1 == LQ_ELEMENTS_MAX) return;
    for (int k = axis->cut_count++; k > i; k--) {
        axis->cut[k] = axis->cut[k - 1];
        axis->width[k] = axis->width[k - 1];
    }
    axis->cut[i] = cosine;
    axis->width[i] = width;
}

static void add_medium(lq_plan_axis *axis, double n, double width) {
    if (n < axis->n) add_cut(axis, sqrt((1.0 - n / axis->n) * (1.0 + n / axis->n)), width);
}

/* A conductor whose index is below that of the medium turns reflective at an angle too, the more sharply the
 * less it absorbs. */
static void add_conductor(lq_plan_axis *axis, const lq_media *media, double width) {
    lq_fresnel_singularity found[2];
    const double scale = media->n[media->count - 1] / axis->n;
    if (media->base_n < 0.0 || media->base_n * scale >= 1.0) return;
    lq_fresnel_singularities(media->base_n * scale, media->base_kappa * scale, found);
    if (found[0].distance < 0.15) add_cut(axis, cos(found[0].angle), width);
}

/* From this cosine on, what rises to a rough interface beside the medium meets no facet beyond its critical
 * angle. Facets that stand on edge, alpha^2 of all, make a kink of that. */
static void add_cone(lq_plan_axis *axis, double n, double width) {
    if (n < 0.9 * axis->n) add_cut(axis, n / axis->n, width);
}

/* What medium i sees through interfaces up to CUT_ALPHA. */
static void look(lq_plan_axis *axis, const lq_media *media, size_t i) {
    double width = 0.0;
    for (size_t above = i; above > 0; above--) {
        width = fmax(width, media->alpha[above - 1]);
        if (width > CUT_ALPHA && above == i) add_cone(axis, media->n[above - 1], width);
        if (width > CUT_ALPHA) break;
        add_medium(axis, media->n[above - 1], width);
    }
    width = 0.0;
    for (size_t below = i; below < media->count; below++) {
        width = fmax(width, media->alpha[below]);
        const bool divides = below + 1 < media->count;
        if (width > CUT_ALPHA && below == i && divides) add_cone(axis, media->n[below + 1], width);
        if (width > CUT_ALPHA) break;
        if (divides) add_medium(axis, media->n[below + 1], width);
        else add_conductor(axis, media, width);
    }
}

lq_plan_axis lq_media_axis(const lq_media *media, double n) {
    lq_plan_axis axis;
    memset(&axis, 0, sizeof axis); /* compared as bytes */
    axis.n = n;
    for (size_t i = 0; i < media->count; i++)
        if (media->n[i] == n) look(&axis, media, i);
    for (int c = 0; c < axis.cut_count; c++) {
        axis.stepped[c] = axis.width[c] > LQ_SMOOTH_ALPHA && axis.width[c] < STEP_ALPHA;
        if (axis.width[c] < SHARP_ALPHA && axis.sharp.count < LQ_FACET_CUTS_MAX)
            axis.sharp.cosine[axis.sharp.count++] = axis.cut[c];
        axis.width[c] = 0.0; /* of no more use: stacks that differ in it share their axes */
    }
    return axis;
}
