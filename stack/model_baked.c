/* model_baked.c - exact energies, and roughness from exact spread, of stacks opaque or not. */
#include "stack/model_baked.h"

#include <math.h>
#include <stdlib.h>

#include "stack/material.h"
#include "system/status.h"

typedef struct baking {
    const lq_stack *stack;
    const lq_model_query *query;
    lq_spread spread; /* of the cosines and, after them, of 1 */
    lq_model_lobe *lobes;
} baking;

static lq_status baking_make(baking *b, lq_error *error) {
    const size_t count = b->query->mu_count;
    double *mu = malloc((count + 1) * sizeof *mu);
    if (!mu) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    for (size_t m = 0; m < count; m++) mu[m] = b->query->mu[m];
    mu[count] = 1.0;
    const lq_status status = lq_spread_make(&b->spread, mu, count + 1, error);
    free(mu);
    return status;
}

static lq_model_lobe *lobes_at(const baking *b, size_t m, int channel) {
    const size_t line = m * (size_t)lq_stack_channels(b->stack) + (size_t)channel;
    return b->lobes + line * lq_model_lobe_count(b->stack);
}

static lq_model_lobe lobe_of(double energy, double mean, double alpha) {
    return energy > 0.0 ? (lq_model_lobe){.energy = energy, .mean = mean, .alpha = alpha}
                        : (lq_model_lobe){0};
}

/* ======================================================================================
 *                                   Opaque: as a material
 * ====================================================================================== */

static void read_numbers(const baking *b, const lq_material *material, size_t m, const double *n) {
    const size_t last = b->stack->layer_count - 1;
    const double away = lq_sine(b->query->mu[m]);
    for (int c = 0; c < lq_stack_channels(b->stack); c++) {
        lq_model_lobe *lobes = lobes_at(b, m, c);
        const double inner = n[LQ_MATERIAL_INNER + c];
        for (size_t k = 0; k <= last + 1; k++) lobes[k] = (lq_model_lobe){0};
        lobes[0] = lobe_of(n[LQ_MATERIAL_TOP + c], away, b->stack->layers[0].alpha_x.value[c]);
        if (inner > 0.0)
            lobes[material->lambertian ? 1 : last] = lobe_of(inner, away, n[LQ_MATERIAL_INNER_ALPHA]);
        if (material->lambertian)
            lobes[last] = lobe_of(lq_material_base(n, c, material, 0.0), 0.0, n[LQ_MATERIAL_BASE_ALPHA]);
    }
}

static lq_status bake_opaque(const baking *b, const lq_material *material, lq_error *error) {
    const size_t count = b->query->mu_count;
    double *numbers = malloc((count + 1) * LQ_MATERIAL_NUMBERS * sizeof *numbers);
    lq_status status =
        numbers ? lq_material_solve(material, NULL, &b->spread, b->query->mu, count, -1, 0.0, numbers, error)
                : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    for (size_t m = 0; m < count && status == LQ_OK; m++)
        read_numbers(b, material, m, numbers + m * LQ_MATERIAL_NUMBERS);
    free(numbers);
    return status;
}

/* ======================================================================================
 *                                   What lets light through
 * ====================================================================================== */

/* Between the outside and the lowest medium; light that does not refract leaves along the horizon. */
static double sine_below(const lq_stack *stack, double mu, int channel) {
    return fmin(lq_sine(mu) / stack->layers[stack->layer_count - 1].n.value[channel], 1.0);
}

static lq_status read_through(const baking *b, size_t m, int channel, const lq_stack_light *paths,
                              lq_error *error) {
    const size_t last = b->stack->layer_count - 1;
    const double mu = b->query->mu[m], below = sine_below(b->stack, mu, channel);
    const lq_stack_lobe *top = &paths[0].reflected, *inner = &paths[1].reflected;
    const lq_stack_lobe *one = &paths[0].transmitted, *more = &paths[1].transmitted;
    const double through = one->energy + more->energy;
    lq_model_lobe *lobes = lobes_at(b, m, channel);
    double alpha = 0.0;
    for (size_t k = 0; k <= last + 1; k++) lobes[k] = (lq_model_lobe){0};
    lobes[0] = lobe_of(top->energy, lq_sine(mu), b->stack->layers[0].alpha_x.value[channel]);
    if (last > 0)
        lobes[last] = lobe_of(inner->energy, lq_sine(mu), lq_spread_alpha(&b->spread, m, inner->across));
    if (!(through > 0.0)) return LQ_OK;
    const double across = (one->energy * one->across + more->energy * more->across) / through;
    const lq_status status = lq_spread_alpha_at(lq_sine(below), across, &alpha, error);
    if (status == LQ_OK) lobes[last + 1] = lobe_of(through, below, alpha);
    return status;
}

static lq_status bake_through(const baking *b, const lq_progress *progress, lq_error *error) {
    const size_t count = b->query->mu_count, channels = (size_t)lq_stack_channels(b->stack);
    const lq_stack_query query = {
        .mu = b->query->mu, .mu_count = count, .paths = 2, .threads = b->query->threads};
    lq_stack_light *light = malloc((count * channels * 2 + 1) * sizeof *light);
    lq_status status = light ? lq_stack_solve(b->stack, &query, light, progress, error)
                             : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    if (status == LQ_NOT_CONVERGED) status = LQ_OK; /* what is left is far below what a lobe misses */
    for (size_t i = 0; i < count * channels && status == LQ_OK; i++)
        status = read_through(b, i / channels, (int)(i % channels), light + 2 * i, error);
    free(light);
    return status;
}

/* ======================================================================================
 *                                          Both
 * ====================================================================================== */

static void set_variances(const baking *b) {
    const size_t lines = b->query->mu_count * (size_t)lq_stack_channels(b->stack);
    for (size_t i = 0; i < lines * lq_model_lobe_count(b->stack); i++)
        b->lobes[i].variance = lq_model_variance(b->query->mapping, b->lobes[i].alpha);
}

lq_status lq_model_baked(const lq_stack *stack, const lq_model_query *query, lq_model_lobe *lobes,
                         const lq_progress *progress, lq_error *error) {
    baking b = {.stack = stack, .query = query, .lobes = lobes};
    lq_material material;
    lq_status status = baking_make(&b, error);
    if (status == LQ_OK && stack->layers[stack->layer_count - 1].type == LQ_LAYER_DIELECTRIC)
        status = bake_through(&b, progress, error);
    else if (status == LQ_OK) {
        status = lq_material_describe(&material, stack, error);
        if (status == LQ_OK) status = bake_opaque(&b, &material, error);
    }
    lq_spread_free(&b.spread);
    if (status == LQ_OK) set_variances(&b);
    return status;
}
