/* layered_set.c - reads a set of stacks, on the one reader of stacks. */
#include "validate/layered_set.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stack/reader.h"
#include "system/input.h"
#include "system/number.h"
#include "system/status.h"

static const char keys[] = "name, category, over, layers";

typedef struct reader {
    lq_layered_set *set;
    const char *path;
    char *text;
    lq_error *error;
} reader;

static lq_status refuse(const reader *r, const char *what) {
    return lq_fail(r->error, LQ_BAD_INPUT, "%.200s: %s", r->path, what);
}

/* A name of files: letters, digits, - and _. */
static bool is_name(const char *text) {
    return text && *text &&
           strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") == strlen(text);
}

static lq_status copy_name(const reader *r, json_t *from, const char *what, char *to, size_t size) {
    const char *text = json_string_value(from);
    if (!is_name(text) || strlen(text) >= size)
        return lq_fail(r->error, LQ_BAD_INPUT, "%.200s: '%s' is accepted as 1 to %zu letters, digits, - or _",
                       r->path, what, size - 1);
    memcpy(to, text, strlen(text) + 1);
    return LQ_OK;
}

static lq_status read_thetas(const reader *r, json_t *list) {
    const size_t count = json_array_size(list);
    if (count < 1 || count > LQ_LAYERED_THETAS)
        return refuse(r, "'theta' is accepted as a list of 1 to 16 angles of incidence in degrees");
    for (size_t i = 0; i < count; i++) {
        json_t *item = json_array_get(list, i);
        r->set->theta[i] = json_number_value(item);
        if (!json_is_number(item) || !(r->set->theta[i] >= 0.0 && r->set->theta[i] < 90.0))
            return refuse(r, "'theta' holds what is no angle; accepted: 0 <= theta < 90, degrees");
    }
    r->set->theta_count = count;
    return LQ_OK;
}

/* ======================================================================================
 *                                       Stacks
 * ====================================================================================== */

static lq_status add(const reader *r, const lq_layered_stack *made) {
    lq_layered_set *set = r->set;
    for (size_t i = 0; i < set->count; i++)
        if (strcmp(set->stacks[i].stack->name, made->stack->name) == 0)
            return refuse(r, "two stacks have the same name; accepted: one of each");
    if (set->count == LQ_LAYERED_MAX) return refuse(r, "more than 1000 stacks");
    lq_layered_stack *stacks = realloc(set->stacks, (set->count + 1) * sizeof *stacks);
    if (!stacks) return lq_fail(r->error, LQ_NO_MEMORY, "%.200s: out of memory", r->path);
    set->stacks = stacks;
    lq_layered_stack *to = &stacks[set->count];
    *to = *made;
    const lq_status status = lq_stack_copy(&to->stack, made->stack, r->error);
    set->count += status == LQ_OK;
    return status;
}

static lq_status set_value(const reader *r, lq_layered_stack *made, const char *path, json_t *value,
                           size_t length) {
    char *name = made->stack->name;
    lq_error why = {""};
    if (!json_is_number(value)) return refuse(r, "'over' is accepted as {\"top.alpha\": [0.1, 0.5], ...}");
    lq_print(name + length, LQ_STACK_NAME_SIZE - length, "-%g", json_number_value(value));
    if (lq_stack_set(made->stack, path, json_number_value(value), &why) == LQ_OK) return LQ_OK;
    return lq_fail(r->error, LQ_BAD_INPUT, "%.200s: %.64s: %.200s", r->path, made->base, why.text);
}

/* Every combination from parameter `at` of `over` on; the first varies slowest. */
static lq_status combine(const reader *r, lq_layered_stack *made, json_t *over, void *at, bool first) {
    if (!at) return add(r, made);
    json_t *values = json_object_iter_value(at);
    const size_t length = strlen(made->stack->name);
    lq_status status =
        json_array_size(values) > 0 ? LQ_OK : refuse(r, "'over' holds what is no list of values");
    for (size_t i = 0; status == LQ_OK && i < json_array_size(values); i++) {
        json_t *value = json_array_get(values, i);
        if (first) made->first = json_number_value(value);
        status = set_value(r, made, json_object_iter_key(at), value, length);
        if (status == LQ_OK) status = combine(r, made, over, json_object_iter_next(over, at), false);
    }
    made->stack->name[length] = '\0';
    return status;
}

static lq_status read_stack(const reader *r, json_t *item, size_t index) {
    const lq_stack_place place = {r->path, r->text, "stacks", index, keys};
    lq_layered_stack made = {.stack = NULL};
    if (!json_is_object(item)) return refuse(r, "'stacks' holds what is no stack");
    lq_status status = lq_stack_from_json(&made.stack, item, &place, 0, r->error);
    if (status == LQ_OK)
        status = copy_name(r, json_object_get(item, "name"), "name", made.base, sizeof made.base - 40);
    if (status == LQ_OK)
        status =
            copy_name(r, json_object_get(item, "category"), "category", made.category, sizeof made.category);
    json_t *over = json_object_get(item, "over");
    if (status == LQ_OK && over && !json_is_object(over)) status = refuse(r, "'over' is no object");
    if (status == LQ_OK) status = combine(r, &made, over, over ? json_object_iter(over) : NULL, true);
    lq_stack_free(made.stack);
    return status;
}

/* ======================================================================================
 *                                      The file
 * ====================================================================================== */

static lq_status check_keys(const reader *r, json_t *root) {
    const char *key;
    json_t *value;
    if (!json_is_object(root)) return refuse(r, "a set of stacks is accepted as an object");
    json_object_foreach(root, key, value) {
        if (strcmp(key, "name") && strcmp(key, "about") && strcmp(key, "theta") && strcmp(key, "stacks"))
            return lq_fail(r->error, LQ_BAD_INPUT,
                           "%.200s: unknown key '%.40s'; accepted: name, about, theta, stacks", r->path, key);
    }
    return LQ_OK;
}

static lq_status read_root(const reader *r, json_t *root) {
    json_t *stacks = json_object_get(root, "stacks");
    lq_status status = check_keys(r, root);
    if (status == LQ_OK)
        status = copy_name(r, json_object_get(root, "name"), "name", r->set->name, sizeof r->set->name);
    if (status == LQ_OK) status = read_thetas(r, json_object_get(root, "theta"));
    if (status == LQ_OK && json_array_size(stacks) < 1) status = refuse(r, "no 'stacks'");
    for (size_t i = 0; status == LQ_OK && i < json_array_size(stacks); i++)
        status = read_stack(r, json_array_get(stacks, i), i);
    return status;
}

lq_status lq_layered_set_read(lq_layered_set *set, const char *path, lq_error *error) {
    reader r = {set, path, NULL, error};
    json_t *root = NULL;
    size_t size = 0;
    *set = (lq_layered_set){.count = 0};
    lq_status status = lq_input_read(path, &r.text, &size, error);
    if (status == LQ_OK) status = lq_json_parse(&root, path, r.text, size, error);
    if (status == LQ_OK) status = read_root(&r, root);
    json_decref(root);
    free(r.text);
    return status;
}

void lq_layered_set_free(lq_layered_set *set) {
    for (size_t i = 0; i < set->count; i++) lq_stack_free(set->stacks[i].stack);
    free(set->stacks);
    *set = (lq_layered_set){.count = 0};
}
