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

static const char glsl_head[] =
    "/* Bind each texture with linear filtering, clamp to edge, no mip levels. */\n"
    "#ifndef LACQUER_DECODE\n#define LACQUER_DECODE\n\n"
    "#ifdef GL_ES\nprecision highp float;\nprecision highp sampler2D;\nprecision highp sampler3D;\n"
    "precision highp sampler2DArray;\n#endif\n\n"
    "/* u in [0,1] to where a texture of n texels has it: 0 and 1 are the centres of the outer texels. */\n"
    "float lacquer_texel(float u, float n) { return u * (1.0 - 1.0 / n) + 0.5 / n; }\n";

static const char hlsl_head[] =
    "/* The sampler: linear filtering, clamp, no mip levels. */\n"
    "#ifndef LACQUER_DECODE\n#define LACQUER_DECODE\n\n"
    "/* u in [0,1] to where a texture of n texels has it: 0 and 1 are the centres of the outer texels. */\n"
    "float lacquer_texel(float u, float n) { return u * (1.0 - 1.0 / n) + 0.5 / n; }\n";

static const char c_head[] =
    "/* `table` is the array of the pack's C header: channels fastest, then x, y, z. */\n"
    "#ifndef LACQUER_DECODE\n#define LACQUER_DECODE\n\n#include <math.h>\n\n"
    "static inline float lacquer_clamp01(float x) { return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x; }\n\n"
    "/* Linear filtering at u in [0,1] along each axis; size[a] texels, node 0 at u = 0, the last at u = 1. "
    "*/\n"
    "static inline void lacquer_filter(const float *table, int axes, const int *size, const float *u,\n"
    "                                  int channels, int count, float *value) {\n"
    "    int texel = 0, stride[3] = {1, 1, 1};\n"
    "    float weight[3] = {0.0f, 0.0f, 0.0f};\n"
    "    for (int a = 0; a < axes; a++) {\n"
    "        float position = u[a] * (float)(size[a] - 1);\n"
    "        int below = (int)position < size[a] - 2 ? (int)position : size[a] - 2;\n"
    "        stride[a] = a > 0 ? stride[a - 1] * size[a - 1] : 1;\n"
    "        weight[a] = position - (float)below;\n"
    "        texel += stride[a] * below;\n"
    "    }\n"
    "    for (int c = 0; c < count; c++) value[c] = 0.0f;\n"
    "    for (int corner = 0; corner < 1 << axes; corner++) {\n"
    "        float w = 1.0f;\n"
    "        int at = texel;\n"
    "        for (int a = 0; a < axes; a++) {\n"
    "            int above = corner >> a & 1;\n"
    "            w *= above ? weight[a] : 1.0f - weight[a];\n"
    "            at += above ? stride[a] : 0;\n"
    "        }\n"
    "        for (int c = 0; c < count; c++) value[c] += w * table[at * channels + c];\n"
    "    }\n"
    "}\n";

static const char critical_text[] =
    "\n/* The cosine below which light is totally reflected on its way into index eta < 1; else 0. */\n"
    "%sfloat lacquer_cosine(float eta) { return %s(%s((1.0%s - eta) * (1.0%s + eta), 0.0%s)); }\n"
    "\n/* mu measured from that cosine, in [-1, 1]. */\n"
    "%sfloat lacquer_critical(float mu, float eta)\n{\n"
    "    float c = lacquer_cosine(eta);\n"
    "    if (mu < c) return -%s(1.0%s - mu / c);\n"
    "    return c < 1.0%s ? %s((mu - c) / (1.0%s - c)) : 1.0%s;\n}\n";
static const char clamp_text[] = "\nstatic inline float lacquer_clamp(float x, float low, float high)\n{\n"
                                 "    return x < low ? low : x > high ? high : x;\n}\n";

void lq_print_helpers(FILE *out, lq_language language) {
    static const char *const heads[LQ_SOURCE_LANGUAGES] = {glsl_head, hlsl_head, c_head};
    const bool c = language == LQ_C;
    const char *f = c ? "f" : "", *root = c ? "sqrtf" : "sqrt", *most = c ? "fmaxf" : "max";
    const char *storage = c ? "static inline " : "";
    fputs(heads[language], out);
    if (c) fputs(clamp_text, out);
    fprintf(out, critical_text, storage, root, most, f, f, f, storage, root, f, f, root, f, f);
}

void lq_print_number(FILE *out, double value, lq_language language) {
    char text[LQ_LITERAL_SIZE];
    fputs(lq_literal(value, language, text), out);
}

/* ((x - min) / range) clamped, through the inverse of the axis' map. */
void lq_print_coordinate(FILE *out, const lq_axis *axis, const char *value, lq_language language) {
    static const char *const clamps[] = {"clamp(", "saturate(", "lacquer_clamp01("};
    static const char *const roots[] = {"sqrt(", "sqrt(", "sqrtf("};
    static const char *const powers[] = {"pow(", "pow(", "powf("};
    const bool bent = axis->exponent != 1.0, root = axis->exponent == 2.0;
    if (bent) fputs(root ? roots[language] : powers[language], out);
    fprintf(out, "%s", clamps[language]);
    if (axis->min != 0.0) fprintf(out, "(%s - ", value), lq_print_number(out, axis->min, language);
    else fprintf(out, "%s", value);
    if (axis->min != 0.0) fputc(')', out);
    if (axis->max - axis->min != 1.0)
        fputs(" / ", out), lq_print_number(out, axis->max - axis->min, language);
    fputs(language == LQ_GLSL ? ", 0.0, 1.0)" : ")", out);
    if (bent && !root) fputs(", ", out), lq_print_number(out, 1.0 / axis->exponent, language);
    if (bent) fputc(')', out);
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
