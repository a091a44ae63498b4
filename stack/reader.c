/* reader.c - a stack from its JSON description; every complaint names file, line, layer and what is accepted.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "microfacet/ndf.h"
#include "stack/description.h"
#include "stack/locate.h"
#include "stack/reader.h"
#include "system/input.h"
#include "system/json.h"
#include "system/number.h"
#include "system/status.h"

typedef struct reader {
    const char *name, *text;
    const lq_stack_place *place; /* in the text; NULL: it is the whole */
    unsigned flags;
    size_t layer;       /* the one being read, counted from 1; 0: none yet */
    const char *object; /* "dielectric", "medium", ...; NULL: the layer itself */
    lq_error *error;
} reader;

/* "FILE: line N: layer 2: ..."; `key` is the member complained about, NULL: the object. */
static lq_status refuse(const reader *r, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static lq_status refuse(const reader *r, const char *key, const char *format, ...) {
    lq_json_step steps[6];
    char text[LQ_MESSAGE_SIZE], where[32] = "";
    size_t count = 0;
    if (r->place) {
        steps[count++] = (lq_json_step){.key = r->place->list};
        steps[count++] = (lq_json_step){.index = r->place->index};
    }
    va_list arguments;
    va_start(arguments, format);
    lq_vprint(text, sizeof text, format, arguments);
    va_end(arguments);
    if (r->layer > 0) {
        steps[count++] = (lq_json_step){.key = "layers"};
        steps[count++] = (lq_json_step){.index = r->layer - 1};
        snprintf(where, sizeof where, "layer %zu: ", r->layer);
        if (r->object) steps[count++] = (lq_json_step){.key = r->object};
    }
    if (key) steps[count++] = (lq_json_step){.key = key};
    return lq_fail(r->error, LQ_BAD_INPUT, "%s: line %d: %s%s", r->name, lq_json_line(r->text, steps, count),
                   where, text);
}

/* Every key of `object` is one of the words of `accepted`, which are parted by ", ". */
static lq_status check_keys(const reader *r, json_t *object, const char *accepted) {
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) {
        const size_t length = strlen(key);
        const char *at = accepted;
        while (at && !(strncmp(at, key, length) == 0 && (at[length] == ',' || at[length] == '\0')))
            at = (at = strstr(at, ", ")) ? at + 2 : NULL;
        if (!at || length == 0) return refuse(r, key, "unknown key '%.40s'; accepted: %s", key, accepted);
    }
    return LQ_OK;
}

/* ======================================================================================
 *                                       Numbers
 * ====================================================================================== */

static lq_status check_number(const reader *r, const char *key, const lq_parameter *p, double value) {
    char range[80];
    if (lq_parameter_accepts(p, value)) return LQ_OK;
    lq_parameter_range_text(p, range, sizeof range);
    return refuse(r, key, "%s = %g; accepted: %s", p->name, value, range);
}

static lq_status read_rgb(const reader *r, const char *key, const lq_parameter *p, json_t *json,
                          lq_quantity *to) {
    if (json_array_size(json) != LQ_STACK_CHANNELS)
        return refuse(r, key, "%s: a list of %zu; accepted: a number or [r, g, b]", p->name,
                      json_array_size(json));
    to->form = LQ_RGB;
    for (size_t c = 0; c < LQ_STACK_CHANNELS; c++) {
        json_t *one = json_array_get(json, c);
        if (!json_is_number(one))
            return refuse(r, key, "%s: entry %zu is no number; accepted: a number or [r, g, b]", p->name,
                          c + 1);
        to->value[c] = json_number_value(one);
        const lq_status status = check_number(r, key, p, to->value[c]);
        if (status != LQ_OK) return status;
    }
    to->highest = to->value[0];
    return LQ_OK;
}

static lq_status read_range(const reader *r, const char *key, const lq_parameter *p, json_t *json,
                            lq_quantity *to) {
    json_t *min = json_object_get(json, "min"), *max = json_object_get(json, "max");
    if (!(r->flags & LQ_STACK_RANGES))
        return refuse(r, key, "%s: a range, which only scenes take; accepted: a number or [r, g, b]",
                      p->name);
    if (!json_is_number(min) || !json_is_number(max) || json_object_size(json) != 2 ||
        json_number_value(min) > json_number_value(max))
        return refuse(r, key, "%s: no range; accepted: {\"min\": A, \"max\": B} with A <= B", p->name);
    *to = lq_quantity_one(json_number_value(min));
    to->form = LQ_RANGE;
    to->highest = json_number_value(max);
    const lq_status status = check_number(r, key, p, to->value[0]);
    return status == LQ_OK ? check_number(r, key, p, to->highest) : status;
}

static bool is_range(json_t *json) {
    return json_object_get(json, "min") || json_object_get(json, "max");
}

/* `json` NULL: absent. */
static lq_status read_quantity(const reader *r, const char *key, const lq_parameter *p, json_t *json,
                               lq_layer *layer) {
    lq_quantity *to = lq_parameter_of(layer, p);
    if (!json) return p->required ? refuse(r, NULL, "%s is missing", p->name) : LQ_OK;
    if (json_is_array(json)) return read_rgb(r, key, p, json, to);
    if (is_range(json)) return read_range(r, key, p, json, to);
    if (!json_is_number(json))
        return refuse(r, key, "%s is no number; accepted: a number or [r, g, b]", p->name);
    *to = lq_quantity_one(json_number_value(json));
    return check_number(r, key, p, to->value[0]);
}

/* ======================================================================================
 *                                       Layers
 * ====================================================================================== */

static lq_status read_alpha(const reader *r, json_t *json, lq_layer *layer) {
    const lq_parameter *x = lq_parameter_find(layer->type, "alpha.x");
    const lq_parameter *y = lq_parameter_find(layer->type, "alpha.y");
    if (!json) return refuse(r, NULL, "alpha is missing; 0 is a smooth interface");
    layer->anisotropic = json_is_object(json) && !is_range(json);
    if (!layer->anisotropic) {
        const lq_status status = read_quantity(r, "alpha", x, json, layer);
        layer->alpha_y = layer->alpha_x;
        return status;
    }
    const char *key;
    json_t *value;
    json_object_foreach(json, key, value) {
        if (strcmp(key, "x") != 0 && strcmp(key, "y") != 0 && strcmp(key, "rotate") != 0)
            return refuse(r, "alpha", "alpha: unknown key '%.40s'; accepted: x, y, rotate", key);
    }
    lq_status status = read_quantity(r, "alpha", x, json_object_get(json, "x"), layer);
    if (status == LQ_OK) status = read_quantity(r, "alpha", y, json_object_get(json, "y"), layer);
    if (status == LQ_OK)
        status = read_quantity(r, "alpha", lq_parameter_find(layer->type, "alpha.rotate"),
                               json_object_get(json, "rotate"), layer);
    return status;
}

/* A description is data: what it names is opened only where the caller says so. */
static lq_status read_ndf(const reader *r, json_t *json, lq_layer *layer) {
    const char *text = json ? json_string_value(json) : "ggx";
    if (!text) return refuse(r, "ndf", "ndf is no text; accepted: an NDF of lacquer list");
    if (strlen(text) >= sizeof layer->ndf)
        return refuse(r, "ndf", "ndf is longer than %zu bytes", sizeof layer->ndf - 1);
    if (!(r->flags & LQ_STACK_TRUSTED) &&
        (strncmp(text, "file:", 5) == 0 || strncmp(text, "plugin:", 7) == 0))
        return refuse(r, "ndf", "NDF '%.100s' is named by a description, which is not trusted to open files",
                      text);
    const lq_ndf *ndf = NULL;
    lq_error cause = {""};
    const lq_status status = lq_ndf_open(&ndf, text, &cause);
    lq_ndf_close(ndf);
    if (status != LQ_OK) return refuse(r, "ndf", "%s", cause.text);
    strcpy(layer->ndf, text);
    return LQ_OK;
}

static lq_status read_parameters(const reader *r, json_t *json, bool in_medium, lq_layer *layer) {
    lq_status status = LQ_OK;
    for (int i = 0; status == LQ_OK && i < LQ_PARAMETERS; i++) {
        const lq_parameter *p = &lq_parameters[i];
        if (!(p->layers >> layer->type & 1) || p->in_medium != in_medium) continue;
        if (strncmp(p->name, "alpha", 5) == 0 || (in_medium && p->by_sigma != layer->medium.by_sigma))
            continue;
        status = read_quantity(r, p->name, p, json_object_get(json, p->name), layer);
    }
    return status;
}

static lq_status read_interface(reader *r, json_t *json, lq_layer *layer) {
    static const char *const accepted[] = {"n, alpha, ndf", "n, kappa, alpha, ndf", "rho"};
    r->object = lq_layer_type_name(layer->type);
    if (!json_is_object(json))
        return refuse(r, NULL, "%s is no object; accepted: {...} with %s", r->object, accepted[layer->type]);
    lq_status status = check_keys(r, json, accepted[layer->type]);
    if (status == LQ_OK) status = read_parameters(r, json, false, layer);
    if (status != LQ_OK || layer->type == LQ_LAYER_LAMBERTIAN) return status;
    status = read_alpha(r, json_object_get(json, "alpha"), layer);
    if (status == LQ_OK) status = read_ndf(r, json_object_get(json, "ndf"), layer);
    for (int c = 0; status == LQ_OK && layer->type == LQ_LAYER_CONDUCTOR && c < LQ_STACK_CHANNELS; c++)
        if (layer->n.value[c] == 0.0 && layer->kappa.value[c] == 0.0)
            status = refuse(r, "n", "n and kappa are both 0; accepted: a kappa > 0 makes a perfect mirror");
    return status;
}

static lq_status read_medium(reader *r, json_t *json, lq_layer *layer) {
    if (!json) return LQ_OK;
    if (layer->type != LQ_LAYER_DIELECTRIC)
        return refuse(r, "medium", "nothing lies below a %s; accepted: a medium below a dielectric",
                      lq_layer_type_name(layer->type));
    r->object = "medium";
    if (!json_is_object(json) || json_object_size(json) == 0)
        return refuse(r, NULL,
                      "medium is empty or no object; accepted: {\"tau\": T} or sigma_a, sigma_s, depth, g");
    layer->medium.by_sigma = !json_object_get(json, "tau");
    const lq_status status =
        check_keys(r, json, layer->medium.by_sigma ? "sigma_a, sigma_s, depth, g" : "tau");
    return status == LQ_OK ? read_parameters(r, json, true, layer) : status;
}

static lq_status read_layer(reader *r, json_t *json, bool last, lq_layer *layer) {
    int found = -1;
    r->object = NULL;
    lq_status status =
        json_is_object(json)
            ? check_keys(r, json, "dielectric, conductor, lambertian, medium")
            : refuse(
                  r, NULL,
                  "no object; accepted: {\"dielectric\": ...}, {\"conductor\": ...}, {\"lambertian\": ...}");
    for (int type = 0; status == LQ_OK && type < 3; type++) {
        if (!json_object_get(json, lq_layer_type_name((lq_layer_type)type))) continue;
        if (found >= 0)
            status = refuse(
                r, NULL, "two interfaces in one layer; accepted: one of dielectric, conductor, lambertian");
        found = type;
    }
    if (status == LQ_OK && found < 0)
        status = refuse(r, NULL, "no interface; accepted: one of dielectric, conductor, lambertian");
    if (status != LQ_OK) return status;
    *layer = lq_layer_default((lq_layer_type)found);
    const char *type = lq_layer_type_name(layer->type);
    if (!last && layer->type != LQ_LAYER_DIELECTRIC)
        return refuse(r, type, "a %s that is not the last layer; accepted: as the last one", type);
    status = read_interface(r, json_object_get(json, type), layer);
    r->object = NULL;
    return status == LQ_OK ? read_medium(r, json_object_get(json, "medium"), layer) : status;
}

/* ======================================================================================
 *                                      The whole
 * ====================================================================================== */

static lq_status read_name(const reader *r, json_t *json, lq_stack *stack) {
    const char *name = json ? json_string_value(json) : "";
    if (!name || strlen(name) >= sizeof stack->name)
        return refuse(r, "name", "name is no text of at most %zu bytes", sizeof stack->name - 1);
    strcpy(stack->name, name);
    return LQ_OK;
}

static lq_status read_layers(reader *r, json_t *list, lq_stack *stack) {
    const size_t count = json_array_size(list);
    if (!json_is_array(list) || count == 0 || count > LQ_MAX_LAYERS)
        return refuse(r, list ? "layers" : NULL,
                      "layers is missing, empty or too long; accepted: a list of 1 to %d", LQ_MAX_LAYERS);
    stack->layers = calloc(count, sizeof *stack->layers);
    if (!stack->layers) return lq_fail(r->error, LQ_NO_MEMORY, "no memory for a stack");
    stack->layer_count = count;
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < count; i++) {
        r->layer = i + 1;
        status = read_layer(r, json_array_get(list, i), i + 1 == count, &stack->layers[i]);
    }
    return status;
}

static lq_status read_stack(reader *r, json_t *root, lq_stack *stack) {
    if (!json_is_object(root)) return refuse(r, NULL, "no object; accepted: {\"layers\": [...]}");
    lq_status status = check_keys(r, root, r->place ? r->place->keys : "name, layers");
    if (status == LQ_OK) status = read_name(r, json_object_get(root, "name"), stack);
    return status == LQ_OK ? read_layers(r, json_object_get(root, "layers"), stack) : status;
}

static lq_status make_stack(reader *r, json_t *json, lq_stack **stack) {
    *stack = calloc(1, sizeof **stack);
    if (!*stack) return lq_fail(r->error, LQ_NO_MEMORY, "no memory for a stack");
    const lq_status status = read_stack(r, json, *stack);
    if (status == LQ_OK) return LQ_OK;
    lq_stack_free(*stack);
    *stack = NULL;
    return status;
}

lq_status lq_stack_from_json(lq_stack **stack, json_t *json, const lq_stack_place *place, unsigned flags,
                             lq_error *error) {
    reader r = {.name = place->name, .text = place->text, .place = place, .flags = flags, .error = error};
    return make_stack(&r, json, stack);
}

lq_status lq_stack_parse(lq_stack **stack, const char *text, const char *name, unsigned flags,
                         lq_error *error) {
    reader r = {.name = name, .text = text, .flags = flags, .error = error};
    *stack = NULL;
    json_t *root;
    lq_status status = lq_json_parse(&root, name, text, strlen(text), error);
    if (status == LQ_OK) status = make_stack(&r, root, stack);
    json_decref(root);
    return status;
}

lq_status lq_stack_read(lq_stack **stack, const char *path, unsigned flags, lq_error *error) {
    char *text;
    size_t size;
    *stack = NULL;
    lq_status status = lq_input_read(path, &text, &size, error);
    if (status != LQ_OK) return status;
    if (strlen(text) != size)
        status = lq_fail(error, LQ_FORMAT, "%s: holds a zero byte; accepted: JSON", path);
    if (status == LQ_OK) status = lq_stack_parse(stack, text, path, flags, error);
    free(text);
    return status;
}
