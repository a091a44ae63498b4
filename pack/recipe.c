/* recipe.c - reads a recipe and says, with the line, what is wrong in it. */
#include "pack/recipe.h"

#include "pack/mapping.h"
#include "pack/names.h"
#include "pack/recipe_text.h"
#include "pack/scene.h"
#include "pack/texture.h"
#include "system/input.h"
#include "system/json.h"
#include "system/status.h"
#include "tables/axis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 2000, LEAST_POINTS = 100, MOST_POINTS = 1000000 };

static const char root_keys[] =
    "name, about, ndf, formats, atlas, budget, points, max-bytes, tables, materials";
static const char table_keys[] =
    "table, mapping, name, axes, ndf, tolerance, scattering, masking, budget, points, layouts, fit, pca";
static const char budget_keys[] = "p99, max";

static lq_status read_budget(const lq_recipe_reader *r, json_t *object, double *p99, double *max) {
    json_t *budget = json_object_get(object, "budget");
    if (!budget) return LQ_OK;
    if (!json_is_object(budget)) return lq_refuse_value(r, "budget", "{\"p99\": E, \"max\": E}");
    lq_status status = lq_recipe_keys(r, budget, budget_keys);
    /* Stored halves alone are off by 2^-12 of values up to 1: less cannot be reached. */
    const double least = 0x1p-12;
    if (status == LQ_OK) status = lq_recipe_number(r, budget, "p99", least, 1.0, p99);
    if (status == LQ_OK) status = lq_recipe_number(r, budget, "max", least, 1.0, max);
    return status;
}

static lq_status read_formats(const lq_recipe_reader *r, json_t *formats) {
    char accepted[128] = "";
    for (int c = 0; c < LQ_CONTAINERS; c++)
        snprintf(accepted + strlen(accepted), sizeof accepted - strlen(accepted), "%s%s", c > 0 ? ", " : "",
                 lq_container_name((lq_container)c));
    if (!formats) return lq_refuse(r, NULL, "no 'formats'; accepted: a list such as [\"ktx2\", \"dds\"]");
    if (!json_is_array(formats) || json_array_size(formats) == 0)
        return lq_refuse_value(r, "formats", accepted);
    for (size_t i = 0; i < json_array_size(formats); i++) {
        const char *word = json_string_value(json_array_get(formats, i));
        if (!word) return lq_refuse_value(r, "formats", accepted);
        bool known = false;
        for (int c = 0; c < LQ_CONTAINERS; c++)
            if (strcmp(word, lq_container_name((lq_container)c)) == 0)
                r->recipe->containers[c] = known = true;
        if (!known) return lq_refuse_word(r, "format", word, accepted);
    }
    return LQ_OK;
}

static lq_status read_layouts(const lq_recipe_reader *r, json_t *layouts, lq_recipe_table *table) {
    if (!layouts) return LQ_OK;
    if (!json_is_array(layouts)) return lq_refuse_value(r, "layouts", "[\"belcour\", \"tm\"]");
    for (size_t i = 0; i < json_array_size(layouts); i++) {
        const char *word = json_string_value(json_array_get(layouts, i));
        const char *masking = table->settings.masking == LQ_SEPARABLE ? "separable" : "correlated";
        lq_error why = {""};
        if (!word) return lq_refuse_value(r, "layouts", "belcour, tm");
        const int layout = strcmp(word, "belcour") == 0 ? LQ_BELCOUR : strcmp(word, "tm") == 0 ? LQ_TM : -1;
        if (layout < 0) return lq_refuse_word(r, "layout", word, "belcour, tm");
        if (lq_published_check((lq_layout)layout, table->kind->id,
                               table->kind->takes & LQ_TAKES_MASKING ? masking : NULL, table->axes,
                               table->kind->axis_count, &why) != LQ_OK)
            return lq_refuse(r, word, why.text);
        table->layouts[layout] = 1;
    }
    return LQ_OK;
}

/* -------------------------------------------------------------------------------------- axes */

static lq_status read_axis(const lq_recipe_reader *r, const char *name, json_t *value,
                           lq_recipe_table *table) {
    char accepted[LQ_MESSAGE_SIZE] = "";
    lq_error why = {""};
    lq_axis axis;
    for (int a = 0; a < table->kind->axis_count; a++) {
        const lq_axis_info *info = &table->kind->axes[a];
        if (strcmp(info->name, name) == 0) {
            if (!json_is_string(value)) return lq_refuse_value(r, name, "\"min:max:n\" or \"min:max:n:map\"");
            if (lq_axis_parse_within(&axis, name, json_string_value(value), LQ_TEXTURE_LARGEST, &why) !=
                LQ_OK)
                return lq_refuse(r, name, why.text);
            lq_axis_free(&table->axes[a]);
            table->axes[a] = axis;
            if (axis.min >= info->lowest && axis.max <= info->highest) return LQ_OK;
            return lq_fail(r->error, LQ_BAD_INPUT, "%s:%d: %s from %g to %g; accepted: %g to %g", r->path,
                           lq_recipe_line(r, name), name, axis.min, axis.max, info->lowest, info->highest);
        }
        snprintf(accepted + strlen(accepted), sizeof accepted - strlen(accepted), "%s%s", a > 0 ? ", " : "",
                 info->name);
    }
    return lq_refuse_word(r, "axis", name, accepted);
}

static lq_status read_axes(const lq_recipe_reader *r, json_t *axes, lq_recipe_table *table) {
    const char *name;
    json_t *value;
    lq_error why = {""};
    const lq_status made = lq_is_mapping(table->kind)
                               ? lq_kind_axes(table->kind, table->axes, &why)
                               : lq_settings_axes(table->kind, &table->settings, table->axes, &why);
    if (made != LQ_OK) return lq_refuse(r, NULL, why.text);
    if (axes && !json_is_object(axes)) return lq_refuse_value(r, "axes", "{\"mu\": \"0:1:32:sqrt\", ...}");
    json_object_foreach(axes, name, value) {
        lq_status status = read_axis(r, name, value, table);
        if (status != LQ_OK) return status;
    }
    if (!table->factored && lq_texture_check(table->name, table->axes, table->kind->axis_count,
                                             table->kind->channel_count, &why) != LQ_OK)
        return lq_refuse(r, axes ? "axes" : NULL, why.text);
    return LQ_OK;
}

/* ------------------------------------------------------------------------------------ tables */

static lq_status read_kind(const lq_recipe_reader *r, json_t *item, lq_recipe_table *table) {
    const char *id = json_string_value(json_object_get(item, "table"));
    const char *mapping = json_string_value(json_object_get(item, "mapping"));
    lq_error why = {""};
    if ((id != NULL) == (mapping != NULL))
        return lq_refuse(r, NULL,
                         "accepted: either a 'table', an id of lacquer list, or a 'mapping': f, "
                         "f-inverse, sigma-g");
    table->kind = id ? lq_kind_find(id, &why) : lq_mapping_find(mapping, &why);
    if (!id) id = mapping;
    if (!table->kind) return lq_refuse(r, id, why.text);
    const char *name = json_string_value(json_object_get(item, "name"));
    if (name && lq_name_check("name", name, &why) != LQ_OK) return lq_refuse(r, "name", why.text);
    snprintf(table->name, sizeof table->name, "%s", name ? name : id);
    for (const lq_recipe_table *other = r->recipe->tables; other < table; other++)
        if (strcmp(other->name, table->name) == 0)
            return lq_refuse_word(r, "second table", table->name, "one of each name; set \"name\"");
    return LQ_OK;
}

/* "ndf" of the recipe or of a table, as NDFs write themselves; `text` stays NULL where there is none. */
static lq_status read_ndf(const lq_recipe_reader *r, json_t *object, char **text) {
    json_t *item = json_object_get(object, "ndf");
    const char *said = json_string_value(item), *trusted = NULL;
    const lq_ndf *ndf = NULL;
    lq_error why = {""};
    if (!item) return LQ_OK;
    if (!said) return lq_refuse_value(r, "ndf", "\"ggx\" and others of lacquer list");
    lq_status status = lq_ndf_trusted(said, r->trust, &trusted, &why);
    if (status == LQ_OK) status = lq_ndf_open(&ndf, trusted, &why);
    if (status != LQ_OK)
        return lq_fail(r->error, status, "%s:%d: %s", r->path, lq_recipe_line(r, said), why.text);
    *text = strdup(lq_ndf_text(ndf));
    lq_ndf_close(ndf);
    return *text ? LQ_OK : lq_fail(r->error, LQ_NO_MEMORY, "%s: out of memory", r->path);
}

static lq_status read_settings(const lq_recipe_reader *r, json_t *item, lq_recipe_table *table) {
    const lq_kind *kind = table->kind;
    static const char *const scatterings[] = {"single", "multiple", NULL}, *const maskings[] = {"correlated",
                                                                                                "separable",
                                                                                                NULL};
    int scattering = LQ_MULTIPLE, masking = LQ_CORRELATED;
    table->settings = lq_settings_default();
    table->settings.tolerance = kind->tolerance;
    lq_status status = read_ndf(r, item, &table->ndf);
    if (status != LQ_OK) return status;
    table->settings.ndf = table->ndf ? table->ndf : r->recipe->ndf ? r->recipe->ndf : "ggx";
    status = lq_recipe_number(r, item, "tolerance", kind->finest_tolerance, LQ_LOOSEST_TOLERANCE,
                              &table->settings.tolerance);
    if (status == LQ_OK) status = lq_recipe_choice(r, item, "scattering", scatterings, &scattering);
    if (status == LQ_OK) status = lq_recipe_choice(r, item, "masking", maskings, &masking);
    if (status != LQ_OK) return status;
    if (json_object_get(item, "scattering") && !(kind->takes & LQ_TAKES_SCATTERING))
        return lq_refuse(r, "scattering", "this table takes no 'scattering'; leave it out");
    if (json_object_get(item, "masking") && !(kind->takes & LQ_TAKES_MASKING))
        return lq_refuse(r, "masking", "this table takes no 'masking'; leave it out");
    table->settings.scattering = (lq_scattering)scattering;
    table->settings.masking = (lq_masking)masking;
    return LQ_OK;
}

static lq_status read_fit(const lq_recipe_reader *r, json_t *item, lq_recipe_table *table) {
    json_t *fit = json_object_get(item, "fit");
    if (fit && !json_is_boolean(fit)) return lq_refuse_value(r, "fit", "true or false");
    table->fit = json_is_true(fit);
    if (table->fit && (table->factored || lq_is_mapping(table->kind)))
        return lq_refuse(r, "fit",
                         "'fit' is for a table in one texture; leave it out of factors and mappings");
    if (table->fit && json_object_get(item, "layouts"))
        return lq_refuse(r, "fit",
                         "'layouts' hold values at nodes, which a 'fit' changes; accepted: one of the two");
    return LQ_OK;
}

static lq_status read_table(const lq_recipe_reader *r, json_t *item, const double *budget, size_t points) {
    lq_recipe_table *table = &r->recipe->tables[r->recipe->count];
    if (!json_is_object(item)) return lq_refuse(r, "tables", "a table is written {\"table\": \"dfg\", ...}");
    table->p99 = budget[0];
    table->max = budget[1];
    table->points = points;
    table->line = lq_recipe_line(r, NULL);
    lq_status status = lq_recipe_keys(r, item, table_keys);
    if (status == LQ_OK) status = read_kind(r, item, table);
    if (status == LQ_OK) r->recipe->count++;
    if (status == LQ_OK) status = read_settings(r, item, table);
    json_t *pca = json_object_get(item, "pca");
    table->factored = pca != NULL;
    if (status == LQ_OK) status = read_axes(r, json_object_get(item, "axes"), table);
    if (status == LQ_OK && pca) status = lq_recipe_read_pca(r, pca, table);
    if (status == LQ_OK) status = read_fit(r, item, table);
    if (status == LQ_OK) status = read_layouts(r, json_object_get(item, "layouts"), table);
    if (status == LQ_OK) status = read_budget(r, item, &table->p99, &table->max);
    if (status == LQ_OK)
        status = lq_recipe_count(r, item, "points", LEAST_POINTS, MOST_POINTS, &table->points);
    if (table->pca_budget > 0.0 && table->pca_norm == LQ_PCA_MAX)
        table->max = fmin(table->max, table->pca_budget);
    if (table->pca_budget > 0.0 && table->pca_norm == LQ_PCA_P99)
        table->p99 = fmin(table->p99, table->pca_budget);
    return status;
}

static lq_status check_names(lq_recipe_reader *r) {
    lq_error why = {""};
    size_t culprit = 0;
    if (lq_names_check(r->recipe, &culprit, &why) == LQ_OK) return LQ_OK;
    if (culprit >= r->recipe->count)
        return lq_fail(r->error, LQ_BAD_INPUT, "%s:%d: %s", r->path,
                       r->recipe->materials[culprit - r->recipe->count].line, why.text);
    r->entry = (int)culprit;
    return lq_refuse(r, r->recipe->tables[culprit].name, why.text);
}

/* Lobes are normalised by the albedo of a single bounce, over mu and alpha: a scene that has none gets one.
 */
static bool has_albedo(const lq_recipe *recipe, bool *name_taken) {
    bool has = false;
    *name_taken = false;
    for (size_t i = 0; i < recipe->count; i++) {
        const lq_recipe_table *table = &recipe->tables[i];
        *name_taken = *name_taken || strcmp(table->name, "albedo") == 0;
        if (table->factored || strcmp(table->kind->id, "albedo") != 0) continue;
        has = has || (table->axes[0].size > 1 && table->axes[1].size > 1);
    }
    return has;
}

static lq_status add_albedo(lq_recipe_reader *r, const double *budget, size_t points) {
    bool taken;
    if (r->recipe->material_count == 0 || has_albedo(r->recipe, &taken)) return LQ_OK;
    json_t *item = json_pack("{s:s, s:s, s:f, s:b, s:{s:s, s:s}}", "table", "albedo", "name",
                             taken ? "lobe-albedo" : "albedo", "tolerance", 1e-4, "fit", 1, "axes", "mu",
                             "0:1:20:sqrt", "alpha", "0:1:16:sqrt");
    if (!item) return lq_fail(r->error, LQ_NO_MEMORY, "%s: out of memory", r->path);
    const lq_status status = read_table(r, item, budget, points);
    json_decref(item);
    return status;
}

/* One place is kept for the albedo. */
static lq_status read_tables(lq_recipe_reader *r, json_t *tables, const double *budget, size_t points) {
    lq_status status = LQ_OK;
    const bool scene = r->recipe->material_count > 0;
    if ((tables || !scene) && (!json_is_array(tables) || json_array_size(tables) == 0 ||
                               json_array_size(tables) > LQ_RECIPE_TABLES - (size_t)scene))
        return lq_refuse_value(r, "tables", scene ? "a list of 1 to 31 tables" : "a list of 1 to 32 tables");
    for (size_t i = 0; i < json_array_size(tables) && status == LQ_OK; i++) {
        r->entry = (int)i;
        status = read_table(r, json_array_get(tables, i), budget, points);
    }
    if (status == LQ_OK) status = add_albedo(r, budget, points);
    return status == LQ_OK ? check_names(r) : status;
}

/* A scene has its textures in one unless it says otherwise; its materials are nowhere else. */
static lq_status read_materials(lq_recipe_reader *r, json_t *root, const double *budget, size_t points) {
    json_t *materials = json_object_get(root, "materials"), *atlas = json_object_get(root, "atlas");
    if (atlas && !json_is_boolean(atlas)) return lq_refuse_value(r, "atlas", "true or false");
    r->recipe->atlas = atlas ? json_is_true(atlas) : materials != NULL;
    if (materials && !r->recipe->atlas)
        return lq_refuse_value(r, "atlas", "true, where there are materials: their texels are in the atlas");
    r->recipe->p99 = budget[0];
    r->recipe->max = budget[1];
    r->recipe->points = points;
    return lq_scene_read(r, materials);
}

static lq_status read_root(lq_recipe_reader *r, json_t *root) {
    double budget[2] = {INFINITY, INFINITY}, bytes = 0.0;
    size_t points = POINTS;
    if (!json_is_object(root)) return lq_refuse(r, NULL, "not a recipe; accepted is a JSON object");
    const char *name = json_string_value(json_object_get(root, "name"));
    lq_status status = lq_recipe_keys(r, root, root_keys);
    if (status != LQ_OK) return status;
    if (!name || lq_name_check("name", name, r->error) != LQ_OK)
        return lq_refuse(r, "name", "'name' is missing or no name; accepted: letters, digits, '_', '-', '.'");
    snprintf(r->recipe->name, LQ_NAME_SIZE, "%s", name);
    status = read_formats(r, json_object_get(root, "formats"));
    if (status == LQ_OK) status = read_ndf(r, root, &r->recipe->ndf);
    if (status == LQ_OK) status = read_budget(r, root, &budget[0], &budget[1]);
    if (status == LQ_OK) status = lq_recipe_count(r, root, "points", LEAST_POINTS, MOST_POINTS, &points);
    if (status == LQ_OK) status = lq_recipe_number(r, root, "max-bytes", 1.0, 1e12, &bytes);
    if (status != LQ_OK) return status;
    r->recipe->max_bytes = (size_t)bytes;
    status = read_materials(r, root, budget, points);
    return status == LQ_OK ? read_tables(r, json_object_get(root, "tables"), budget, points) : status;
}

lq_status lq_recipe_read(lq_recipe *recipe, const char *path, const lq_trust *trust, lq_error *error) {
    char *text;
    size_t size;
    *recipe = (lq_recipe){0};
    lq_status status = lq_input_read(path, &text, &size, error);
    if (status != LQ_OK) return status;
    lq_recipe_reader r = {path, text, LQ_RECIPE_WHOLE, recipe, error, trust};
    json_t *root;
    status = lq_json_parse(&root, path, text, size, error);
    if (status == LQ_OK) status = read_root(&r, root);
    json_decref(root);
    free(text);
    if (status != LQ_OK) lq_recipe_free(recipe);
    return status;
}

void lq_recipe_free(lq_recipe *recipe) {
    for (size_t i = 0; i < recipe->count; i++) {
        for (int a = 0; a < recipe->tables[i].kind->axis_count; a++) lq_axis_free(&recipe->tables[i].axes[a]);
        free(recipe->tables[i].ndf);
    }
    for (size_t i = 0; i < recipe->material_count; i++) lq_scene_free(&recipe->materials[i]);
    free(recipe->ndf);
    *recipe = (lq_recipe){0};
}
