/* read.c - a pack from its folder. */
#include "pack/read.h"

#include "pack/contents.h"
#include "pack/mapping.h"
#include "pca/factors.h"
#include "pca/factors_json.h"
#include "system/status.h"
#include "tables/axis.h"
#include "tables/exr_layout.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is being read. */
typedef struct reader {
    const char *folder;
    lq_error *error;
} reader;

static lq_status refuse(const reader *r, const char *table, const char *what) {
    return lq_fail(r->error, LQ_FORMAT, "%s/" LQ_MANIFEST ": %s%s%s", r->folder, table, *table ? ": " : "",
                   what);
}

/* -------------------------------------------------------------------------------------- files */

/* The container of a file by what its name ends in, the longest ending first; LQ_CONTAINERS: none. */
static lq_container container_of(const char *file) {
    lq_container found = LQ_CONTAINERS;
    size_t longest = 0;
    for (int c = 0; c < LQ_CONTAINERS; c++) {
        const char *ending = lq_container_ending((lq_container)c);
        const size_t length = strlen(ending), whole = strlen(file);
        if (length <= longest || whole < length || strcmp(file + whole - length, ending) != 0) continue;
        found = (lq_container)c;
        longest = length;
    }
    return found;
}

static size_t count_differing(const lq_image *a, const lq_image *b) {
    const size_t channels = (size_t)a->channels;
    size_t count = 0;
    for (size_t i = 0; i < lq_image_texels(a); i++)
        count += memcmp(a->data + i * channels, b->data + i * channels, channels * sizeof *a->data) != 0;
    return count;
}

static bool is_altered(json_t *checksum, const char *folder, const char *file) {
    char text[9];
    return json_is_string(checksum) && lq_contents_checksum(folder, file, text) &&
           strcmp(text, json_string_value(checksum)) != 0;
}

/* All files of one image into `image`, whose sizes are set. */
static lq_status read_files(const reader *r, json_t *files, lq_image *image, lq_shipped *s) {
    size_t before = 0;
    json_t *item;
    size_t i;
    lq_image other;
    lq_status status = lq_image_create(&other, image->width, image->height, image->depth, image->layers,
                                       image->channels, r->error);
    other.array = image->array;
    json_array_foreach(files, i, item) {
        const char *file = json_string_value(json_object_get(item, "file"));
        const lq_container container = file ? container_of(file) : LQ_CONTAINERS;
        char path[4096];
        if (status != LQ_OK || container == LQ_CONTAINERS) continue;
        if (strchr(file, '/')) status = refuse(r, s->name, "a file outside of the folder");
        snprintf(path, sizeof path, "%s/%s", r->folder, file);
        if (status == LQ_OK) status = lq_image_read(before ? &other : image, container, path, r->error);
        const size_t differing = status == LQ_OK && before ? count_differing(image, &other) : 0;
        const bool altered = status == LQ_OK && is_altered(json_object_get(item, "crc32"), r->folder, file);
        if ((differing || altered) && !*s->suspect) snprintf(s->suspect, sizeof s->suspect, "%s", file);
        s->differing += differing;
        s->altered += altered;
        before++;
    }
    lq_image_free(&other);
    s->files += before;
    if (status == LQ_OK && before == 0) status = refuse(r, s->name, "no file of a known container");
    return status;
}

/* ------------------------------------------------------------------------------------ factors */

static lq_status read_factor(const reader *r, json_t *item, lq_factor *factor, lq_shipped *s) {
    const size_t width = factor->axes[0].texels.size, texels = lq_factor_texels(factor);
    lq_image image;
    lq_status status =
        lq_image_create(&image, width, texels / width, 1, (factor->base_count + 3) / 4, 4, r->error);
    image.array = true;
    if (status == LQ_OK) status = read_files(r, json_object_get(item, "files"), &image, s);
    for (size_t b = 0; status == LQ_OK && b < factor->base_count; b++)
        for (size_t i = 0; i < texels; i++)
            factor->data[b * texels + i] = image.data[(b / 4 * texels + i) * 4 + b % 4];
    lq_image_free(&image);
    return status;
}

static lq_status read_factored(const reader *r, json_t *item, lq_shipped *s) {
    json_t *textures = json_object_get(item, "textures");
    const char *structure = json_string_value(json_object_get(item, "structure"));
    size_t next = 0;
    s->factored = calloc(1, sizeof *s->factored);
    if (!s->factored) return lq_fail(r->error, LQ_NO_MEMORY, "%s: out of memory", s->name);
    if (!structure) return refuse(r, s->name, "no 'structure'; made by an earlier lacquer?");
    lq_error cause = {""};
    if (lq_factored_from_json(structure, s->factored, &cause) != LQ_OK) return refuse(r, s->name, cause.text);
    lq_status status = LQ_OK;
    for (int a = 0; a < s->kind->axis_count && status == LQ_OK; a++) {
        json_t *axis = json_array_get(json_object_get(item, "table-axes"), (size_t)a);
        if (axis && lq_axis_from_json(axis, &s->axes[a], &cause) != LQ_OK)
            status = refuse(r, s->name, cause.text);
    }
    for (int p = 0; p < s->factored->piece_count; p++)
        for (int f = 0; f < s->factored->pieces[p].factor_count && status == LQ_OK; f++)
            status = read_factor(r, json_array_get(textures, next++), &s->factored->pieces[p].factors[f], s);
    if (status != LQ_OK) return status;
    return lq_factored_check(s->factored, &cause) == LQ_OK ? LQ_OK : refuse(r, s->name, cause.text);
}

/* ------------------------------------------------------------------------------------ textures */

/* Axis `a` of the kind: one value, or as the manifest describes the texture's. */
static lq_status read_axis(const reader *r, json_t *item, const char *name, lq_axis *axis,
                           const char *table) {
    json_t *fixed = json_object_get(json_object_get(item, "fixed"), name), *described;
    size_t i;
    if (json_is_number(fixed)) {
        const double at = json_number_value(fixed);
        return lq_axis_make(axis, name, at, at, 1, LQ_MAP_LINEAR, 0.0, r->error);
    }
    json_array_foreach(json_object_get(item, "axes"), i, described) {
        const char *called;
        double min, max, exponent;
        json_int_t size;
        if (json_unpack(described, "{s:s, s:I, s:F, s:F, s:F}", "name", &called, "texels", &size, "min", &min,
                        "max", &max, "exponent", &exponent) != 0 ||
            size < 2)
            return refuse(r, table, "an axis lacks name, texels, min, max or exponent");
        if (strcmp(called, name) == 0)
            return lq_axis_make(axis, name, min, max, (size_t)size, LQ_MAP_POWER, exponent, r->error);
    }
    return refuse(r, table, "an axis of its kind is neither in 'axes' nor in 'fixed'");
}

/* The texels of the image as entries of the table: the same order, channels apart. */
static void spread(const lq_image *image, lq_table *table) {
    for (int c = 0; c < table->channel_count; c++)
        for (size_t i = 0; i < lq_image_texels(image); i++)
            table->channels[c][i] = image->data[i * (size_t)image->channels + (size_t)c];
}

static lq_status read_texture(const reader *r, json_t *item, lq_shipped *s) {
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_status status = LQ_OK;
    for (int a = 0; a < s->kind->axis_count && status == LQ_OK; a++)
        status = read_axis(r, item, s->kind->axes[a].name, &axes[a], s->name);
    if (status == LQ_OK)
        status = lq_table_create(&s->table, axes, s->kind->axis_count, s->kind->channels,
                                 s->kind->channel_count, r->error);
    for (int a = 0; a < s->kind->axis_count; a++) lq_axis_free(&axes[a]);
    if (status == LQ_OK) status = lq_texture_make(&s->texture, s->table, s->name, r->error);
    if (status == LQ_OK) status = read_files(r, json_object_get(item, "files"), &s->texture.image, s);
    if (status == LQ_OK) spread(&s->texture.image, s->table);
    return status;
}

/* ------------------------------------------------------------------------------------- tables */

static lq_status read_facts(const reader *r, json_t *item, lq_shipped *s) {
    const char *key;
    json_t *value;
    lq_status status = LQ_OK;
    json_object_foreach(json_object_get(item, "made"), key, value) {
        const char *text = json_string_value(value);
        if (status != LQ_OK || !text) continue;
        status = s->factored ? lq_factored_set_fact(s->factored, key, text, r->error)
                             : lq_table_set_fact(s->table, key, text, r->error);
    }
    return status;
}

static double bound_of(json_t *item, const char *key) {
    json_t *bound = json_object_get(json_object_get(item, "error"), key);
    return json_is_number(bound) ? json_number_value(bound) : INFINITY;
}

static lq_status read_table(const reader *r, json_t *item, lq_shipped *s) {
    lq_error cause = {""};
    const char *name = json_string_value(json_object_get(item, "name"));
    const char *kind = json_string_value(json_object_get(item, "table"));
    const bool mapping = json_object_get(json_object_get(item, "made"), "mapping") != NULL;
    if (!name || !kind || lq_name_check("name", name, &cause) != LQ_OK)
        return refuse(r, "", "a table without 'name' or 'table'");
    snprintf(s->name, sizeof s->name, "%s", name);
    s->kind = mapping ? lq_mapping_find(kind, &cause) : lq_kind_find(kind, &cause);
    if (!s->kind) return refuse(r, s->name, cause.text);
    s->p99 = bound_of(item, "budget-p99");
    s->max = bound_of(item, "budget-max");
    s->relative = mapping;
    lq_status status =
        json_object_get(item, "textures") ? read_factored(r, item, s) : read_texture(r, item, s);
    return status == LQ_OK ? read_facts(r, item, s) : status;
}

bool lq_pack_found(const char *folder) {
    char path[4096];
    snprintf(path, sizeof path, "%s/" LQ_MANIFEST, folder);
    return access(path, F_OK) == 0;
}

lq_status lq_pack_read(lq_pack *pack, const char *folder, lq_error *error) {
    const reader r = {folder, error};
    char path[4096];
    json_error_t wrong;
    *pack = (lq_pack){.count = 0};
    snprintf(path, sizeof path, "%s/" LQ_MANIFEST, folder);
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &wrong);
    if (!root) return lq_fail(error, LQ_FORMAT, "%s:%d: %s", path, wrong.line, wrong.text);
    json_t *tables = json_object_get(root, "tables");
    const char *name = json_string_value(json_object_get(root, "pack"));
    lq_status status = LQ_OK;
    const size_t count = json_array_size(tables);
    if (!name || count == 0 || count > LQ_RECIPE_TABLES)
        status = refuse(&r, "", "not the manifest of a pack");
    else snprintf(pack->name, sizeof pack->name, "%s", name);
    if (status == LQ_OK) pack->tables = calloc(count, sizeof *pack->tables);
    if (status == LQ_OK && !pack->tables) status = lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path);
    for (size_t i = 0; status == LQ_OK && i < count; i++)
        status = read_table(&r, json_array_get(tables, i), &pack->tables[pack->count++]);
    json_decref(root);
    if (status != LQ_OK) lq_pack_free(pack);
    return status;
}

void lq_shipped_free(lq_shipped *s) {
    lq_factored_free(s->factored);
    lq_table_free(s->table);
    lq_texture_free(&s->texture);
    for (int a = 0; a < LQ_MAX_AXES; a++) lq_axis_free(&s->axes[a]);
    *s = (lq_shipped){.files = 0};
}

void lq_pack_free(lq_pack *pack) {
    for (size_t i = 0; i < pack->count; i++) lq_shipped_free(&pack->tables[i]);
    free(pack->tables);
    *pack = (lq_pack){.count = 0};
}
