/* material.c - which parameters a material leaves open, and its lobes at one set of them. */
#include "stack/material.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stack/description.h"
#include "stack/level.h"
#include "stack/spread.h"
#include "system/status.h"

/* ======================================================================================
 *                                     Description
 * ====================================================================================== */

/* "alpha" for both of alpha.x and alpha.y of an isotropic interface. */
static const char *plain_name(const lq_parameter *p) {
    return strcmp(p->name, "alpha.x") == 0 ? "alpha" : p->name;
}

static bool is_open(const lq_layer *layer, const lq_parameter *p) {
    if (!(p->layers >> layer->type & 1) || (p->in_medium && p->by_sigma != layer->medium.by_sigma))
        return false;
    if (strcmp(p->name, "alpha.y") == 0) return false; /* the same range as alpha.x */
    return lq_parameter_of((lq_layer *)layer, p)->form == LQ_RANGE;
}

/* Whether another layer leaves a parameter of that name open. */
static bool is_shared(const lq_stack *stack, size_t layer, const lq_parameter *p) {
    for (size_t i = 0; i < stack->layer_count; i++) {
        const lq_parameter *other = lq_parameter_find(stack->layers[i].type, p->name);
        if (i != layer && other && is_open(&stack->layers[i], other)) return true;
    }
    return false;
}

static void name_range(lq_material_range *range, const lq_stack *stack, size_t layer, const lq_parameter *p) {
    const char *name = plain_name(p);
    char place[32] = "";
    snprintf(range->path, sizeof range->path, "%zu.%.12s", layer + 1, name);
    if (is_shared(stack, layer, p)) {
        if (layer == 0) strcpy(place, "top_");
        else if (layer + 1 == stack->layer_count) strcpy(place, "base_");
        else snprintf(place, sizeof place, "layer%zu_", layer + 1);
    }
    snprintf(range->name, sizeof range->name, "%s%.12s", place, name);
}

static lq_status add_range(lq_material *m, size_t layer, const lq_parameter *p, lq_error *error) {
    const lq_quantity *q = lq_parameter_of(&m->stack->layers[layer], p);
    if (strcmp(p->name, "rho") == 0) {
        m->open_rho = true;
        m->rho_min = q->value[0];
        m->rho_max = q->highest;
        return LQ_OK;
    }
    if (m->range_count == LQ_MATERIAL_RANGES)
        return lq_fail(error, LQ_BAD_INPUT,
                       "%s.%s is one range too many; accepted: at most %d besides the albedo of a lambertian "
                       "base",
                       lq_layer_type_name(m->stack->layers[layer].type), plain_name(p), LQ_MATERIAL_RANGES);
    if (layer == 0 && strcmp(p->name, "alpha.x") == 0) m->top_range = m->range_count;
    lq_material_range *range = &m->ranges[m->range_count++];
    name_range(range, m->stack, layer, p);
    range->min = q->value[0];
    range->max = q->highest;
    range->roughness = strncmp(p->name, "alpha", 5) == 0;
    return LQ_OK;
}

static lq_status check_layer(const lq_layer *layer, size_t number, lq_error *error) {
    if (layer->type == LQ_LAYER_LAMBERTIAN) return LQ_OK;
    if (layer->anisotropic)
        return lq_fail(error, LQ_BAD_INPUT, "layer %zu is anisotropic; accepted: one alpha", number);
    if (strcmp(layer->ndf, "ggx") != 0)
        return lq_fail(error, LQ_BAD_INPUT,
                       "layer %zu has the NDF %.60s; accepted: ggx, as the lobes of the shader", number,
                       layer->ndf);
    if (layer->type == LQ_LAYER_DIELECTRIC && lq_medium_scatters(&layer->medium))
        return lq_fail(error, LQ_BAD_INPUT, "the medium of layer %zu scatters; accepted: absorption alone",
                       number);
    return LQ_OK;
}

lq_status lq_material_describe(lq_material *m, const lq_stack *stack, lq_error *error) {
    const lq_layer *top = &stack->layers[0], *base = &stack->layers[stack->layer_count - 1];
    lq_status status = LQ_OK;
    *m = (lq_material){.stack = stack, .lambertian = base->type == LQ_LAYER_LAMBERTIAN, .top_range = -1};
    if (base->type == LQ_LAYER_DIELECTRIC)
        return lq_fail(
            error, LQ_BAD_INPUT,
            "the last layer lets light through; accepted: a conductor or lambertian as the last one");
    for (size_t i = 0; i < stack->layer_count && status == LQ_OK; i++) {
        status = check_layer(&stack->layers[i], i + 1, error);
        for (int k = 0; k < LQ_PARAMETERS && status == LQ_OK; k++)
            if (is_open(&stack->layers[i], &lq_parameters[k]))
                status = add_range(m, i, &lq_parameters[k], error);
    }
    if (top->type != LQ_LAYER_LAMBERTIAN && top->alpha_x.form != LQ_RANGE)
        m->top_alpha = top->alpha_x.value[0];
    return status;
}

/* ======================================================================================
 *                                  One set of parameters
 * ====================================================================================== */

/* What one solve is about. */
typedef struct lights {
    const double *mu;
    size_t count;
    int level; /* < 0: exact, to */
    double tolerance;
    int channels;          /* of all stacks */
    lq_stack_light *light; /* [(m * channels + c) * 2 + path] */
} lights;

static lq_status solve(const lq_stack *const *stacks, size_t count, lights *l, lq_error *error) {
    const lq_stack_query query = {
        .mu = l->mu, .mu_count = l->count, .paths = 2, .tolerance = l->tolerance, .threads = 1};
    l->channels = 0;
    for (size_t i = 0; i < count; i++) l->channels += lq_stack_channels(stacks[i]);
    if (l->level < 0) {
        const lq_status status = lq_stack_solve_list(stacks, count, &query, l->light, NULL, error);
        return status == LQ_NOT_CONVERGED ? LQ_OK : status; /* what is left is far below what a texture has */
    }
    lq_plan plan;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < count && status == LQ_OK; i++)
        status = lq_stack_solvable(stacks[i], &query, error);
    if (status == LQ_OK) status = lq_plan_make(&plan, stacks, count, false, LQ_MULTIPLE, error);
    if (status != LQ_OK) return status;
    status = lq_stack_level(&plan, &query, l->level, l->light, NULL, error);
    lq_plan_free(&plan);
    return status;
}

static const lq_stack_lobe *lobe(const lights *l, size_t m, int channel, int path) {
    return &l->light[(m * (size_t)l->channels + (size_t)channel) * 2 + (size_t)path].reflected;
}

/* The inner lobe of a colour; its spread is weighed by energy over colours. */
static void add_inner(const lq_stack_lobe *inner, int colour, double *numbers, double *across) {
    numbers[LQ_MATERIAL_INNER + colour] = inner->energy;
    *across += inner->energy * inner->across;
}

static double sum3(const double *x) {
    return x[0] + x[1] + x[2];
}

/* Less energy than this has no lobe to see. */
static const double FAINT = 1e-6;

static void set_inner_alpha(const lq_spread *spread, size_t m, double across, double *numbers) {
    const double energy = sum3(numbers + LQ_MATERIAL_INNER);
    numbers[LQ_MATERIAL_INNER_ALPHA] = energy > FAINT ? lq_spread_alpha(spread, m, across / energy) : 0.0;
}

static lq_status solve_conductor(const lq_stack *stack, lights *l, const lq_spread *spread, double *numbers,
                                 lq_error *error) {
    const lq_status status = solve(&stack, 1, l, error);
    for (size_t m = 0; m < l->count && status == LQ_OK; m++) {
        double *n = numbers + m * LQ_MATERIAL_NUMBERS, across = 0.0;
        for (int c = 0; c < LQ_MATERIAL_COLOURS; c++) {
            const int channel = c < l->channels ? c : 0;
            n[LQ_MATERIAL_TOP + c] = lobe(l, m, channel, 0)->energy;
            if (stack->layer_count > 1) add_inner(lobe(l, m, channel, 1), c, n, &across);
        }
        set_inner_alpha(spread, m, across, n);
    }
    return status;
}

/* One colour of a stack, with the base's albedo at 0, 1/2 and 1 in its three channels. */
static void split_albedo(lq_stack *split, const lq_stack *stack, int colour) {
    for (size_t i = 0; i < stack->layer_count; i++)
        for (int k = 0; k < LQ_PARAMETERS; k++) {
            const lq_quantity *from = lq_parameter_of(&stack->layers[i], &lq_parameters[k]);
            *lq_parameter_of(&split->layers[i], &lq_parameters[k]) = lq_quantity_one(from->value[colour]);
        }
    split->layers[stack->layer_count - 1].rho = (lq_quantity){LQ_RGB, {0.0, 0.5, 1.0}, 1.0};
}

enum { DARK, HALF, WHITE, ALBEDOS };

/* Light of a colour at one of the three albedos; colours that do not differ were solved once. */
static const lq_stack_lobe *lit(const lights *l, size_t m, int colour, int albedo, int path) {
    const int channel = ALBEDOS * colour + albedo;
    return lobe(l, m, channel < l->channels ? channel : albedo, path);
}

static double total(const lights *l, size_t m, int colour, int albedo) {
    return lit(l, m, colour, albedo, 0)->energy + lit(l, m, colour, albedo, 1)->energy;
}

/* Of a colour: back from energies at rho 1/2 (h) and 1 (w) less that at 0, which are through rho / (1 - rho
 * back): back = (w - 2 h) / (w - h) at any cosine, here of their sums. And E[across] of what left the base.
 */
static void read_base(const lights *l, int colour, double *back, double *across) {
    double half = 0.0, white = 0.0, spread = 0.0;
    for (size_t m = 0; m < l->count; m++) {
        const lq_stack_lobe *dark = lit(l, m, colour, DARK, 1), *bright = lit(l, m, colour, WHITE, 1);
        half += total(l, m, colour, HALF) - total(l, m, colour, DARK);
        white += total(l, m, colour, WHITE) - total(l, m, colour, DARK);
        spread += bright->energy * bright->across - dark->energy * dark->across;
    }
    *back = white > half ? fmin(fmax((white - 2.0 * half) / (white - half), 0.0), 1.0) : 0.0;
    *across = white > FAINT ? spread / white : 0.25;
}

static void store_base(const lq_material *material, const lights *l, int colour, double back,
                       double *numbers) {
    const double rho = material->stack->layers[material->stack->layer_count - 1].rho.value[colour];
    for (size_t m = 0; m < l->count; m++) {
        double *n = numbers + m * LQ_MATERIAL_NUMBERS;
        const double through = (total(l, m, colour, WHITE) - total(l, m, colour, DARK)) * (1.0 - back);
        n[LQ_MATERIAL_TOP + colour] = lit(l, m, colour, DARK, 0)->energy;
        n[LQ_MATERIAL_THROUGH + colour] = material->open_rho ? through : through * rho / (1.0 - rho * back);
        n[LQ_MATERIAL_BACK + colour] = material->open_rho ? back : 0.0;
    }
}

/* What was inside and did not meet the base: a coat of one interface holds none. */
static void store_dark(const lq_stack *stack, const lights *l, const lq_spread *spread, double *numbers) {
    for (size_t m = 0; m < l->count; m++) {
        double *n = numbers + m * LQ_MATERIAL_NUMBERS, across = 0.0;
        for (int c = 0; c < LQ_MATERIAL_COLOURS && stack->layer_count > 2; c++)
            add_inner(lit(l, m, c, DARK, 1), c, n, &across);
        set_inner_alpha(spread, m, across, n);
    }
}

/* Whether colours differ in anything but the base's albedo. */
static bool splits_colours(const lq_stack *stack) {
    for (size_t i = 0; i < stack->layer_count; i++)
        for (int k = 0; k < LQ_PARAMETERS; k++) {
            const lq_parameter *p = &lq_parameters[k];
            if (strcmp(p->name, "rho") != 0 && (p->layers >> stack->layers[i].type & 1) &&
                lq_parameter_of(&stack->layers[i], p)->form == LQ_RGB)
                return true;
        }
    return false;
}

/* All colours and albedos at once: their interfaces are the same, and solved once. */
static lq_status solve_albedos(const lq_stack *stack, lights *l, lq_error *error) {
    const size_t colours = splits_colours(stack) ? LQ_MATERIAL_COLOURS : 1;
    lq_stack *split[LQ_MATERIAL_COLOURS] = {NULL};
    lq_status status = LQ_OK;
    for (size_t c = 0; c < colours && status == LQ_OK; c++) {
        status = lq_stack_copy(&split[c], stack, error);
        if (status == LQ_OK) split_albedo(split[c], stack, (int)c);
    }
    if (status == LQ_OK) status = solve((const lq_stack *const *)split, colours, l, error);
    for (size_t c = 0; c < colours; c++) lq_stack_free(split[c]);
    return status;
}

static lq_status solve_lambertian(const lq_material *material, const lq_stack *stack, lights *l,
                                  const lq_spread *spread, double *numbers, lq_error *error) {
    double leaving = 0.0;
    const lq_status status = solve_albedos(stack, l, error);
    if (status != LQ_OK) return status;
    for (int c = 0; c < LQ_MATERIAL_COLOURS; c++) {
        double back, across;
        read_base(l, c, &back, &across);
        store_base(material, l, c, back, numbers);
        leaving += across / LQ_MATERIAL_COLOURS;
    }
    store_dark(stack, l, spread, numbers);
    for (size_t m = 0; m < l->count; m++)
        numbers[m * LQ_MATERIAL_NUMBERS + LQ_MATERIAL_BASE_ALPHA] =
            lq_spread_alpha(spread, l->count, leaving);
    return LQ_OK;
}

/* A bare Lambertian surface lets all light through to itself. */
static void describe_bare(const lq_material *material, size_t count, const lq_spread *spread,
                          double *numbers) {
    for (size_t m = 0; m < count; m++) {
        double *n = numbers + m * LQ_MATERIAL_NUMBERS;
        for (int c = 0; c < LQ_MATERIAL_COLOURS; c++)
            n[LQ_MATERIAL_THROUGH + c] = material->open_rho ? 1.0 : material->stack->layers[0].rho.value[c];
        n[LQ_MATERIAL_BASE_ALPHA] = lq_spread_alpha(spread, count, 0.25);
    }
}

lq_status lq_material_solve(const lq_material *material, const double *values, const lq_spread *spread,
                            const double *mu, size_t count, int level, double tolerance, double *numbers,
                            lq_error *error) {
    lights l = {.mu = mu, .count = count, .level = level, .tolerance = tolerance};
    lq_stack *stack = NULL;
    lq_status status = lq_stack_copy(&stack, material->stack, error);
    l.light = malloc((count + 1) * 2 * LQ_MATERIAL_COLOURS * ALBEDOS * sizeof *l.light);
    if (status == LQ_OK && !l.light)
        status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    memset(numbers, 0, count * LQ_MATERIAL_NUMBERS * sizeof *numbers);
    for (int r = 0; r < material->range_count && status == LQ_OK; r++)
        status = lq_stack_set(stack, material->ranges[r].path, values[r], error);
    if (status == LQ_OK && material->lambertian && stack->layer_count == 1)
        describe_bare(material, count, spread, numbers);
    else if (status == LQ_OK && material->lambertian)
        status = solve_lambertian(material, stack, &l, spread, numbers, error);
    else if (status == LQ_OK) status = solve_conductor(stack, &l, spread, numbers, error);
    lq_stack_free(stack);
    free(l.light);
    return status;
}
