/* pack.c - a pack as pictures: every function as a renderer gets it, and what its manifest says of it. */
#include "program/view/pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/json.h"
#include "system/status.h"

/* ======================================================================================
 *                                       The manifest
 * ====================================================================================== */

/* Entry `i` of "tables" or "materials". */
static const json_t *entry_of(const json_t *manifest, const char *list, size_t i) {
    return json_array_get(json_object_get(manifest, list), i);
}

static size_t bytes_of(const json_t *entry) {
    const json_int_t bytes = json_integer_value(json_object_get(entry, "bytes"));
    return bytes > 0 ? (size_t)bytes : 0;
}

/* "error p99 0.0012, max 0.0039": what was measured when the pack was made. */
static void describe_error(const json_t *entry, char *text, size_t size) {
    const json_t *error = json_object_get(entry, "error");
    const char *kind = json_string_value(json_object_get(error, "kind"));
    snprintf(
        text, size, "%serror p99 %.2g, max %.2g", kind && strcmp(kind, "relative") == 0 ? "relative " : "",
        json_number_value(json_object_get(error, "p99")), json_number_value(json_object_get(error, "max")));
}

/* ", budget p99 0.002, max 0.01", or nothing. */
static void describe_budget(double p99, double max, char *text, size_t size) {
    text[0] = '\0';
    if (isfinite(p99) && isfinite(max)) snprintf(text, size, ", budget p99 %.2g, max %.2g", p99, max);
    else if (isfinite(p99)) snprintf(text, size, ", budget p99 %.2g", p99);
    else if (isfinite(max)) snprintf(text, size, ", budget max %.2g", max);
}

/* ======================================================================================
 *                                     One of its functions
 * ====================================================================================== */

/* Nodes of an axis that the pack does not tell. */
enum { NODES = 65 };

/* The axes over which factors are drawn: those of their table, or even ones over its box. */
static lq_status make_axes(const lq_shipped *shipped, lq_axis *axes, lq_error *error) {
    const lq_factored *factored = shipped->factored;
    lq_status status = LQ_OK;
    for (int a = 0; status == LQ_OK && a < factored->axis_count; a++) {
        const bool flat = !(factored->axes[a].min < factored->axes[a].max);
        status = shipped->axes[0].size > 0
                     ? lq_axis_copy(&axes[a], &shipped->axes[a], error)
                     : lq_axis_make(&axes[a], factored->axes[a].name, factored->axes[a].min,
                                    factored->axes[a].max, flat ? 1 : NODES, LQ_MAP_LINEAR, 0.0, error);
    }
    return status;
}

/* All axes but two get the one node in their middle: the slice that is drawn. */
static lq_status flatten(lq_axis *axis, lq_error *error) {
    const double middle = axis->nodes[axis->size / 2];
    lq_axis flat;
    const lq_status status = lq_axis_make(&flat, axis->name, middle, middle, 1, LQ_MAP_LINEAR, 0.0, error);
    if (status != LQ_OK) return status;
    lq_axis_free(axis);
    *axis = flat;
    return LQ_OK;
}

/* What a shader gets from factors, as a table over that slice. */
static lq_status decode(const lq_shipped *shipped, lq_table **table, lq_error *error) {
    static const char *const channel = "value";
    lq_axis axes[LQ_MAX_AXES] = {0};
    const int count = shipped->factored->axis_count;
    lq_status status = make_axes(shipped, axes, error);
    for (int a = 0, drawn = 0; status == LQ_OK && a < count; a++)
        if (axes[a].size > 1 && ++drawn > 2) status = flatten(&axes[a], error);
    if (status == LQ_OK) status = lq_table_create(table, axes, count, &channel, 1, error);
    for (int a = 0; a < count; a++) lq_axis_free(&axes[a]);
    for (size_t i = 0; status == LQ_OK && i < lq_table_entries(*table); i++) {
        double x[LQ_MAX_AXES];
        size_t rest = i;
        for (int a = 0; a < count; rest /= (*table)->axes[a].size, a++)
            x[a] = (*table)->axes[a].nodes[rest % (*table)->axes[a].size];
        (*table)->channels[0][i] = (float)lq_factored_lookup_gpu(shipped->factored, x);
    }
    return status;
}

static lq_status add_slices(lq_figure *figure, const lq_table *table, const char *name, const char *note,
                            lq_error *error) {
    lq_status status = LQ_OK;
    double at[LQ_MAX_AXES];
    lq_slice slice = {.table = table, .at = at, .note = note};
    lq_slice_axes(table, &slice.x, &slice.y);
    for (int a = 0; a < table->axis_count; a++) at[a] = table->axes[a].nodes[table->axes[a].size / 2];
    for (int c = 0; status == LQ_OK && slice.x >= 0 && c < table->channel_count; c++) {
        char title[2 * LQ_NAME_SIZE + 4];
        snprintf(title, sizeof title, "%s%s%s", name, table->channel_count > 1 ? " " : "",
                 table->channel_count > 1 ? table->channel_names[c] : "");
        slice.channel = c;
        slice.title = title;
        status = lq_figure_add_slice(figure, &slice, error);
    }
    return status;
}

/* The function's line of the page's list. */
static lq_status tell(lq_figure *figure, const lq_shipped *shipped, size_t bytes, const char *measured,
                      const lq_panel *drawn, lq_error *error) {
    char text[LQ_MESSAGE_SIZE], budget[96];
    const bool changed = shipped->altered + shipped->differing > 0;
    describe_budget(shipped->p99, shipped->max, budget, sizeof budget);
    snprintf(text, sizeof text, "%s%s, %zu bytes, %.3g to %.3g where drawn, %s%s%s%s",
             shipped->kind ? shipped->kind->id : "mapping", shipped->factored ? " in factors" : "", bytes,
             drawn->low, drawn->high, measured, budget, changed ? "; NOT AS IT WAS MADE: " : "",
             changed ? shipped->suspect : "");
    return lq_figure_tell(figure, shipped->name, text, error);
}

static lq_status add(lq_figure *figure, const lq_shipped *shipped, const json_t *entry, lq_error *error) {
    const size_t first = figure->panel_count;
    char measured[128];
    lq_table *decoded = NULL;
    describe_error(entry, measured, sizeof measured);
    lq_status status = shipped->factored ? decode(shipped, &decoded, error) : LQ_OK;
    if (status == LQ_OK)
        status = add_slices(figure, decoded ? decoded : shipped->table, shipped->name, measured, error);
    if (status == LQ_OK && figure->panel_count > first)
        status = tell(figure, shipped, bytes_of(entry), measured, &figure->panels[first], error);
    lq_table_free(decoded);
    return status;
}

static lq_status add_material(lq_figure *figure, const lq_shipped_material *shipped, const json_t *entry,
                              lq_error *error) {
    char measured[128], budget[96], text[LQ_MESSAGE_SIZE];
    describe_error(entry, measured, sizeof measured);
    describe_budget(shipped->lobes.p99, shipped->lobes.max, budget, sizeof budget);
    snprintf(text, sizeof text, "material, %zu bytes, %s%s", bytes_of(entry), measured, budget);
    const lq_status status = lq_figure_tell(figure, shipped->name, text, error);
    return status == LQ_OK ? view_add_material(figure, shipped, measured, error) : status;
}

/* An atlas, which holds the textures of all. */
static lq_status check_atlas(lq_figure *figure, const lq_shipped *atlas, lq_error *error) {
    char text[256];
    if (atlas->altered + atlas->differing == 0) return LQ_OK;
    snprintf(text, sizeof text, "NOT AS IT WAS MADE: %s", atlas->suspect);
    return lq_figure_tell(figure, "atlas", text, error);
}

/* ======================================================================================
 *                                         The pack
 * ====================================================================================== */

static lq_status start(const lq_pack *pack, const char *folder, lq_figure **figure, lq_error *error) {
    char text[LQ_MESSAGE_SIZE], materials[48] = "";
    const json_int_t bytes = json_integer_value(json_object_get(pack->manifest, "texture-bytes"));
    if (pack->material_count > 0)
        snprintf(materials, sizeof materials, "%zu material%s, ", pack->material_count,
                 pack->material_count == 1 ? "" : "s");
    snprintf(text, sizeof text, "%s%zu function%s, %lld bytes of textures · %.300s", materials, pack->count,
             pack->count == 1 ? "" : "s", (long long)bytes, folder);
    return lq_figure_create(figure, pack->name, text, error);
}

/* All that it holds; then, where asked for, what functions are made of. */
static lq_status fill(lq_figure *figure, const lq_pack *pack, bool factors, lq_error *error) {
    lq_status status = check_atlas(figure, &pack->atlas, error);
    for (size_t i = 0; status == LQ_OK && i < pack->material_count; i++)
        status = add_material(figure, &pack->materials[i], entry_of(pack->manifest, "materials", i), error);
    for (size_t i = 0; status == LQ_OK && i < pack->count; i++)
        status = add(figure, &pack->tables[i], entry_of(pack->manifest, "tables", i), error);
    for (size_t i = 0; status == LQ_OK && factors && i < pack->count; i++)
        if (pack->tables[i].factored)
            status = view_add_factors(figure, pack->tables[i].factored, pack->tables[i].name, error);
    return status;
}

lq_status view_pack(const char *folder, bool factors, lq_figure **figure, lq_error *error) {
    lq_pack pack = {0};
    lq_status status = lq_pack_read(&pack, folder, error);
    if (status != LQ_OK) return status;
    status = start(&pack, folder, figure, error);
    if (status == LQ_OK) status = fill(*figure, &pack, factors, error);
    lq_pack_free(&pack);
    return status;
}
