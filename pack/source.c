/* source.c - decode functions in GLSL, HLSL and C.
 *
 * Each reads its texture at u' = u (1 - 1/N) + 0.5/N per axis, where u in [0,1] is the axis' map of the
 * argument and N its texels: the end points of an axis sit on texel centres. */
#include "pack/source.h"

#include "pack/factored.h"
#include "pack/source_text.h"
#include "system/draft.h"
#include "system/output.h"
#include "system/status.h"

#include <stdio.h>
#include <stdlib.h>

const char *const *lq_source_helpers(void) {
    static const char *const helpers[] = {"texel",    "clamp",        "clamp01",   "filter",
                                          "critical", "cosine",       "fetch",     "slices",
                                          "mix",      "base",         "lobe",      "lobes",
                                          "shade",    "outside",      "conductor", "coated_lambertian",
                                          "layered",  "atlas_texels", "make2",     "make3",
                                          "make4",    "vec2",         "vec3",      "vec4",
                                          NULL};
    return helpers;
}

static void print_comment(FILE *out, const lq_texture *texture, const lq_kind *kind) {
    fprintf(out, "\n/* %s: %s\n *   %s   [%s]\n *   channels:", texture->name, kind->title, kind->quantity,
            kind->source);
    for (int c = 0; c < texture->channel_count; c++) fprintf(out, " %s", texture->channels[c]);
    for (int a = 0; a < texture->axis_count; a++) {
        const lq_axis *axis = &texture->axes[a];
        fprintf(out, "\n *   %c: %s, %s, %g to %g, %zu texels", "xyz"[a], axis -> name,
                kind -> axes[texture->from[a]].meaning, axis->min, axis->max, axis->size);
        if (axis->exponent != 1.0) fprintf(out, ", value = min + (max - min) u^%g", axis->exponent);
    }
    fputs(" */\n", out);
}

static const char *vector(int count, lq_language language) {
    static const char *const glsl[] = {"float", "vec2", "vec3", "vec4"};
    static const char *const hlsl[] = {"float", "float2", "float3", "float4"};
    return language == LQ_GLSL ? glsl[count - 1] : hlsl[count - 1];
}

static void print_arguments(FILE *out, const lq_texture *texture) {
    for (int a = 0; a < texture->axis_count; a++)
        fprintf(out, "%sfloat %s", a > 0 ? ", " : "", texture->axes[a].name);
}

static void print_shader(FILE *out, const lq_texture *texture, lq_language language) {
    static const char swizzles[][5] = {"r", "rg", "rgb", "rgba"};
    const int dimensions = texture->axis_count > 2 ? 3 : 2;
    fprintf(out, "%s lacquer_%s(", vector(texture->channel_count, language), texture->name);
    if (language == LQ_GLSL) fprintf(out, "sampler%dD table, ", dimensions);
    else fprintf(out, "Texture%dD<float4> table, SamplerState linear_clamp, ", dimensions);
    print_arguments(out, texture);
    fputs(")\n{\n", out);
    for (int a = 0; a < texture->axis_count; a++) {
        fprintf(out, "    float %c = lacquer_texel(", "uvw"[a]);
        lq_print_coordinate(out, &texture->axes[a], texture->axes[a].name, language);
        fprintf(out, ", %zu.0);\n", texture->axes[a].size);
    }
    fprintf(out,
            language == LQ_GLSL ? "    return textureLod(table, %s("
                                : "    return table.SampleLevel(linear_clamp, %s(",
            vector(dimensions, language));
    fputs(texture->axis_count == 1 ? "u, 0.5" : texture->axis_count == 2 ? "u, v" : "u, v, w", out);
    fprintf(out, "), 0.0).%s;\n}\n", swizzles[texture->channel_count - 1]);
}

static void print_c(FILE *out, const lq_texture *texture) {
    fprintf(out, "static inline void lacquer_%s(const float *table, ", texture->name);
    print_arguments(out, texture);
    fprintf(out, ", float value[%d]) {\n    const int size[] = {", texture->channel_count);
    for (int a = 0; a < texture->axis_count; a++)
        fprintf(out, "%s%zu", a > 0 ? ", " : "", texture->axes[a].size);
    fputs("};\n    const float u[] = {", out);
    for (int a = 0; a < texture->axis_count; a++) {
        if (a > 0) fputs(",\n                       ", out);
        lq_print_coordinate(out, &texture->axes[a], texture->axes[a].name, LQ_C);
    }
    fprintf(out, "};\n    lacquer_filter(table, %d, size, u, %d, %d, value);\n}\n", texture->axis_count,
            texture->image.channels, texture->channel_count);
}

lq_status lq_source_write(lq_language language, const lq_source_table *tables, size_t count, const char *path,
                          lq_error *error) {
    lq_draft draft = {.text = NULL};
    FILE *out = lq_draft_open(&draft);
    if (!out) return lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path);
    fputs("/* Decode functions, made by lacquer " LQ_VERSION ". */\n", out);
    lq_print_helpers(out, language);
    for (size_t i = 0; i < count; i++) {
        const lq_texture *texture = tables[i].texture;
        if (!texture) lq_factored_source(out, language, tables[i].factored, tables[i].kind);
        if (!texture) continue;
        print_comment(out, texture, tables[i].kind);
        if (language == LQ_C) print_c(out, texture);
        else print_shader(out, texture, language);
    }
    fputs("\n#endif\n", out);
    lq_status status = lq_draft_close(&draft, out) ? lq_output_save(path, draft.text, draft.size, error)
                                                   : lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path);
    free(draft.text);
    return status;
}
