/* read.c - a pack from its folder. */
#include "pack/read.h"

#include "pack/contents.h"
#include "pack/mapping.h"
#include "pca/factors.h"
#include "pca/factors_json.h"
#include "system/json.h"
#include "system/status.h"
#include "tables/axis.h"
#include "tables/exr_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is being read. */
typedef struct reader {
    const char *folder;
    const lq_shipped *atlas; /* NULL: every image has files of its own */
    size_t *left;            /* values that images out of the atlas may still have */
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

/* What the first of the files that will be read can hold; 0: there is none. */
static size_t capacity_of(const reader *r, json_t *files) {
    json_t *item;
    size_t i;
    json_array_foreach(files, i, item) {
        const char *file = json_string_value(json_object_get(item, "file"));
        const lq_container container = file ? container_of(file) : LQ_CONTAINERS;
        char path[4096];
        if (container == LQ_CONTAINERS) continue;
        snprintf(path, sizeof path, "%s/%s", r->folder, file);
        return lq_image_capacity(container, path);
    }
    return 0;
}

/* Sizes come from a stranger: how many values there can be, of an image with these files or out of the atlas.
 * A file that is not there is missed when it is read. */
static size_t room_for(const reader *r, json_t *files) {
    enum { FEW = 4096 };
    const size_t room = r->atlas ? *r->left : capacity_of(r, files);
    return room > FEW ? room : FEW;
}

/* Values come off what the atlas may give. Four tiles may share its texels, of four values each. */
static lq_status take_room(const reader *r, const lq_image *image, const char *name) {
    const size_t values = lq_image_texels(image) * (size_t)image->channels;
    if (r->atlas && values > *r->left) return refuse(r, name, "tiles of more texels than the atlas has");
    if (r->atlas) *r->left -= values;
    return LQ_OK;
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

/* Layer `layer` of an image out of the atlas, at the tile [x, y, width, height], or with its first channel
 * after them. */
static lq_status cut_tile(const reader *r, json_t *tile, size_t layer, lq_image *image, const char *name) {
    const lq_image *atlas = &r->atlas->texture.image;
    const json_t *first = json_array_get(tile, 4);
    const json_int_t channel = first ? json_integer_value(first) : 0;
    json_int_t x, y, width, height;
    if (json_unpack(tile, "[I, I, I, I]", &x, &y, &width, &height) != 0 || channel < 0 || channel > 3 ||
        x < 0 || y < 0 || (size_t)width != image->width || (size_t)height != image->height ||
        (size_t)x + image->width > atlas->width || (size_t)y + image->height > atlas->height)
        return refuse(r, name, "a tile that is not in the atlas, or not of the size of its texture");
    const size_t channels = (size_t)image->channels, skipped = (size_t)channel;
    const size_t copied = channels < 4 - skipped ? channels : 4 - skipped;
    for (size_t row = 0; row < image->height; row++)
        for (size_t column = 0; column < image->width; column++)
            memcpy(image->data + ((layer * image->height + row) * image->width + column) * channels,
                   atlas->data + (((size_t)y + row) * atlas->width + (size_t)x + column) * 4 + skipped,
                   copied * sizeof(float));
    return LQ_OK;
}

/* All layers of an image from tile `first` on. */
static lq_status cut_image(const reader *r, json_t *tiles, size_t first, lq_image *image, const char *name) {
    lq_status status = LQ_OK;
    for (size_t l = 0; l < image->layers && status == LQ_OK; l++)
        status = cut_tile(r, json_array_get(tiles, first + l), l, image, name);
    return status;
}

/* An image from files of its own, or from the atlas, whose files count as the table's. */
static lq_status read_image(const reader *r, json_t *files, json_t *tiles, size_t first, lq_image *image,
                            lq_shipped *s) {
    if (!r->atlas) return read_files(r, files, image, s);
    const lq_status status = take_room(r, image, s->name);
    if (status != LQ_OK) return status;
    s->files = r->atlas->files;
    s->altered = r->atlas->altered;
    s->differing = r->atlas->differing;
    snprintf(s->suspect, sizeof s->suspect, "%s", r->atlas->suspect);
    return cut_image(r, tiles, first, image, s->name);
}

static lq_status read_atlas(reader *r, json_t *item, lq_shipped *atlas) {
    json_int_t width, height;
    if (!item) return LQ_OK;
    if (json_unpack(item, "{s:I, s:I}", "width", &width, "height", &height) != 0 || width < 1 || height < 1 ||
        width > LQ_TEXTURE_LARGEST || height > LQ_TEXTURE_LARGEST)
        return refuse(r, "atlas", "no width and height");
    json_t *files = json_object_get(item, "files");
    if (4 * (size_t)width * (size_t)height > room_for(r, files))
        return refuse(r, "atlas", "its file cannot hold so many texels");
    snprintf(atlas->name, sizeof atlas->name, "atlas");
    lq_status status =
        lq_image_create(&atlas->texture.image, (size_t)width, (size_t)height, 1, 1, 4, r->error);
    if (status == LQ_OK) status = read_files(r, files, &atlas->texture.image, atlas);
    *r->left = 16 * (size_t)width * (size_t)height;
    if (status == LQ_OK) r->atlas = atlas;
    return status;
}

/* ------------------------------------------------------------------------------------ factors */

static lq_status read_factor(const reader *r, json_t *item, json_t *tiles, size_t *first, lq_factor *factor,
                             lq_shipped *s) {
    const size_t width = factor->axes[0].texels.size, texels = lq_factor_texels(factor);
    lq_image image;
    lq_status status =
        lq_image_create(&image, width, texels / width, 1, (factor->base_count + 3) / 4, 4, r->error);
    image.array = true;
    if (status == LQ_OK) status = read_image(r, json_object_get(item, "files"), tiles, *first, &image, s);
    *first += image.layers;
    for (size_t b = 0; status == LQ_OK && b < factor->base_count; b++)
        for (size_t i = 0; i < texels; i++)
            factor->data[b * texels + i] = image.data[(b / 4 * texels + i) * 4 + b % 4];
    lq_image_free(&image);
    return status;
}

static lq_status read_factored(const reader *r, json_t *item, lq_shipped *s) {
    json_t *textures = json_object_get(item, "textures"), *tiles = json_object_get(item, "tiles");
    const char *structure = json_string_value(json_object_get(item, "structure"));
    size_t next = 0, tile = 0;
    s->factored = calloc(1, sizeof *s->factored);
    if (!s->factored) return lq_fail(r->error, LQ_NO_MEMORY, "%s: out of memory", s->name);
    if (!structure) return refuse(r, s->name, "no 'structure'; made by an earlier lacquer?");
    lq_error cause = {""};
    json_t *texture;
    size_t i, room = r->atlas ? room_for(r, NULL) : 0;
    json_array_foreach(textures, i, texture) if (!r->atlas) room +=
        room_for(r, json_object_get(texture, "files"));
    if (lq_factored_from_json(structure, room, s->factored, &cause) != LQ_OK)
        return refuse(r, s->name, cause.text);
    lq_status status = LQ_OK;
    for (int a = 0; a < s->kind->axis_count && status == LQ_OK; a++) {
        json_t *axis = json_array_get(json_object_get(item, "table-axes"), (size_t)a);
        if (axis && lq_axis_from_json(axis, LQ_TEXTURE_LARGEST, &s->axes[a], &cause) != LQ_OK)
            status = refuse(r, s->name, cause.text);
    }
    for (int p = 0; p < s->factored->piece_count; p++)
        for (int f = 0; f < s->factored->pieces[p].factor_count && status == LQ_OK; f++)
            status = read_factor(r, json_array_get(textures, next++), tiles, &tile,
                                 &s->factored->pieces[p].factors[f], s);
    if (status != LQ_OK) return status;
    return lq_factored_check(s->factored, &cause) == LQ_OK ? LQ_OK : refuse(r, s->name, cause.text);
}

/* ------------------------------------------------------------------------------------ textures */

/* One axis: one value, or as the manifest describes the texture's, within `room`, which it divides. */
static lq_status read_axis(const reader *r, json_t *item, const char *name, size_t *room, lq_axis *axis,
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
        if (strcmp(called, name) != 0) continue;
        if ((size_t)size > *room) return refuse(r, table, "its file cannot hold so many texels");
        *room /= (size_t)size;
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
    json_t *files = json_object_get(item, "files");
    size_t room = room_for(r, files);
    lq_status status = LQ_OK;
    for (int a = 0; a < s->kind->axis_count && status == LQ_OK; a++)
        status = read_axis(r, item, s->kind->axes[a].name, &room, &axes[a], s->name);
    if (status == LQ_OK)
        status = lq_table_create(&s->table, axes, s->kind->axis_count, s->kind->channels,
                                 s->kind->channel_count, r->error);
    for (int a = 0; a < s->kind->axis_count; a++) lq_axis_free(&axes[a]);
    if (status == LQ_OK) status = lq_texture_make(&s->texture, s->table, s->name, r->error);
    if (status == LQ_OK)
        status = read_image(r, files, json_object_get(item, "tiles"), 0, &s->texture.image, s);
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

/* ---------------------------------------------------------------------------------- materials */

static lq_status read_number(const reader *r, json_t *item, const char *name, int k, lq_lobes *lobes) {
    json_t *number = json_object_get(item, lq_lobes_number_name(k));
    json_t *channel = json_object_get(number, "channel"), *constant = json_object_get(number, "constant");
    lobes->channel[k] = json_is_integer(channel) ? (int)json_integer_value(channel) : -1;
    lobes->constant[k] = json_number_value(constant);
    if (json_is_number(constant) && !channel) return LQ_OK;
    if (lobes->channel[k] < 0 || lobes->channel[k] >= LQ_MATERIAL_NUMBERS)
        return refuse(r, name, "a number that is neither a channel nor a constant");
    if (lobes->channel[k] >= lobes->channel_count) lobes->channel_count = lobes->channel[k] + 1;
    return LQ_OK;
}

static lq_status read_lobes(const reader *r, json_t *item, lq_shipped_material *m) {
    lq_lobes *l = &m->lobes;
    json_t *numbers = json_object_get(item, "numbers");
    size_t room = room_for(r, NULL);
    lq_status status = LQ_OK;
    *l = (lq_lobes){.material = &m->material, .axis_count = 1 + m->material.range_count};
    for (int k = 0; k < LQ_MATERIAL_NUMBERS && status == LQ_OK; k++)
        status = read_number(r, numbers, m->name, k, l);
    l->p99 = bound_of(item, "budget-p99");
    l->max = bound_of(item, "budget-max");
    l->texels = (size_t)(l->channel_count + LQ_LOBES_PER_TEXEL - 1) / LQ_LOBES_PER_TEXEL;
    for (int a = 0; a < l->axis_count && l->channel_count > 0 && status == LQ_OK; a++)
        status =
            read_axis(r, item, a == 0 ? "mu" : m->material.ranges[a - 1].name, &room, &l->axes[a], m->name);
    if (status != LQ_OK || l->channel_count == 0) return status;
    status = lq_lobes_allocate(l, r->error);
    if (status == LQ_OK) status = take_room(r, &l->image, m->name);
    return status == LQ_OK ? cut_image(r, json_object_get(item, "tiles"), 0, &l->image, m->name) : status;
}

static lq_status read_material(const reader *r, json_t *item, lq_shipped_material *m) {
    lq_error cause = {""};
    const char *name = json_string_value(json_object_get(item, "name"));
    const char *stack = json_string_value(json_object_get(item, "stack"));
    if (!name || !stack || lq_name_check("name", name, &cause) != LQ_OK)
        return refuse(r, "", "a material without 'name' or 'stack'");
    snprintf(m->name, sizeof m->name, "%s", name);
    if (lq_stack_parse(&m->stack, stack, name, LQ_STACK_RANGES, &cause) != LQ_OK ||
        lq_material_describe(&m->material, m->stack, &cause) != LQ_OK)
        return refuse(r, name, cause.text);
    return read_lobes(r, item, m);
}

static lq_status read_materials(const reader *r, json_t *list, lq_pack *pack) {
    const size_t count = json_array_size(list);
    lq_status status = LQ_OK;
    if (count == 0) return LQ_OK;
    if (!r->atlas || count > LQ_RECIPE_MATERIALS)
        return refuse(r, "materials", "without an atlas, or too many");
    pack->materials = calloc(count, sizeof *pack->materials);
    if (!pack->materials) return lq_fail(r->error, LQ_NO_MEMORY, "%s: out of memory", r->folder);
    for (size_t i = 0; i < count && status == LQ_OK; i++)
        status = read_material(r, json_array_get(list, i), &pack->materials[pack->material_count++]);
    return status;
}

/* ------------------------------------------------------------------------------------ the pack */

bool lq_pack_found(const char *folder) {
    char path[4096];
    snprintf(path, sizeof path, "%s/" LQ_MANIFEST, folder);
    return access(path, F_OK) == 0;
}

lq_status lq_pack_read(lq_pack *pack, const char *folder, lq_error *error) {
    size_t left = 0;
    reader r = {folder, NULL, &left, error};
    char path[4096];
    json_t *root;
    *pack = (lq_pack){.count = 0};
    snprintf(path, sizeof path, "%s/" LQ_MANIFEST, folder);
    lq_status status = lq_json_read(&root, path, error);
    if (status != LQ_OK) return status;
    pack->manifest = root;
    json_t *tables = json_object_get(root, "tables");
    const char *name = json_string_value(json_object_get(root, "pack"));
    const size_t count = json_array_size(tables);
    if (!name || count == 0 || count > LQ_RECIPE_TABLES)
        status = refuse(&r, "", "not the manifest of a pack");
    else if (json_integer_value(json_object_get(root, "version")) > LQ_PACK_VERSION)
        status = refuse(&r, "", "of a later version; accepted: one that this program knows");
    else snprintf(pack->name, sizeof pack->name, "%s", name);
    if (status == LQ_OK) status = read_atlas(&r, json_object_get(root, "atlas"), &pack->atlas);
    if (status == LQ_OK) pack->tables = calloc(count, sizeof *pack->tables);
    if (status == LQ_OK && !pack->tables) status = lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path);
    for (size_t i = 0; status == LQ_OK && i < count; i++)
        status = read_table(&r, json_array_get(tables, i), &pack->tables[pack->count++]);
    if (status == LQ_OK) status = read_materials(&r, json_object_get(root, "materials"), pack);
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
    for (size_t i = 0; i < pack->material_count; i++) {
        lq_lobes_free(&pack->materials[i].lobes);
        lq_stack_free(pack->materials[i].stack);
    }
    lq_shipped_free(&pack->atlas);
    free(pack->tables);
    free(pack->materials);
    json_decref(pack->manifest);
    free(pack->folder);
    free(pack->functions);
    *pack = (lq_pack){.count = 0};
}
