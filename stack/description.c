/* description.c - stacks in memory: the parameters of their layers, copies, setting one by its path. */
#include "stack/description.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/number.h"
#include "system/status.h"

enum {
    DIELECTRIC = 1 << LQ_LAYER_DIELECTRIC,
    CONDUCTOR = 1 << LQ_LAYER_CONDUCTOR,
    LAMBERTIAN = 1 << LQ_LAYER_LAMBERTIAN,
    ROUGH = DIELECTRIC | CONDUCTOR
};

#define AT(member) .offset = offsetof(lq_layer, member)

const lq_parameter lq_parameters[LQ_PARAMETERS] = {
    {"n", DIELECTRIC, true, AT(n), .highest = 10.0, .otherwise = 1.0, .open_low = true},
    {"n", CONDUCTOR, true, AT(n), .highest = 100.0, .otherwise = 1.0},
    {"kappa", CONDUCTOR, true, AT(kappa), .highest = 100.0},
    {"alpha.x", ROUGH, true, AT(alpha_x), .highest = 1.0},
    {"alpha.y", ROUGH, true, AT(alpha_y), .highest = 1.0},
    {"alpha.rotate", ROUGH, AT(rotate), .lowest = -360.0, .highest = 360.0},
    {"rho", LAMBERTIAN, true, AT(rho), .highest = 1.0},
    {"tau", DIELECTRIC, true, .in_medium = true, AT(medium.tau), .highest = 1.0, .otherwise = 1.0},
    {"sigma_a", DIELECTRIC, .in_medium = true, .by_sigma = true, AT(medium.sigma_a), .highest = 1e6},
    {"sigma_s", DIELECTRIC, .in_medium = true, .by_sigma = true, AT(medium.sigma_s), .highest = 1e6},
    {"depth", DIELECTRIC, true, true, true, AT(medium.depth), .highest = 1e6},
    {"g", DIELECTRIC, .in_medium = true, .by_sigma = true, AT(medium.g), .lowest = -1.0, .highest = 1.0,
     .open_low = true, .open_high = true},
};

const lq_parameter *lq_parameter_find(lq_layer_type type, const char *name) {
    for (int i = 0; i < LQ_PARAMETERS; i++)
        if ((lq_parameters[i].layers >> type & 1) && strcmp(lq_parameters[i].name, name) == 0)
            return &lq_parameters[i];
    return NULL;
}

bool lq_parameter_accepts(const lq_parameter *p, double value) {
    return (value > p->lowest || (value == p->lowest && !p->open_low)) &&
           (value < p->highest || (value == p->highest && !p->open_high));
}

void lq_parameter_range_text(const lq_parameter *p, char *text, size_t size) {
    lq_print(text, size, "%g <%s %s <%s %g", p->lowest, p->open_low ? "" : "=", p->name,
             p->open_high ? "" : "=", p->highest);
}

lq_quantity lq_quantity_one(double value) {
    return (lq_quantity){LQ_ONE, {value, value, value}, value};
}

const char *lq_layer_type_name(lq_layer_type type) {
    static const char *const names[] = {"dielectric", "conductor", "lambertian"};
    return names[type];
}

lq_layer lq_layer_default(lq_layer_type type) {
    lq_layer layer = {.type = type, .ndf = "ggx"};
    for (int i = 0; i < LQ_PARAMETERS; i++)
        *lq_parameter_of(&layer, &lq_parameters[i]) = lq_quantity_one(lq_parameters[i].otherwise);
    return layer;
}

double lq_medium_transmittance(const lq_medium *medium, int channel) {
    if (!medium->by_sigma) return medium->tau.value[channel];
    return exp(-medium->sigma_a.value[channel] * medium->depth.value[channel]);
}

bool lq_medium_scatters(const lq_medium *medium) {
    if (!medium->by_sigma) return false;
    for (int c = 0; c < LQ_STACK_CHANNELS; c++)
        if (medium->sigma_s.value[c] > 0.0 && medium->depth.value[c] > 0.0) return true;
    return false;
}

lq_status lq_stack_copy(lq_stack **copy, const lq_stack *stack, lq_error *error) {
    lq_stack *to = malloc(sizeof *to);
    lq_layer *layers = calloc(stack->layer_count, sizeof *layers);
    *copy = NULL;
    if (!to || !layers) {
        free(to);
        free(layers);
        return lq_fail(error, LQ_NO_MEMORY, "no memory for a stack");
    }
    *to = *stack;
    to->layers = layers;
    memcpy(layers, stack->layers, stack->layer_count * sizeof *layers);
    *copy = to;
    return LQ_OK;
}

void lq_stack_free(lq_stack *stack) {
    if (stack) free(stack->layers);
    free(stack);
}

/* ======================================================================================
 *                                  Parameters by path
 * ====================================================================================== */

/* The layer that the text before the first point of `path` names; NULL: none. */
static lq_layer *find_layer(const lq_stack *stack, const char *path, size_t length) {
    char *end = NULL;
    if (length == 3 && strncmp(path, "top", 3) == 0) return &stack->layers[0];
    if (length == 4 && strncmp(path, "base", 4) == 0) return &stack->layers[stack->layer_count - 1];
    if (!(path[0] >= '1' && path[0] <= '9')) return NULL;
    const unsigned long number = strtoul(path, &end, 10);
    return end == path + length && number <= stack->layer_count ? &stack->layers[number - 1] : NULL;
}

/* "alpha" is both of alpha.x and alpha.y. */
static const char *parameter_name(const char *name) {
    return strcmp(name, "alpha") == 0 ? "alpha.x" : name;
}

static lq_status find(const lq_stack *stack, const char *path, lq_layer **layer, const lq_parameter **which,
                      lq_error *error) {
    const char *point = strchr(path, '.');
    *layer = point ? find_layer(stack, path, (size_t)(point - path)) : NULL;
    if (!*layer)
        return lq_fail(error, LQ_BAD_INPUT,
                       "'%.60s' names no layer; accepted: top.NAME, base.NAME or N.NAME, N from 1 to %zu",
                       path, stack->layer_count);
    *which = lq_parameter_find((*layer)->type, parameter_name(point + 1));
    if (!*which)
        return lq_fail(error, LQ_BAD_INPUT, "'%.60s': a %s has no such parameter; accepted: %s", path,
                       lq_layer_type_name((*layer)->type),
                       (*layer)->type == LQ_LAYER_DIELECTRIC
                           ? "n, alpha, alpha.x, alpha.y, alpha.rotate, tau, sigma_a, sigma_s, depth, g"
                       : (*layer)->type == LQ_LAYER_CONDUCTOR
                           ? "n, kappa, alpha, alpha.x, alpha.y, alpha.rotate"
                           : "rho");
    if ((*which)->in_medium && (*which)->by_sigma != (*layer)->medium.by_sigma)
        return lq_fail(error, LQ_BAD_INPUT, "'%.60s': the medium is said by %s", path,
                       (*layer)->medium.by_sigma ? "sigma_a, sigma_s, depth and g" : "tau");
    return LQ_OK;
}

lq_status lq_stack_range(const lq_stack *stack, const char *path, double *lowest, double *highest,
                         lq_error *error) {
    lq_layer *layer = NULL;
    const lq_parameter *which = NULL;
    const lq_status status = find(stack, path, &layer, &which, error);
    if (status != LQ_OK) return status;
    *lowest = which->lowest;
    *highest = which->highest;
    return LQ_OK;
}

lq_status lq_stack_set(lq_stack *stack, const char *path, double value, lq_error *error) {
    lq_layer *layer = NULL;
    const lq_parameter *which = NULL;
    const lq_status status = find(stack, path, &layer, &which, error);
    if (status != LQ_OK) return status;
    if (!lq_parameter_accepts(which, value)) {
        char range[80];
        lq_parameter_range_text(which, range, sizeof range);
        return lq_fail(error, LQ_BAD_INPUT, "%.60s = %g; accepted: %s", path, value, range);
    }
    *lq_parameter_of(layer, which) = lq_quantity_one(value);
    const char *name = strchr(path, '.') + 1;
    if (strcmp(name, "alpha") == 0) {
        layer->alpha_y = lq_quantity_one(value);
        layer->anisotropic = false;
    } else if (strncmp(name, "alpha.", 6) == 0) {
        layer->anisotropic = true;
    }
    return LQ_OK;
}

/* "alpha" is found as alpha.x and sets alpha.y besides. */
static bool sets_y(const char *path, const lq_parameter *which) {
    return which->offset == offsetof(lq_layer, alpha_y) || strcmp(strchr(path, '.') + 1, "alpha") == 0;
}

bool lq_stack_overlap(const lq_stack *stack, const char *one, const char *other) {
    lq_layer *layer[2] = {NULL, NULL};
    const lq_parameter *which[2] = {NULL, NULL};
    if (find(stack, one, &layer[0], &which[0], NULL) != LQ_OK ||
        find(stack, other, &layer[1], &which[1], NULL) != LQ_OK || layer[0] != layer[1])
        return false;
    return which[0] == which[1] || (sets_y(one, which[0]) && sets_y(other, which[1]));
}
