/* The tables of profile.h: sampling, normalisation, areas by quadrature, and the cache that keeps them. */
#include "microfacet/profile.h"

#include "microfacet/kernels.h"
#include "microfacet/panels.h"
#include "system/status.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Cells to the octave, as powers of two: D is steep (its logarithm may fall by tens within a few octaves) and
 * cheap to sample, areas are smooth and an integral each. Measured on tabulated GGX: 2e-9 and 1e-8 of the
 * value. */
enum { DENSITY_BITS = 7, AREA_BITS = 6 };

/* ---------------------------------------------------------------------------------- areas */

/* sin phi - phi cos phi over x = 1 - cos phi is the integral of acos(1 - x): x^(3/2) times a power series
 * that converges like (x/2)^k, x <= 1. */
typedef struct lune_series {
    double term[LQ_LUNE_TERMS];
} lune_series;

static void lune_make(lune_series *lune) {
    double a = sqrt(2.0); /* acos(1 - x) = sqrt(2 x) sum (2k)! / (8^k k!^2 (2k + 1)) x^k */
    for (int k = 0; k < LQ_LUNE_TERMS; k++) {
        lune->term[k] = a / ((2 * k + 1) * (k + 1.5));
        a *= (2 * k + 1) * (2 * k + 2) / (8.0 * (k + 1) * (k + 1));
    }
}

enum { AREA_NODES = 12, AREA_NODES_MAX = (LQ_PANELS_MAX - 1) * AREA_NODES };

/* Facets of angle theta_c and more, on panels that grow away from the core. Past the first panel, whose start
 * moves with mu, nodes and densities are the same for all mu of one roughness. */
typedef struct ladder {
    lq_gauss rule;
    lq_panels panels;
    lune_series lune;
    double sine[AREA_NODES_MAX], cosine[AREA_NODES_MAX], weight[AREA_NODES_MAX]; /* weight times D sin^2 */
} ladder;

static void fill_panel(const lq_ndf *ndf, double alpha, const lq_gauss *rule, const lq_panels *panels, int p,
                       double *sine, double *cosine, double *weight) {
    double cos2[AREA_NODES], sin2[AREA_NODES], density[AREA_NODES];
    for (int i = 0; i < AREA_NODES; i++) {
        double slope;
        const double theta = lq_panels_map(panels, p, rule->node[i], &slope);
        sine[i] = sin(theta);
        cosine[i] = cos(theta);
        sin2[i] = sine[i] * sine[i];
        cos2[i] = cosine[i] * cosine[i];
        weight[i] = slope * rule->weight[i] * sin2[i];
    }
    ndf->density(ndf, alpha, AREA_NODES, cos2, sin2, density);
    for (int i = 0; i < AREA_NODES; i++) weight[i] *= density[i];
}

static void ladder_make(ladder *l, const lq_ndf *ndf, double alpha) {
    lq_gauss_make(&l->rule, AREA_NODES);
    lune_make(&l->lune);
    lq_panels_start(&l->panels, 0.0, 0.5 * pi);
    lq_panels_grade(&l->panels, 0.0, 0.5 * alpha, 2.0);
    /* Steep facets of a wide lobe: D may fall there like exp(-tan^2). */
    lq_panels_grade(&l->panels, 0.5 * pi, 0.04, 2.0);
    for (int p = 0; p + 1 < l->panels.count; p++)
        fill_panel(ndf, alpha, &l->rule, &l->panels, p, l->sine + (size_t)p * AREA_NODES,
                   l->cosine + (size_t)p * AREA_NODES, l->weight + (size_t)p * AREA_NODES);
}

static double add_facets(const ladder *l, size_t count, const double *sine, const double *cosine,
                         const double *weight, double mu, double s) {
    enum { BLOCK = 256 };
    double part[BLOCK], sum = 0.0;
    for (size_t from = 0; from < count; from += BLOCK) {
        const size_t size = count - from < BLOCK ? count - from : BLOCK;
        lq_microfacet_kernels_get()->lunes(l->lune.term, mu / s, size, sine + from, cosine + from, part);
        for (size_t i = 0; i < size; i++) sum += weight[from + i] * part[i];
    }
    return sum;
}

static double ladder_area(const ladder *l, const lq_ndf *ndf, double alpha, double mu, double s) {
    if (s == 0.0) return 0.0;
    const double from = atan2(mu, s);
    int p = 0;
    while (p + 2 < l->panels.count && l->panels.at[p + 1] <= from) p++;
    lq_panels first;
    double sine[AREA_NODES], cosine[AREA_NODES], weight[AREA_NODES];
    double sum = 0.0;
    /* Two panels in one, or the opening of the azimuth could lie just before the next. */
    const double *at = l->panels.at;
    if (p + 2 < l->panels.count) p++;
    lq_panels_start(&first, from, fmax(at[p + 1], from));
    first.singular[0] = true; /* the azimuth opens there */
    fill_panel(ndf, alpha, &l->rule, &first, 0, sine, cosine, weight);
    sum += add_facets(l, AREA_NODES, sine, cosine, weight, mu, s);
    const size_t start = (size_t)(p + 1) * AREA_NODES, end = (size_t)(l->panels.count - 1) * AREA_NODES;
    if (start < end)
        sum += add_facets(l, end - start, l->sine + start, l->cosine + start, l->weight + start, mu, s);
    return 2.0 * s * sum;
}

double lq_area_by_quadrature(const lq_ndf *ndf, double alpha, double mu, double sin_theta) {
    ladder *l = malloc(sizeof *l);
    if (!l) return NAN;
    ladder_make(l, ndf, alpha);
    const double area = ladder_area(l, ndf, alpha, mu, sin_theta);
    free(l);
    return area;
}

static void areas_free(lq_areas *a) {
    if (!a) return;
    lq_octaves_free(&a->over);
    free(a);
}

static lq_areas *areas_make(const lq_profiled *of, const lq_profile *p) {
    lq_areas *a = malloc(sizeof *a);
    ladder *l = malloc(sizeof *l);
    if (a && l && lq_octaves_make(&a->over, -ilogb(p->scale), AREA_BITS)) {
        const size_t count = 3 * a->over.cells + 1;
        double *sample = malloc(count * sizeof *sample);
        if (!of->exact_area) ladder_make(l, &of->ndf, p->alpha);
        for (size_t i = 0; sample && i < count; i++) {
            const double mu = (lq_octaves_at(&a->over, i) - p->scale) / (1.0 - p->scale), s = lq_sine(mu);
            sample[i] = of->exact_area ? of->exact_area(of, p->alpha, mu, s)
                                       : ladder_area(l, &of->ndf, p->alpha, mu, s);
        }
        if (sample) lq_octaves_fit(&a->over, sample);
        free(l);
        free(sample);
        if (sample) return a;
        areas_free(a);
        return NULL;
    }
    free(a);
    free(l);
    return NULL;
}

/* -------------------------------------------------------------------------------- profiles */

static void profile_free(lq_profile *p) {
    if (!p) return;
    areas_free(atomic_load(&p->areas));
    lq_octaves_free(&p->density);
    free(p->beyond);
    free(p);
}

/* D of `shape` at the samples of the grid; remembers where it is none. */
static void sample_shape(const lq_profiled *of, lq_profile *p, size_t count, double *d) {
    for (size_t i = 0; i < count; i++) {
        const double q = lq_octaves_at(&p->density, i), b2 = p->scale * p->scale;
        const double sin2 = fmin(fmax((q - b2) / (1.0 - b2), 0.0), 1.0);
        const double cos2 = fmin(fmax((1.0 - q) / (1.0 - b2), 0.0), 1.0);
        of->shape(of, p->alpha, 1, &cos2, &sin2, &d[i]);
        if (!(d[i] >= 0.0 && d[i] < INFINITY) && p->worst < 0.0)
            p->worst = 180.0 / pi * atan2(sqrt(sin2), sqrt(cos2));
    }
}

/* Scales the cubics to integral m_z D = 1 and adds up what lies beyond each cell. */
static void normalise(lq_profile *p) {
    lq_octaves *o = &p->density;
    const double dsin2 = pi / (1.0 - p->scale * p->scale);
    double beyond = 0.0;
    p->beyond[o->cells] = 0.0;
    for (size_t cell = o->cells; cell-- > 0;) {
        const double width = lq_octaves_start(o, cell + 1) - lq_octaves_start(o, cell);
        beyond += fmax(dsin2 * lq_octaves_integral(o, cell, width), 0.0);
        p->beyond[cell] = beyond;
    }
    p->factor = 1.0 / beyond;
    for (size_t cell = 0; cell < o->cells; cell++) {
        p->beyond[cell] *= p->factor;
        for (int k = 0; k < 4; k++) o->cubic[cell][k] *= p->factor;
    }
}

static bool tabulate_density(const lq_profiled *of, lq_profile *p) {
    const int octaves = -2 * ilogb(p->scale);
    /* A wide lobe may vanish at the horizon like exp(-1/cos) within its few octaves: finer cells. Measured on
     * sech slopes at alpha = 1: an albedo moves by 6e-6 from 7 bits to 8, by less than 1e-6 from 8 to 9. */
    const int finer = octaves == 2 ? 2 : octaves == 4 ? 1 : 0;
    if (!lq_octaves_make(&p->density, octaves, DENSITY_BITS + finer)) return false;
    const size_t count = 3 * p->density.cells + 1;
    double *sample = malloc(count * sizeof *sample);
    p->beyond = malloc((p->density.cells + 1) * sizeof *p->beyond);
    if (sample && p->beyond) {
        sample_shape(of, p, count, sample);
        lq_octaves_fit(&p->density, sample);
        normalise(p);
    }
    free(sample);
    return sample && p->beyond;
}

static lq_profile *profile_make(const lq_profiled *of, double alpha) {
    lq_profile *p = calloc(1, sizeof *p);
    if (!p) return NULL;
    p->alpha = alpha;
    p->scale = fmin(0.5, exp2(floor(log2(alpha))));
    p->factor = 1.0;
    p->worst = -1.0;
    if (!of->shape || tabulate_density(of, p)) return p;
    profile_free(p);
    return NULL;
}

/* ----------------------------------------------------------------------------------- cache */

static size_t bucket_of(double alpha) {
    uint64_t bits;
    memcpy(&bits, &alpha, sizeof bits);
    return (size_t)((bits * 0x9E3779B97F4A7C15u) >> 56) % LQ_PROFILE_BUCKETS;
}

static lq_profile *find(lq_profile *p, double alpha) {
    while (p && p->alpha != alpha) p = p->next;
    return p;
}

/* Two threads may make the same one; the first to be put in place stays. */
static lq_profile *profile_at(const lq_profiled *of, double alpha) {
    _Atomic(lq_profile *) *bucket = (_Atomic(lq_profile *) *)&of->buckets[bucket_of(alpha)];
    lq_profile *head = atomic_load_explicit(bucket, memory_order_acquire);
    lq_profile *found = find(head, alpha);
    if (found) return found;
    lq_profile *made = profile_make(of, alpha);
    while (made) {
        made->next = head;
        if (atomic_compare_exchange_strong(bucket, &head, made)) return made;
        found = find(head, alpha);
        if (!found) continue;
        profile_free(made);
        return found;
    }
    return NULL;
}

const lq_profile *lq_profiled_at(const lq_profiled *of, double alpha) {
    return profile_at(of, alpha);
}

static const lq_octaves *areas_at(const lq_ndf *ndf, double alpha) {
    const lq_profiled *of = ndf->parameters;
    lq_profile *p = profile_at(of, alpha);
    if (!p) return NULL;
    lq_areas *areas = atomic_load_explicit(&p->areas, memory_order_acquire);
    if (areas) return &areas->over;
    lq_areas *made = areas_make(of, p);
    if (!made) return NULL;
    if (atomic_compare_exchange_strong(&p->areas, &areas, made)) return &made->over;
    areas_free(made);
    return &areas->over;
}

void lq_profiled_free(lq_profiled *of) {
    for (size_t i = 0; i < LQ_PROFILE_BUCKETS; i++)
        for (lq_profile *p = atomic_load(&of->buckets[i]), *next; p; p = next) {
            next = p->next;
            profile_free(p);
        }
}

/* --------------------------------------------------------------------------------- members */

void lq_profiled_density(const lq_ndf *ndf, double alpha, size_t count, const double *cos2,
                         const double *sin2, double *d) {
    const lq_profile *p = profile_at(ndf->parameters, alpha);
    if (p) lq_microfacet_kernels_get()->octaves_density(&p->density, count, cos2, sin2, d);
    for (size_t i = 0; !p && i < count; i++) d[i] = NAN;
}

double lq_profiled_area_below(const lq_ndf *ndf, double alpha, double mu, double sin_theta) {
    (void)sin_theta;
    if (alpha == 0.0) return 0.0;
    const lq_octaves *areas = areas_at(ndf, alpha);
    return areas ? fmax(lq_octaves_value(areas, areas->floor + (1.0 - areas->floor) * mu), 0.0) : NAN;
}

void lq_profiled_areas_below(const lq_ndf *ndf, double alpha, size_t count, const double *mu, double *area) {
    const lq_octaves *areas = areas_at(ndf, alpha);
    if (areas) lq_microfacet_kernels_get()->octaves_areas(areas, count, mu, area);
    for (size_t i = 0; !areas && i < count; i++) area[i] = NAN;
}

/* Offset into a cell beyond which its cubic holds `rest`, by bisection: it rises towards the start. */
static double find_offset(const lq_profile *p, size_t cell, double rest) {
    const double dsin2 = pi / (1.0 - p->scale * p->scale);
    double low = 0.0, high = lq_octaves_start(&p->density, cell + 1) - lq_octaves_start(&p->density, cell);
    const double held = p->beyond[cell] - rest;
    for (int step = 0; step < 60; step++) {
        const double middle = 0.5 * (low + high);
        *(dsin2 * lq_octaves_integral(&p->density, cell, middle) < held ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

double lq_profiled_quantile(const lq_ndf *ndf, double alpha, double xi) {
    const lq_profile *p = profile_at(ndf->parameters, alpha);
    if (!p) return NAN;
    const double rest = 1.0 - xi, b2 = p->scale * p->scale;
    size_t low = 0, high = p->density.cells;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        *(p->beyond[middle] >= rest ? &low : &high) = middle;
    }
    const double q = lq_octaves_start(&p->density, low) + find_offset(p, low, rest);
    return sqrt(fmax(q - b2, 0.0) / fmax(1.0 - q, 1e-17));
}

lq_status lq_profiled_prepare(const lq_ndf *ndf, double alpha, lq_error *error) {
    const lq_profiled *of = ndf->parameters;
    const lq_profile *p = lq_profiled_at(of, alpha);
    if (!p || !areas_at(ndf, alpha))
        return lq_fail(error, LQ_NO_MEMORY, "no memory for the tables of NDF '%s'", ndf->id);
    if (p->worst >= 0.0)
        return lq_fail(error, LQ_BAD_INPUT,
                       "%s: D is negative or not finite at alpha = %g, theta = %.4g degrees", ndf->id, alpha,
                       p->worst);
    if (!(p->factor > 0.0 && isfinite(p->factor)))
        return lq_fail(error, LQ_BAD_INPUT, "%s: D is 0 everywhere, or too large, at alpha = %g", ndf->id,
                       alpha);
    return LQ_OK;
}
