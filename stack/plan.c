/* plan.c - which surfaces, axes and NDFs a stack has, each once. */
#include "stack/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stack/description.h"
#include "system/status.h"

int lq_stack_channels(const lq_stack *stack) {
    for (size_t i = 0; i < stack->layer_count; i++)
        for (int p = 0; p < LQ_PARAMETERS; p++)
            if ((lq_parameters[p].layers >> stack->layers[i].type & 1) &&
                lq_parameter_of(&stack->layers[i], &lq_parameters[p])->form == LQ_RGB)
                return LQ_STACK_CHANNELS;
    return 1;
}

/* ======================================================================================
 *                                       One of each
 * ====================================================================================== */

static lq_status open_ndf(lq_plan *plan, const char *text, double alpha, const lq_ndf **ndf,
                          lq_error *error) {
    const lq_ndf *opened = NULL;
    *ndf = NULL;
    lq_status status = lq_ndf_open(&opened, text, error);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < plan->ndf_count && !*ndf; i++)
        if (strcmp(lq_ndf_text(plan->ndf[i]), lq_ndf_text(opened)) == 0) *ndf = plan->ndf[i];
    if (*ndf) lq_ndf_close(opened);
    else *ndf = plan->ndf[plan->ndf_count++] = opened;
    return alpha > 0.0 ? lq_ndf_prepare(*ndf, alpha, error) : LQ_OK;
}

static size_t find_axis(lq_plan *plan, const lq_plan_axis *axis) {
    for (size_t i = 0; i < plan->axis_count; i++)
        if (memcmp(&plan->axis[i], axis, sizeof *axis) == 0) return i;
    plan->axis[plan->axis_count] = *axis;
    return plan->axis_count++;
}

static bool alike(const lq_plan_surface *a, const lq_plan_surface *b) {
    return a->spec.ndf == b->spec.ndf && a->spec.alpha == b->spec.alpha && a->spec.opaque == b->spec.opaque &&
           a->spec.diffuse == b->spec.diffuse && a->axis[0] == b->axis[0] && a->axis[1] == b->axis[1];
}

/* The material of a base among those its surface has; their number where it is none of them. */
static int seek_material(const lq_surface *all, const lq_surface *one) {
    int m = 0;
    while (m < all->materials &&
           !(all->n[m] == one->n[0] && all->kappa[m] == one->kappa[0] && all->rho[m] == one->rho[0]))
        m++;
    return m;
}

/* The same, added where it is new. */
static int find_material(lq_surface *all, const lq_surface *one) {
    const int m = seek_material(all, one);
    if (m < all->materials) return m;
    all->n[m] = one->n[0];
    all->kappa[m] = one->kappa[0];
    all->rho[m] = one->rho[0];
    all->materials++;
    return m;
}

/* A surface has room for as many bases as there are channels. */
static bool serves(const lq_plan_surface *a, const lq_plan_surface *b) {
    return alike(a, b) && (!a->spec.opaque || seek_material(&a->spec, &b->spec) < LQ_STACK_CHANNELS);
}

static lq_plan_step find_surface(lq_plan *plan, const lq_plan_surface *surface) {
    size_t i = 0;
    while (i < plan->surface_count && !serves(&plan->surface[i], surface)) i++;
    if (i == plan->surface_count) plan->surface[plan->surface_count++] = *surface;
    lq_plan_step step = {.surface = i};
    if (surface->spec.opaque) step.material = find_material(&plan->surface[i].spec, &surface->spec);
    return step;
}

/* ======================================================================================
 *                                        Media
 * ====================================================================================== */

static double value_of(const lq_quantity *q, int channel) {
    return q->value[channel];
}

static void media_free(lq_media *media) {
    free(media->n);
    free(media->alpha);
}

/* False without memory; free it in either case. */
static bool media_make(lq_media *media, const lq_stack *stack, int channel) {
    const size_t layers = stack->layer_count;
    *media = (lq_media){.count = 1, .base_n = -1.0};
    media->n = malloc((layers + 1) * sizeof *media->n);
    media->alpha = malloc((layers + 1) * sizeof *media->alpha);
    if (!media->n || !media->alpha) return false;
    media->n[0] = 1.0;
    for (size_t i = 0; i < layers; i++) {
        const lq_layer *layer = &stack->layers[i];
        media->alpha[i] = layer->type == LQ_LAYER_LAMBERTIAN ? INFINITY : value_of(&layer->alpha_x, channel);
        media->alpha[i + 1] = INFINITY;
        if (layer->type == LQ_LAYER_DIELECTRIC) media->n[media->count++] = value_of(&layer->n, channel);
        if (layer->type != LQ_LAYER_CONDUCTOR) continue;
        media->base_n = value_of(&layer->n, channel) / media->n[media->count - 1];
        media->base_kappa = value_of(&layer->kappa, channel) / media->n[media->count - 1];
    }
    return true;
}

/* ======================================================================================
 *                                        Chains
 * ====================================================================================== */

static lq_status add_step(lq_plan *plan, lq_plan_chain *chain, const lq_layer *layer, int channel,
                          lq_scattering scattering, lq_error *error) {
    const size_t i = chain->steps, above = chain->medium[i].axis, below = chain->medium[i + 1].axis;
    const double n_above = plan->axis[above].n;
    lq_plan_surface surface = {.spec = {.scattering = scattering, .materials = 1}, .axis = {above, above}};
    lq_surface *s = &surface.spec;
    s->alpha = layer->type == LQ_LAYER_LAMBERTIAN ? 0.0 : value_of(&layer->alpha_x, channel);
    bool flipped = false;
    if (layer->type == LQ_LAYER_DIELECTRIC) {
        flipped = above > below;
        surface.axis[0] = flipped ? below : above;
        surface.axis[1] = flipped ? above : below;
        s->eta = plan->axis[surface.axis[1]].n / plan->axis[surface.axis[0]].n;
    } else {
        s->opaque = true;
        s->diffuse = layer->type == LQ_LAYER_LAMBERTIAN;
        s->n[0] = s->diffuse ? 0.0 : value_of(&layer->n, channel) / n_above;
        s->kappa[0] = s->diffuse ? 0.0 : value_of(&layer->kappa, channel) / n_above;
        s->rho[0] = s->diffuse ? value_of(&layer->rho, channel) : 0.0;
    }
    if (!s->diffuse) {
        const lq_status status = open_ndf(plan, layer->ndf, s->alpha, &s->ndf, error);
        if (status != LQ_OK) return status;
    }
    chain->step[i] = find_surface(plan, &surface);
    chain->step[i].flipped = flipped;
    chain->steps++;
    return LQ_OK;
}

static void reverse(lq_plan_chain *chain) {
    for (size_t i = 0, j = chain->steps - 1; i < j; i++, j--) {
        const lq_plan_step step = chain->step[i];
        chain->step[i] = chain->step[j];
        chain->step[j] = step;
    }
    for (size_t i = 0, j = chain->steps; i < j; i++, j--) {
        const lq_plan_medium medium = chain->medium[i];
        chain->medium[i] = chain->medium[j];
        chain->medium[j] = medium;
    }
    for (size_t i = 0; i < chain->steps; i++) chain->step[i].flipped = !chain->step[i].flipped;
}

/* Which sides of its surfaces light arrives on. */
static void mark_sides(lq_plan *plan, const lq_plan_chain *chain) {
    for (size_t i = 0; i < chain->steps; i++) {
        lq_plan_surface *s = &plan->surface[chain->step[i].surface];
        const int front = chain->step[i].flipped ? 1 : 0;
        if (i == 0) s->asked[front] = true;
        else s->inside[front] = true;
        if (i + 1 < chain->steps) s->inside[1 - front] = true;
    }
}

/* Media of one index share an axis: what all of them see is looked for once. */
static size_t medium_axis(lq_plan *plan, const lq_plan_chain *chain, const lq_media *media, size_t i) {
    for (size_t before = 0; before < i; before++)
        if (media->n[before] == media->n[i]) return chain->medium[before].axis;
    const lq_plan_axis axis = lq_media_axis(media, media->n[i]);
    return find_axis(plan, &axis);
}

static lq_status make_chain(lq_plan *plan, lq_plan_chain *chain, const lq_stack *stack, int channel,
                            bool from_below, lq_scattering scattering, lq_error *error) {
    const size_t layers = stack->layer_count;
    lq_media media;
    const bool known = media_make(&media, stack, channel);
    chain->step = calloc(layers, sizeof *chain->step);
    chain->medium = calloc(layers + 1, sizeof *chain->medium);
    lq_status status = LQ_OK;
    if (!known || !chain->step || !chain->medium) {
        media_free(&media);
        return lq_fail(error, LQ_NO_MEMORY, "no memory for a stack of %zu layers", layers);
    }
    for (size_t i = 0; i < media.count; i++) {
        chain->medium[i].axis = medium_axis(plan, chain, &media, i);
        chain->medium[i].tau = i == 0 ? 1.0 : lq_medium_transmittance(&stack->layers[i - 1].medium, channel);
    }
    media_free(&media);
    for (size_t i = 0; i < layers && status == LQ_OK; i++)
        status = add_step(plan, chain, &stack->layers[i], channel, scattering, error);
    chain->opaque = stack->layers[layers - 1].type != LQ_LAYER_DIELECTRIC;
    if (status != LQ_OK) return status;
    if (from_below) reverse(chain);
    mark_sides(plan, chain);
    return LQ_OK;
}

lq_status lq_plan_make(lq_plan *plan, const lq_stack *const *stacks, size_t count, bool from_below,
                       lq_scattering scattering, lq_error *error) {
    *plan = (lq_plan){0};
    lq_status status = LQ_OK;
    size_t most = 0;
    int chains = 0;
    for (size_t i = 0; i < count; i++) {
        const int channels = lq_stack_channels(stacks[i]);
        most += (stacks[i]->layer_count + 1) * (size_t)channels;
        chains += channels;
    }
    plan->chain = calloc((size_t)chains + 1, sizeof *plan->chain);
    plan->surface = calloc(most + 1, sizeof *plan->surface);
    plan->axis = calloc(most + 1, sizeof *plan->axis);
    plan->ndf = calloc(most + 1, sizeof *plan->ndf);
    if (!plan->chain || !plan->surface || !plan->axis || !plan->ndf)
        status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu interfaces", most);
    for (size_t i = 0; i < count && status == LQ_OK; i++)
        for (int c = 0; c < lq_stack_channels(stacks[i]) && status == LQ_OK; c++)
            status =
                make_chain(plan, &plan->chain[plan->channels++], stacks[i], c, from_below, scattering, error);
    if (status != LQ_OK) lq_plan_free(plan);
    return status;
}

void lq_plan_free(lq_plan *plan) {
    for (int c = 0; c < plan->channels; c++) {
        free(plan->chain[c].step);
        free(plan->chain[c].medium);
    }
    for (size_t i = 0; i < plan->ndf_count; i++) lq_ndf_close(plan->ndf[i]);
    free(plan->chain);
    free(plan->surface);
    free(plan->axis);
    free(plan->ndf);
}
