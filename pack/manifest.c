/* manifest.c - manifest.json of a pack. */
#include "pack/manifest.h"

#include "pack/source.h"
#include "tables/output.h"
#include "tables/status.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void lq_packed_file(const lq_packed *packed, const char *ending, char *name, size_t size) {
    snprintf(name, size, "%s%s", packed->from->name, ending);
}

static json_t *number(double value) {
    return json_pack("f", value);
}

static json_t *describe_axis(const lq_texture *texture, int a) {
    static const char *const directions[] = {"x", "y", "z"};
    const lq_axis *axis = &texture->axes[a];
    return json_pack("{s:s, s:s, s:I, s:f, s:f, s:f, s:s}", "name", axis->name, "direction", directions[a],
                     "texels", (json_int_t)axis->size, "min", axis->min, "max", axis->max, "exponent",
                     axis->exponent, "lookup",
                     "u = ((value - min) / (max - min))^(1 / exponent), then u (1 - 1/texels) + 0.5/texels");
}

static json_t *describe_files(const lq_recipe *recipe, const lq_packed *packed) {
    static const char *const hints[LQ_CONTAINERS] = {
        "KTX 2.0",
        "KTX 2.0, zstd",
        "DDS, DX10 block",
        "OpenEXR RGBA half, slices side by side",
        "NumPy, first axis fastest (last index before the channels)",
        "C array"};
    json_t *files = json_array();
    char name[64];
    for (int c = 0; c < LQ_CONTAINERS; c++) {
        if (!recipe->containers[c]) continue;
        lq_packed_file(packed, lq_container_ending((lq_container)c), name, sizeof name);
        json_array_append_new(files, json_pack("{s:s, s:s}", "file", name, "format", hints[c]));
    }
    for (int l = 0; l < LQ_LAYOUTS; l++) {
        if (!packed->from->layouts[l]) continue;
        snprintf(name, sizeof name, "%s.%s.bin", packed->from->name, lq_layout_name((lq_layout)l));
        json_array_append_new(files,
                              json_pack("{s:s, s:s}", "file", name, "format", lq_layout_name((lq_layout)l)));
    }
    return files;
}

static json_t *describe_error(const lq_packed *packed) {
    const lq_measure *m = &packed->measure;
    json_t *error = json_pack("{s:I, s:f, s:f, s:f, s:s}", "points", (json_int_t)m->points, "rms", m->rms,
                              "p99", m->p99, "max", m->max, "includes",
                              "half storage, 8 fractional bits of filter weights; off the grid, against the "
                              "exact integral, for mu, alpha, tau >= 0.02");
    json_t *worst = json_object();
    for (int a = 0; a < packed->from->kind->axis_count; a++)
        json_object_set_new(worst, packed->from->axes[a].name, number(m->worst[a]));
    json_object_set_new(error, "worst-at", worst);
    if (isfinite(packed->from->p99)) json_object_set_new(error, "budget-p99", number(packed->from->p99));
    if (isfinite(packed->from->max)) json_object_set_new(error, "budget-max", number(packed->from->max));
    return error;
}

static json_t *describe_table(const lq_recipe *recipe, const lq_packed *packed) {
    const lq_texture *texture = &packed->texture;
    json_t *axes = json_array(), *channels = json_array(), *made = json_object();
    for (int a = 0; a < texture->axis_count; a++) json_array_append_new(axes, describe_axis(texture, a));
    for (int c = 0; c < texture->channel_count; c++)
        json_array_append_new(channels, json_string(texture->channels[c]));
    for (size_t i = 0; i < packed->table->fact_count; i++)
        if (strncmp(packed->table->facts[i].key, "cache", 5) != 0)
            json_object_set_new(made, packed->table->facts[i].key,
                                json_string(packed->table->facts[i].value));
    char function[64];
    snprintf(function, sizeof function, "lacquer_%s", texture->name);
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:o, s:o, s:I, s:o, s:o, s:o}", "name", packed->from->name,
                     "table", packed->from->kind->id, "title", packed->from->kind->title, "quantity",
                     packed->from->kind->quantity, "function", function, "axes", axes, "channels", channels,
                     "bytes", (json_int_t)lq_image_bytes(&texture->image), "files",
                     describe_files(recipe, packed), "error", describe_error(packed), "made", made);
}

lq_status lq_manifest_write(const lq_recipe *recipe, const lq_packed *packed, const char *path,
                            lq_error *error) {
    json_t *tables = json_array(), *sources = json_array();
    size_t bytes = 0;
    for (size_t i = 0; i < recipe->count; i++) {
        json_array_append_new(tables, describe_table(recipe, &packed[i]));
        bytes += lq_image_bytes(&packed[i].texture.image);
    }
    for (int l = 0; l < LQ_LANGUAGES; l++)
        json_array_append_new(sources, json_string(lq_source_file((lq_language)l)));
    json_t *root = json_pack("{s:s, s:s, s:s, s:s, s:I, s:o, s:o}", "pack", recipe->name, "made-by",
                             "lacquer " LQ_VERSION, "orientation",
                             "texel 0 of every axis is its min and is stored first", "sampler",
                             "linear filter, clamp to edge, no mip levels", "texture-bytes",
                             (json_int_t)bytes, "decode", sources, "tables", tables);
    char *text = root ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(root);
    if (!text) return lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path);
    lq_status status = lq_output_save(path, text, strlen(text), error);
    free(text);
    return status;
}
