/* manifest.c - manifest.json of a pack. */
#include "pack/manifest.h"

#include "pack/contents.h"
#include "pack/source.h"
#include "pca/factors_json.h"
#include "system/json.h"
#include "system/output.h"
#include "system/status.h"
#include "tables/exr_layout.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *number(double value) {
    return json_pack("f", value);
}

static json_t *describe_axis(const lq_axis *axis, int a) {
    static const char *const directions[] = {"x", "y", "z"};
    return json_pack("{s:s, s:s, s:I, s:f, s:f, s:f, s:s}", "name", axis->name, "direction", directions[a],
                     "texels", (json_int_t)axis->size, "min", axis->min, "max", axis->max, "exponent",
                     axis->exponent, "lookup",
                     "u = ((value - min) / (max - min))^(1 / exponent), then u (1 - 1/texels) + 0.5/texels");
}

static json_t *describe_stem(const lq_recipe *recipe, const char *stem, json_t *sums) {
    json_t *files = json_array();
    char name[96];
    for (int c = 0; c < LQ_CONTAINERS; c++) {
        if (!recipe->containers[c]) continue;
        snprintf(name, sizeof name, "%s%s", stem, lq_container_ending((lq_container)c));
        json_t *item = json_pack("{s:s, s:s}", "file", name, "format", lq_container_format((lq_container)c));
        json_t *sum = json_object_get(sums, name);
        if (sum) lq_json_set(&item, "crc32", json_incref(sum));
        lq_json_append(&files, item);
    }
    return files;
}

static json_t *describe_files(const lq_recipe *recipe, const lq_packed *packed, size_t image, json_t *sums) {
    char stem[64];
    lq_packed_stem(packed, image, stem, sizeof stem);
    return describe_stem(recipe, stem, sums);
}

static void add_binaries(const lq_packed *packed, json_t **files) {
    char name[64];
    for (int l = 0; l < LQ_LAYOUTS; l++) {
        if (!packed->from->layouts[l]) continue;
        snprintf(name, sizeof name, "%s.%s.bin", packed->from->name, lq_layout_name((lq_layout)l));
        lq_json_append(files, json_pack("{s:s, s:s}", "file", name, "format", lq_layout_name((lq_layout)l)));
    }
}

/* Each factor: the argument of the decode function, its axes and its files. */
static json_t *describe_factors(const lq_recipe *recipe, const lq_packed *packed, json_t *sums) {
    json_t *textures = json_array();
    for (size_t i = 0; i < packed->factors.count; i++) {
        const lq_bases *bases = &packed->factors.bases[i];
        const lq_factor *factor = &packed->factored->pieces[bases->piece].factors[bases->factor];
        json_t *axes = json_array();
        char argument[32];
        snprintf(argument, sizeof argument, "t%s", bases->suffix);
        for (int a = 0; a < factor->axis_count; a++)
            lq_json_append(&axes, describe_axis(&factor->axes[a].texels, a));
        lq_json_append(&textures,
                       json_pack("{s:s, s:I, s:I, s:I, s:s, s:o, s:o}", "argument", argument, "piece",
                                 (json_int_t)bases->piece, "bases", (json_int_t)factor->base_count, "layers",
                                 (json_int_t)bases->image.layers, "layout",
                                 "base b in channel b % 4 of layer b / 4", "axes", axes, "files",
                                 recipe->atlas ? json_array() : describe_files(recipe, packed, i, sums)));
    }
    return textures;
}

static json_t *describe_error(const lq_packed *packed) {
    const lq_measure *m = &packed->measure;
    json_t *error =
        json_pack("{s:s, s:I, s:f, s:f, s:f, s:s}", "kind", m->relative ? "relative" : "absolute", "points",
                  (json_int_t)m->points, "rms", m->rms, "p99", m->p99, "max", m->max, "includes",
                  "half storage, 8 fractional bits of filter weights; off the grid, against the "
                  "exact integral, for mu, alpha, tau >= 0.02");
    json_t *worst = json_object();
    for (int a = 0; a < packed->from->kind->axis_count; a++)
        lq_json_set(&worst, packed->from->axes[a].name, number(m->worst[a]));
    lq_json_set(&error, "worst-at", worst);
    if (isfinite(packed->from->p99)) lq_json_set(&error, "budget-p99", number(packed->from->p99));
    if (isfinite(packed->from->max)) lq_json_set(&error, "budget-max", number(packed->from->max));
    return error;
}

/* How it was made: the facts of the table, or of the factors, which have those of their table. */
static json_t *describe_origin(const lq_packed *packed) {
    const size_t count = packed->factored ? packed->factored->fact_count : packed->table->fact_count;
    const lq_fact *facts = packed->factored ? packed->factored->facts : packed->table->facts;
    json_t *made = json_object();
    for (size_t i = 0; i < count; i++)
        if (strncmp(facts[i].key, "cache", 5) != 0)
            lq_json_set(&made, facts[i].key, lq_json_text(facts[i].value));
    return made;
}

/* Which products of bases make up a value: what the decode functions do, for programs. A text of its own: it
 * keeps every bit, and its lists of numbers stay on one line. */
static json_t *describe_structure(const lq_factored *factored) {
    char *text = lq_factored_to_json(factored);
    json_t *structure = text ? lq_json_text(text) : NULL;
    free(text);
    return structure;
}

/* The nodes of the table that was factored. */
static json_t *describe_table_axes(const lq_recipe_table *from) {
    json_t *axes = json_array();
    for (int a = 0; a < from->kind->axis_count; a++) lq_json_append(&axes, lq_axis_to_json(&from->axes[a]));
    return axes;
}

/* Axes of one value, which the texture has not. */
static json_t *describe_fixed(const lq_recipe_table *from) {
    json_t *fixed = json_object();
    for (int a = 0; a < from->kind->axis_count; a++)
        if (from->axes[a].size == 1) lq_json_set(&fixed, from->axes[a].name, number(from->axes[a].min));
    return fixed;
}

/* Where the image is in the atlas: of each layer x, y, width, height and, if not 0, its first channel. */
static json_t *describe_tiles(const lq_packing *packing, size_t first, size_t count) {
    json_t *tiles = json_array();
    for (size_t i = first; i < first + count; i++) {
        const lq_tile *tile = &packing->atlas.tiles[i];
        json_t *place = json_pack("[I, I, I, I]", (json_int_t)tile->x, (json_int_t)tile->y,
                                  (json_int_t)tile->image->width, (json_int_t)tile->image->height);
        if (tile->channel > 0) lq_json_append(&place, json_integer(tile->channel));
        lq_json_append(&tiles, place);
    }
    return tiles;
}

static size_t layers_of(const lq_packed *packed) {
    size_t layers = 0;
    for (size_t i = 0; i < lq_packed_images(packed); i++) layers += lq_packed_image(packed, i)->layers;
    return layers;
}

static json_t *describe_table(const lq_packing *packing, size_t index, json_t *sums) {
    const lq_recipe *recipe = packing->recipe;
    const lq_packed *packed = &packing->tables[index];
    const lq_texture *texture = &packed->texture;
    const lq_recipe_table *from = packed->from;
    const bool alone = !packed->factored && !recipe->atlas;
    json_t *files = alone ? describe_files(recipe, packed, 0, sums) : json_array();
    char function[64];
    snprintf(function, sizeof function, "lacquer_%s",
             packed->factored ? packed->factors.name : texture->name);
    const lq_atlas_table source = {{from->kind, packed->factored ? NULL : texture, &packed->factors}, 0};
    json_t *table = json_pack("{s:s, s:s, s:s, s:s, s:s, s:I, s:I}", "name", from->name, "table",
                              from->kind->id, "title", from->kind->title, "quantity", from->kind->quantity,
                              "function", function, "bytes", (json_int_t)lq_packed_bytes(packed), "fetches",
                              (json_int_t)lq_atlas_table_fetches(&source));
    if (packed->factored) {
        lq_json_set(&table, "channel", lq_json_text(from->kind->channels[from->channel]));
        lq_json_set(&table, "textures", describe_factors(recipe, packed, sums));
        lq_json_set(&table, "structure", describe_structure(packed->factored));
        lq_json_set(&table, "table-axes", describe_table_axes(from));
    } else {
        json_t *axes = json_array(), *channels = json_array();
        for (int a = 0; a < texture->axis_count; a++)
            lq_json_append(&axes, describe_axis(&texture->axes[a], a));
        for (int c = 0; c < texture->channel_count; c++)
            lq_json_append(&channels, lq_json_text(texture->channels[c]));
        lq_json_set(&table, "axes", axes);
        lq_json_set(&table, "fixed", describe_fixed(from));
        lq_json_set(&table, "channels", channels);
    }
    if (recipe->atlas)
        lq_json_set(&table, "tiles", describe_tiles(packing, packing->tiles[index], layers_of(packed)));
    add_binaries(packed, &files);
    lq_json_set(&table, "files", files);
    lq_json_set(&table, "error", describe_error(packed));
    lq_json_set(&table, "made", describe_origin(packed));
    return table;
}

/* A material: its stack, which channel holds each number and which are constants, and its error. */
static json_t *describe_lobes(const lq_lobes *lobes) {
    json_t *numbers = json_object();
    for (int k = 0; k < LQ_MATERIAL_NUMBERS; k++)
        lq_json_set(&numbers, lq_lobes_number_name(k),
                    lobes->channel[k] < 0 ? json_pack("{s:f}", "constant", lobes->constant[k])
                                          : json_pack("{s:i}", "channel", lobes->channel[k]));
    return numbers;
}

static json_t *describe_material_error(const lq_recipe *recipe, const lq_packed_material *m) {
    json_t *error = json_pack("{s:s, s:I, s:f, s:f, s:f, s:s}", "kind", "absolute", "points",
                              (json_int_t)m->measure.points, "rms", m->measure.rms, "p99", m->measure.p99,
                              "max", m->measure.max, "includes",
                              "half storage, 8 fractional bits of filter weights; off the grid, against the "
                              "exact stack, for mu >= 0.02; energies, and roughness times the energy it has");
    json_t *worst = json_object();
    for (int a = 0; a < 1 + m->from->material.range_count; a++)
        lq_json_set(&worst, a == 0 ? "mu" : m->from->material.ranges[a - 1].name,
                    number(m->measure.worst[a]));
    lq_json_set(&error, "worst-at", worst);
    if (isfinite(recipe->p99)) lq_json_set(&error, "budget-p99", number(recipe->p99));
    if (isfinite(recipe->max)) lq_json_set(&error, "budget-max", number(recipe->max));
    return error;
}

static json_t *describe_material(const lq_packing *packing, size_t index) {
    const lq_packed_material *m = &packing->materials[index];
    const lq_lobes *lobes = &m->lobes;
    const lq_atlas_material source = {m->name, lobes, packing->tiles[packing->recipe->count + index]};
    const bool textured = lobes->channel_count > 0;
    json_t *axes = json_array();
    char function[64], *stack = NULL;
    snprintf(function, sizeof function, "lacquer_%s", m->name);
    for (int a = 0; a < lobes->axis_count && textured; a++)
        lq_json_append(&axes, describe_axis(&lobes->axes[a], a));
    if (lq_stack_text(m->from->stack, &stack, NULL) != LQ_OK) stack = NULL;
    json_t *material = json_pack(
        "{s:s, s:s, s:s, s:s, s:I, s:I, s:I, s:o, s:o, s:o, s:o}", "name", m->from->name, "function",
        function, "stack", stack ? stack : "", "source", m->from->source ? m->from->source : "", "bytes",
        (json_int_t)lq_image_bytes(&lobes->image), "fetches", (json_int_t)lq_atlas_material_fetches(&source),
        "pitch", (json_int_t)lq_lobes_pitch(lobes), "axes", axes, "numbers", describe_lobes(lobes), "tiles",
        describe_tiles(packing, source.tile, textured ? lobes->texels : 0), "error",
        describe_material_error(packing->recipe, m));
    free(stack);
    return material;
}

static void add_atlas(const lq_packing *packing, json_t **root, json_t *sums) {
    const lq_image *image = &packing->atlas.image;
    lq_json_set(root, "atlas",
                json_pack("{s:I, s:I, s:s, s:o}", "width", (json_int_t)image->width, "height",
                          (json_int_t)image->height, "layout",
                          "tiles are [x, y, width, height] without their border of one texel, which "
                          "repeats the edge; a texel of a material holds channels 4 t to 4 t + 3",
                          "files", describe_stem(packing->recipe, "atlas", sums)));
    json_t *materials = json_array();
    for (size_t i = 0; i < packing->recipe->material_count; i++)
        lq_json_append(&materials, describe_material(packing, i));
    lq_json_set(root, "materials", materials);
}

lq_status lq_manifest_write(const lq_packing *packing, const char *folder, lq_error *error) {
    const lq_recipe *recipe = packing->recipe;
    char path[PATH_MAX + 64];
    snprintf(path, sizeof path, "%s/" LQ_MANIFEST, folder);
    json_t *tables = json_array(), *sources = json_array();
    json_t *sums = lq_contents_list(folder); /* NULL: json_pack below says so */
    for (size_t i = 0; i < recipe->count; i++) lq_json_append(&tables, describe_table(packing, i, sums));
    for (int l = 0; l < lq_packing_languages(recipe); l++)
        lq_json_append(&sources, lq_json_text(lq_language_file((lq_language)l)));
    json_t *root =
        json_pack("{s:s, s:i, s:s, s:s, s:s, s:s, s:I, s:o, s:o, s:O}", "format", LQ_PACK_FORMAT, "version",
                  LQ_PACK_VERSION, "pack", recipe->name, "made-by", "lacquer " LQ_VERSION, "orientation",
                  "texel 0 of every axis is its min and is stored first", "sampler",
                  "linear filter, clamp to edge, no mip levels", "texture-bytes",
                  (json_int_t)lq_packing_bytes(packing), "decode", sources, "tables", tables, "files", sums);
    if (recipe->atlas) add_atlas(packing, &root, sums);
    json_decref(sums);
    char *text = lq_json_dump(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    if (!text) return lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path);
    lq_status status = lq_output_save(path, text, strlen(text), error);
    free(text);
    return status;
}
