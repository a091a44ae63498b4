/* Levels of resolution of one roughness. */
#include "precompute/rough_level.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef lq_resolution resolution;

/* No two levels share a resolution that could be what limits both. */
static const resolution regular[LQ_DIELECTRIC_LEVELS] = {{12, 12, 8, 8},   {20, 16, 10, 12}, {24, 20, 12, 16},
                                                         {32, 24, 16, 20}, {48, 28, 20, 28}, {64, 32, 28, 36},
                                                         {96, 40, 40, 48}};

/* Nearly matched media: the energy steps over ever fewer of the critical cosines, and what a facet does to a
 * direction is multiplied by all the facets that are met. */
static const resolution matched[LQ_DIELECTRIC_LEVELS] = {
    {24, 16, 12, 12}, {32, 24, 16, 16}, {40, 36, 24, 20}, {48, 44, 32, 24},
    {64, 52, 40, 28}, {80, 60, 52, 32}, {104, 68, 60, 40}};

/* Leaving nodes for energy alone, and for any reward. */
static const int leaving_nodes[LQ_DIELECTRIC_LEVELS][2] = {{16, 20}, {18, 24}, {20, 28}, {24, 36},
                                                           {32, 40}, {48, 48}, {64, 64}};

void lq_rough_level_free(lq_rough_level *r) {
    if (!r) return;
    lq_node_axis_free(&r->axis);
    for (int i = 0; i < 2; i++) lq_node_axis_free(&r->leaving[i].axis);
    free(r->travel_down);
    free(r->travel_up);
    free(r->survival);
    free(r->refracted_hits);
    free(r);
}

static void fill_travel(lq_rough_level *r) {
    const size_t depths = (size_t)r->depths.count, n = (size_t)r->axis.count;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < depths; k++) {
            const size_t at = (i * depths + k) * depths;
            lq_travel_down(&r->depths, r->lambda[i], (int)k, r->travel_down + at);
            lq_travel_up(&r->depths, r->lambda[i], (int)k, r->travel_up + at);
            r->survival[k * n + i] = lq_survival(r->lambda[i], r->depths.u[k]);
        }
}

/* Arrivals that are solved; between them hits are interpolated. */
enum { ARRIVALS = 16 };

static double arrival_angle(int i) {
    return 3.14159265358979323846 * i / (ARRIVALS - 1);
}

static double arrival_theta(const lq_rough_level *r, int i) {
    return 0.5 * (1.0 + r->theta_from) + 0.5 * (1.0 - r->theta_from) * cos(arrival_angle(i));
}

static void fill_refracted(lq_rough_level *r) {
    const int depths = r->depths.count, n = r->axis.count;
    double hits[LQ_DEPTHS_MAX];
    for (int a = 0; a < ARRIVALS; a++) {
        const double lambda = fmax(pow(arrival_theta(r, a), -8.0) - 1.0, 0.0);
        for (int j = 0; j < n; j++) {
            lq_refracted_hits(&r->depths, lambda, r->lambda[j], hits);
            for (int k = 0; k < depths; k++) r->refracted_hits[(a * depths + k) * n + j] = hits[k];
        }
    }
}

void lq_rough_level_refracted(const lq_rough_level *r, double lambda, double *hits) {
    const size_t size = (size_t)(r->depths.count * r->axis.count);
    const double theta = pow(1.0 + lambda, -0.125);
    double weight[ARRIVALS], sum = 0.0;
    for (int a = 0; a < ARRIVALS; a++) {
        const double gap = theta - arrival_theta(r, a), end = a == 0 || a == ARRIVALS - 1 ? 0.5 : 1.0;
        if (fabs(gap) < 1e-14) {
            memcpy(hits, r->refracted_hits + (size_t)a * size, size * sizeof *hits);
            return;
        }
        weight[a] = (a % 2 ? -end : end) / gap;
        sum += weight[a];
    }
    memset(hits, 0, size * sizeof *hits);
    for (int a = 0; a < ARRIVALS; a++) {
        const double share = weight[a] / sum, *at = r->refracted_hits + (size_t)a * size;
        for (size_t i = 0; i < size; i++) hits[i] += share * at[i];
    }
}

/* From this band on light crosses a dozen facets almost undeviated, from the other on a hundred. */
enum { NEARLY_MATCHED = 4, MATCHED = 7 };

static bool leaving_make(lq_leaving *l, const lq_ndf *ndf, double alpha, int count) {
    if (!lq_node_axis_make(&l->axis, alpha, LQ_RISING, count, 0.0)) return false;
    for (int i = 0; i < count; i++) l->lambda[i] = lq_lambda(ndf, alpha, l->axis.mu[i]);
    return true;
}

/* `scale`: the cosine below which the nodes are dense. */
static lq_rough_level *level_make(const lq_ndf *ndf, double alpha, double scale, const resolution *l,
                                  const lq_level_splits *splits, bool refracts) {
    const size_t n = (size_t)(l->nodes * (splits->count + 1)), d = (size_t)l->depths;
    lq_rough_level *r = calloc(1, sizeof *r);
    if (!r) return NULL;
    lq_depths_make(&r->depths, l->depths);
    lq_facet_rule_make(&r->rule, l->outer, l->inner);
    /* Rows are read to the end of a vector. */
    r->travel_down = lq_zeros(n * d * d + LQ_LANES);
    r->travel_up = lq_zeros(n * d * d + LQ_LANES);
    r->survival = lq_zeros(n * d);
    r->refracted_hits = lq_zeros(ARRIVALS * d * n);
    const bool axis =
        lq_node_axis_make_divided(&r->axis, scale, LQ_RISING, splits->at, splits->count, l->nodes);
    if (!axis || !r->travel_down || !r->travel_up || !r->survival || !r->refracted_hits) {
        lq_rough_level_free(r);
        return NULL;
    }
    for (int i = 0; i < r->axis.count; i++) r->lambda[i] = lq_lambda(ndf, alpha, r->axis.mu[i]);
    r->theta_from = pow(1.0 + lq_lambda(ndf, alpha, LQ_GRAZING), -0.125);
    fill_travel(r);
    if (refracts) fill_refracted(r);
    return r;
}

/* The axes of nearly matched media are divided at the critical cosine, where energies step. */
static lq_rough_level *level_with_leaving(const lq_ndf *ndf, double alpha, int level, int band,
                                          double divided_at) {
    const bool divides = divided_at > 0.0;
    const lq_level_splits splits = {.count = divides, .at = {divided_at}};
    resolution l = band >= NEARLY_MATCHED ? matched[level] : regular[level];
    l.nodes /= splits.count + 1;
    lq_rough_level *r = level_make(ndf, alpha, ldexp(alpha, -band), &l, &splits, true);
    if (r && leaving_make(&r->leaving[0], ndf, alpha, leaving_nodes[level][0]) &&
        leaving_make(&r->leaving[1], ndf, alpha, leaving_nodes[level][1])) {
        r->divided_at = divided_at;
        return r;
    }
    lq_rough_level_free(r);
    return NULL;
}

lq_rough lq_rough_start(const lq_ndf *ndf, double alpha) {
    return (lq_rough){.ndf = ndf, .alpha = alpha};
}

void lq_rough_free(lq_rough *rough) {
    for (int band = 0; band < LQ_DIELECTRIC_BANDS; band++)
        for (int l = 0; l < LQ_DIELECTRIC_LEVELS; l++) lq_rough_level_free(rough->levels[band][l]);
}

/* How many facets, within a factor, light at the critical cosine meets on its way across. */
static double facets_met(double alpha, double eta) {
    return alpha / sqrt(2.0 * fabs(eta - 1.0));
}

/* Energies change over cosines of alpha and, where the media hardly differ, of the critical cosine, to which
 * the nodes are then scaled: they are dense below alpha / 2^band. Band 0 has none of it. */
static int band_of(double alpha, double eta) {
    const double met = facets_met(alpha, eta);
    if (met < 1.0 / 0.35) return 0;
    const long band = lround(log2(met));
    return band < LQ_DIELECTRIC_BANDS ? (int)band : LQ_DIELECTRIC_BANDS - 1;
}

bool lq_dielectric_is_matched(const lq_rough *rough, double eta) {
    return !lq_dielectric_is_closed(rough, eta) && band_of(rough->alpha, eta) >= MATCHED;
}

bool lq_dielectric_is_nearly_matched(const lq_rough *rough, double eta) {
    return !lq_dielectric_is_closed(rough, eta) && band_of(rough->alpha, eta) >= NEARLY_MATCHED;
}

lq_similar lq_dielectric_similar(const lq_rough *rough, double eta) {
    const double met = facets_met(rough->alpha, eta), critical = rough->alpha / LQ_SIMILAR_FACETS;
    if (lq_dielectric_is_closed(rough, eta) || met <= LQ_SIMILAR_FACETS) return (lq_similar){.eta = 0.0};
    const bool denser = eta < 1.0;
    return (lq_similar){.eta = 1.0 + (denser ? -0.5 : 0.5) * critical * critical,
                        .denser = denser,
                        .facets = met,
                        .critical = rough->alpha / met};
}

double lq_dielectric_regular_from(const lq_rough *rough) {
    return lq_dielectric_is_closed(rough, 2.0) ? INFINITY
                                               : 1.0 + fmax(1e-4, 0.0011 * rough->alpha * rough->alpha);
}

const lq_rough_level *lq_rough_level_get(lq_rough *rough, double eta, int level) {
    const int band = band_of(rough->alpha, eta);
    const double divided_at = band >= NEARLY_MATCHED ? sqrt(2.0 * fabs(eta - 1.0)) : 0.0;
    lq_rough_level **r = &rough->levels[band][level];
    if (*r && (*r)->divided_at != divided_at) {
        lq_rough_level_free(*r);
        *r = NULL;
    }
    if (!*r) *r = level_with_leaving(rough->ndf, rough->alpha, level, band, divided_at);
    return *r;
}

lq_rough_level *lq_rough_level_make(const lq_ndf *ndf, double alpha, double eta, const lq_resolution *l,
                                    const lq_level_splits *splits) {
    return level_make(ndf, alpha, ldexp(alpha, eta > 0.0 ? -band_of(alpha, eta) : 0), l, splits, eta > 0.0);
}
