/* facet_sums.c - moments of reflected and refracted light. */
#include "stack/facet_sums.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "microfacet/fresnel.h"
#include "system/status.h"

static size_t variants(const lq_facet_sums *f) {
    return (size_t)f->materials * LQ_MODES;
}

static double *moments_of(const lq_facet_sums *f, int part, size_t variant) {
    return f->moments + ((size_t)part * variants(f) + variant) * f->stride;
}

/* Facets of one fan that send light to one part of directions, weighed for every mode. */
typedef struct images {
    size_t count;
    const double *cosine;
    double weight[LQ_MODES][LQ_FAN_MAX];
} images;

/* Add them to a part, times a factor for each material. */
static void add(lq_facet_sums *f, lq_facet_part part, const lq_node_axis *axis, const images *i,
                const double *factor) {
    const lq_solver_kernels *kernels = lq_solver_kernels_get();
    double moment[LQ_MODES][LQ_NODES_MAX];
    double *const moments[LQ_MODES] = {moment[0], moment[1], moment[2]};
    const double *const weights[LQ_MODES] = {i->weight[0], i->weight[1], i->weight[2]};
    const size_t count = (size_t)axis->count;
    if (i->count == 0) return;
    for (size_t mode = 0; mode < LQ_MODES; mode++) memset(moment[mode], 0, count * sizeof(double));
    lq_node_axis_moments3(axis, kernels, i->count, i->cosine, weights, moments);
    for (size_t v = 0; v < variants(f); v++) {
        double *sum = moments_of(f, (int)part, v);
        for (size_t m = 0; m < count; m++) sum[m] += factor[v / LQ_MODES] * moment[v % LQ_MODES][m];
    }
}

/* Facets `from` to `to` of a fan. `sign`: reflected light leaves to the image of v, refracted light against
 * it. */
static void images_make(images *i, const lq_facet_sums *f, const lq_fan *fan, int from, int to, double sign) {
    const double along = fan->cos_image * f->sine, across = fan->sin_image * f->v_z / f->sine;
    i->count = (size_t)(to - from);
    i->cosine = fan->mirror + from;
    for (size_t k = 0; k < i->count; k++) {
        const double c = i->cosine[k], forward = sign * (across * fan->e_z[from + (int)k] - along);
        double turns[LQ_MODES];
        lq_mode_turns(forward, f->sine, (1.0 - c) * (1.0 + c), turns);
        for (int mode = 0; mode < LQ_MODES; mode++)
            i->weight[mode][k] = fan->weight[from + (int)k] * turns[mode];
    }
}

/* Divide what rises into what leaves at once, by Smith's masking of light that was reflected once, and what
 * stays. */
static void divide(const lq_facet_sums *f, images *stay, images *escape) {
    double area[LQ_FAN_MAX];
    escape->count = stay->count;
    escape->cosine = stay->cosine;
    f->ndf->areas_below(f->ndf, f->alpha, stay->count, stay->cosine, area);
    for (size_t k = 0; k < stay->count; k++) {
        const double lit = f->area * stay->cosine[k], blocked = area[k] * f->v_z, sum = lit + blocked;
        const double leaves = sum > 0.0 ? lit / sum : 1.0;
        for (int mode = 0; mode < LQ_MODES; mode++) {
            escape->weight[mode][k] = leaves * stay->weight[mode][k];
            stay->weight[mode][k] *= 1.0 - leaves;
        }
    }
}

static double weight_of(const lq_fan *fan) {
    double sum = 0.0;
    for (int i = 0; i < fan->count; i++) sum += fan->weight[i];
    return sum;
}

static void add_reflection(void *user, const lq_fan *fan) {
    lq_facet_sums *f = user;
    double factor[LQ_STACK_CHANNELS];
    if (f->eta > 0.0) factor[0] = lq_fresnel_dielectric(fan->cos_d, f->eta, NULL);
    else lq_fresnel_conductors(fan->cos_d, (size_t)f->materials, f->n, f->kappa, factor);
    f->total += weight_of(fan) * (f->eta > 0.0 ? factor[0] : 1.0);
    images rises, escapes;
    images_make(&rises, f, fan, 0, fan->up, 1.0);
    if (f->masked) divide(f, &rises, &escapes);
    add(f, LQ_PART_ESCAPES, f->leaving[0], f->masked ? &escapes : &rises, factor);
    add(f, LQ_PART_RISES, f->nodes, &rises, factor);
    images_make(&rises, f, fan, fan->up, fan->count, 1.0);
    add(f, LQ_PART_FALLS, f->nodes, &rises, factor);
}

static void add_refraction(void *user, const lq_fan *fan) {
    lq_facet_sums *f = user;
    const double passes = 1.0 - lq_fresnel_dielectric(fan->cos_d, f->eta, NULL);
    f->total += weight_of(fan) * passes;
    images i;
    images_make(&i, f, fan, 0, fan->up, -1.0);
    add(f, LQ_PART_PASSES, f->leaving[1], &i, &passes);
    add(f, LQ_PART_CROSSES, f->nodes, &i, &passes);
    images_make(&i, f, fan, fan->up, fan->count, -1.0);
    add(f, LQ_PART_CROSSES_FALLING, f->nodes, &i, &passes);
}

/* Near normal incidence turns divide by the sine; below this it stands for 0. */
static const double SINE_MIN = 1e-8;

lq_status lq_facet_sums_make(lq_facet_sums *f, lq_error *error) {
    f->stride = (size_t)f->nodes->count;
    for (int i = 0; i < 2; i++)
        if (f->leaving[i] && (size_t)f->leaving[i]->count > f->stride)
            f->stride = (size_t)f->leaving[i]->count;
    f->moments = lq_zeros(LQ_PARTS * variants(f) * f->stride);
    if (!f->moments) return lq_fail(error, LQ_NO_MEMORY, "no memory for a row of an interface");
    f->sine = fmax(lq_sine(fabs(f->v_z)), SINE_MIN);
    f->area = f->masked ? lq_area_above(f->ndf, f->alpha, f->v_z, f->sine) : 0.0;
    f->total = 0.0;
    lq_facet_view view = {f->ndf, f->alpha, 0.0, f->v_z, f->sine, f->rule, f->kinks, f->cuts[0]};
    lq_facets_visit_view(&view, add_reflection, f);
    view.eta = f->eta;
    view.cuts = f->cuts[1];
    if (f->eta > 0.0) lq_facets_visit_view(&view, add_refraction, f);
    return LQ_OK;
}

void lq_facet_sums_free(lq_facet_sums *f) {
    free(f->moments);
    f->moments = NULL;
}

void lq_facet_sums_project(const lq_facet_sums *f, int part, size_t variant, double *weights) {
    const lq_node_axis *axis = part == LQ_PART_ESCAPES  ? f->leaving[0]
                               : part == LQ_PART_PASSES ? f->leaving[1]
                                                        : f->nodes;
    const double scale = lq_inverse_area(f->total);
    lq_node_axis_project(axis, moments_of(f, part, variant), weights);
    for (int j = 0; j < axis->count; j++) weights[j] *= scale;
}
