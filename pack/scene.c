/* scene.c - reads the materials of a scene, each a named stack, and says with the line what is wrong. */
#include "pack/scene.h"

#include <stdlib.h>
#include <string.h>

#include "stack/locate.h"
#include "stack/reader.h"
#include "system/status.h"
#include "tables/axis.h"

static const char keys[] = "name, source, layers";

static int line_of(const lq_recipe_reader *r, size_t index, const char *key) {
    const lq_json_step steps[] = {{.key = "materials"}, {.index = index}, {.key = key}};
    return lq_json_line(r->text, steps, key ? 3 : 2);
}

static lq_status refuse(const lq_recipe_reader *r, size_t index, const char *key, const char *text) {
    return lq_fail(r->error, LQ_BAD_INPUT, "%s:%d: %s", r->path, line_of(r, index, key), text);
}

static lq_status check_name(const lq_recipe_reader *r, size_t index, const char *name) {
    lq_error why = {""};
    if (!name || !*name)
        return refuse(r, index, NULL,
                      "a material without a name; accepted: \"name\", which its function gets");
    if (lq_name_check("name", name, &why) != LQ_OK) return refuse(r, index, "name", why.text);
    for (size_t i = 0; i < index; i++)
        if (strcmp(r->recipe->materials[i].name, name) == 0)
            return lq_fail(r->error, LQ_BAD_INPUT,
                           "%s:%d: a second material '%s'; accepted: one of each name", r->path,
                           line_of(r, index, "name"), name);
    return LQ_OK;
}

static lq_status read_source(const lq_recipe_reader *r, size_t index, json_t *source, char **text) {
    if (!source) return LQ_OK;
    if (!json_is_string(source)) return refuse(r, index, "source", "'source' is no text");
    *text = strdup(json_string_value(source));
    return *text ? LQ_OK : lq_fail(r->error, LQ_NO_MEMORY, "%s: out of memory", r->path);
}

static lq_status read_material(const lq_recipe_reader *r, json_t *item, size_t index) {
    lq_recipe_material *m = &r->recipe->materials[index];
    const lq_stack_place place = {r->path, r->text, "materials", index, keys};
    lq_error why = {""};
    if (!json_is_object(item))
        return refuse(r, index, NULL, "a material is written {\"name\": \"gold\", \"layers\": [...]}");
    lq_status status = lq_stack_from_json(&m->stack, item, &place, LQ_STACK_RANGES, r->error);
    if (status != LQ_OK) return status;
    r->recipe->material_count++;
    m->line = line_of(r, index, NULL);
    status = check_name(r, index, json_string_value(json_object_get(item, "name")));
    if (status == LQ_OK) status = read_source(r, index, json_object_get(item, "source"), &m->source);
    if (status != LQ_OK) return status;
    snprintf(m->name, sizeof m->name, "%.31s", m->stack->name); /* as checked */
    status = lq_material_describe(&m->material, m->stack, &why);
    return status == LQ_OK ? LQ_OK : refuse(r, index, "layers", why.text);
}

lq_status lq_scene_read(const lq_recipe_reader *r, json_t *materials) {
    if (!materials) return LQ_OK;
    const size_t count = json_array_size(materials);
    if (!json_is_array(materials) || count == 0 || count > LQ_RECIPE_MATERIALS)
        return lq_refuse_value(r, "materials", "a list of 1 to 64 materials");
    lq_status status = LQ_OK;
    for (size_t i = 0; i < count && status == LQ_OK; i++)
        status = read_material(r, json_array_get(materials, i), i);
    return status;
}

void lq_scene_free(lq_recipe_material *material) {
    lq_stack_free(material->stack);
    free(material->source);
    *material = (lq_recipe_material){0};
}
