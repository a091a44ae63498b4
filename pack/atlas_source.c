/* atlas_source.c - heads, helpers and functions of tables in the decode source of an atlas. */
#include "pack/atlas_source.h"
#include "pack/general_source.h"

#include <stdlib.h>
#include <string.h>

#include "system/draft.h"
#include "system/output.h"
#include "system/status.h"

/* ======================================================================================
 *                                       Helpers
 * ====================================================================================== */

static const char c_types[] =
    "#include <math.h>\n\n"
    "typedef struct lacquer_vec2 { float x, y; } lacquer_vec2;\n"
    "typedef struct lacquer_vec3 { float x, y, z; } lacquer_vec3;\n"
    "typedef struct lacquer_vec4 { float x, y, z, w; } lacquer_vec4;\n\n"
    "static inline lacquer_vec2 lacquer_make2(float x, float y) { lacquer_vec2 v; v.x = x; v.y = y; return "
    "v; }\n"
    "static inline lacquer_vec3 lacquer_make3(float x, float y, float z)\n{\n"
    "    lacquer_vec3 v; v.x = x; v.y = y; v.z = z; return v;\n}\n"
    "static inline lacquer_vec4 lacquer_make4(float x, float y, float z, float w)\n{\n"
    "    lacquer_vec4 v; v.x = x; v.y = y; v.z = z; v.w = w; return v;\n}\n"
    "static inline float lacquer_clamp(float x, float low, float high)\n{\n"
    "    return x < low ? low : x > high ? high : x;\n}\n"
    "static inline float lacquer_mix(float a, float b, float t) { return a + (b - a) * t; }\n\n";

static const char *const heads[LQ_LANGUAGES] = {
    [LQ_GLSL] =
        "/* In WebGL2 after #version 300 es. `atlas`: linear filtering, clamp to edge, no mip levels. */\n",
    [LQ_HLSL] =
        "/* `atlas` is atlas.*, `linear_clamp` a sampler with linear filtering, clamp, no mip levels. */\n",
    [LQ_C] = "/* C99 and C++. `atlas` is the array of the pack's C header, lacquer_atlas_texels. */\n",
    [LQ_VULKAN] =
        "/* GLSL 4.50 for Vulkan, texture and sampler apart: linear filtering, clamp, no mip levels. */\n",
    [LQ_WGSL] = "/* `atlas` is atlas.*, `linear_clamp` a sampler with linear filtering, clamp-to-edge. */\n",
    [LQ_METAL] = "/* `atlas` is atlas.*, `linear_clamp` a sampler with linear filtering, clamp_to_edge. */\n",
};

static void say_begin(FILE *out, lq_language language) {
    fputs("/* Decode functions, made by lacquer " LQ_VERSION ".\n"
          " * An argument outside the range that is said is taken to its end. With LACQUER_CHECK a material\n"
          " * becomes magenta there, and a table 65504 (in C: NaN). */\n",
          out);
    fputs(heads[language], out);
    if (language == LQ_WGSL) fputs("override LACQUER_CHECK: bool = false;\n\n", out);
    else fputs("#ifndef LACQUER_DECODE\n#define LACQUER_DECODE\n\n", out);
    if (language == LQ_GLSL)
        fputs("#ifdef GL_ES\nprecision highp float;\nprecision highp sampler2D;\n#endif\n\n", out);
    if (language == LQ_METAL) fputs("#include <metal_stdlib>\n\n", out);
    if (language == LQ_C) fputs(c_types, out);
}

/* tile: its first texel, and its texels less one, to which u and v in [0,1] count. */
static void say_fetch(FILE *out, lq_language language, const lq_image *atlas) {
    static const char *const calls[LQ_LANGUAGES] = {
        [LQ_GLSL] = "textureLod(atlas, vec2(x, y), 0.0)",
        [LQ_HLSL] = "atlas.SampleLevel(linear_clamp, float2(x, y), 0.0)",
        [LQ_VULKAN] = "textureLod(sampler2D(atlas, linear_clamp), vec2(x, y), 0.0)",
        [LQ_WGSL] = "textureSampleLevel(atlas, linear_clamp, vec2f(x, y), 0.0)",
        [LQ_METAL] = "atlas.sample(linear_clamp, metal::float2(x, y), metal::level(0.0f))",
    };
    fputs("/* A tile: its first texel x and y, its texels less one z and w; u and v in [0,1] are its outer "
          "texels. */\n",
          out);
    if (language != LQ_C) {
        lq_say(out, language,
               "$(4 lacquer_fetch|A|4 tile|1 u|1 v$)\n{\n"
               "    $=1 x = (tile.x + u * tile.z + 0.5$f) / %zu.0$f;\n"
               "    $=1 y = (tile.y + v * tile.w + 0.5$f) / %zu.0$f;\n"
               "    return %s;\n}\n",
               atlas->width, atlas->height, calls[language]);
        return;
    }
    fprintf(out,
            "static inline lacquer_vec4 lacquer_fetch(const float *atlas, lacquer_vec4 tile, float u, float "
            "v)\n{\n"
            "    const float x = u * tile.z, y = v * tile.w;\n"
            "    if (!(x >= 0.0f && y >= 0.0f)) return lacquer_make4(x + y, x + y, x + y, x + y); /* NaN */\n"
            "    const int left = x < tile.z - 1.0f ? (int)x : tile.z >= 1.0f ? (int)tile.z - 1 : 0;\n"
            "    const int low = y < tile.w - 1.0f ? (int)y : tile.w >= 1.0f ? (int)tile.w - 1 : 0;\n"
            "    const float s = x - (float)left, t = y - (float)low;\n"
            "    const float *a = atlas + 4 * (((int)tile.y + low) * %zu + (int)tile.x + left), *b = a + 4 * "
            "%zu;\n"
            "    const float w00 = (1.0f - s) * (1.0f - t), w10 = s * (1.0f - t), w01 = (1.0f - s) * t, w11 "
            "= s * t;\n"
            "    return lacquer_make4(w00 * a[0] + w10 * a[4] + w01 * b[0] + w11 * b[4],\n"
            "                         w00 * a[1] + w10 * a[5] + w01 * b[1] + w11 * b[5],\n"
            "                         w00 * a[2] + w10 * a[6] + w01 * b[2] + w11 * b[6],\n"
            "                         w00 * a[3] + w10 * a[7] + w01 * b[3] + w11 * b[7]);\n}\n",
            atlas->width, atlas->width);
}

static const char critical_text[] =
    "\n/* The cosine below which light is totally reflected on its way into index eta < 1; else 0. */\n"
    "$(1 lacquer_cosine|1 eta$)\n{\n"
    "    return @sqrt(@max((1.0$f - eta) * (1.0$f + eta), 0.0$f));\n}\n"
    "\n/* mu measured from that cosine, in [-1, 1]. */\n"
    "$(1 lacquer_critical|1 mu|1 eta$)\n{\n"
    "    $=1 c = lacquer_cosine(eta);\n"
    "    if (mu < c) { return -@sqrt(1.0$f - mu / c); }\n"
    "    if (c < 1.0$f) { return @sqrt((mu - c) / (1.0$f - c)); }\n"
    "    return 1.0$f;\n}\n";

void lq_say_tile(FILE *out, lq_language language, const lq_tile *tile, size_t rows) {
    lq_say(out, language, "$c4(%zu.0$f, %zu.0$f, %zu.0$f, %zu.0$f)", tile->x, tile->y, tile->image->width - 1,
           rows - 1);
}

void lq_say_coordinate(FILE *out, lq_language language, const lq_axis *axis, const char *value) {
    char min[LQ_LITERAL_SIZE], range[LQ_LITERAL_SIZE], power[LQ_LITERAL_SIZE], text[512];
    lq_literal(axis->min, language, min);
    lq_literal(axis->max - axis->min, language, range);
    lq_literal(1.0 / axis->exponent, language, power);
    const char *minus = axis->min != 0.0 ? " - " : "", *over = axis->max - axis->min != 1.0 ? " / " : "";
    snprintf(text, sizeof text, "@clamp(%s%s%s%s%s%s%s, 0.0$f, 1.0$f)", *minus ? "(" : "", value, minus,
             *minus ? min : "", *minus ? ")" : "", over, *over ? range : "");
    if (axis->exponent == 1.0) lq_say(out, language, "%s", text);
    else if (axis->exponent == 2.0) lq_say(out, language, "@sqrt(%s)", text);
    else lq_say(out, language, "@pow(%s, %s)", text, power);
}

void lq_say_check(FILE *out, lq_language language, const lq_argument *checks, size_t count,
                  const char *value) {
    char low[LQ_LITERAL_SIZE], high[LQ_LITERAL_SIZE];
    if (count == 0) return;
    fputs(language == LQ_WGSL ? "    if (LACQUER_CHECK && !(" : "#ifdef LACQUER_CHECK\n    if (!(", out);
    for (size_t i = 0; i < count; i++)
        fprintf(out, "%s%s >= %s && %s <= %s", i > 0 ? " && " : "", checks[i].name,
                lq_literal(checks[i].min, language, low), checks[i].name,
                lq_literal(checks[i].max, language, high));
    fprintf(out, ")) { return %s; }\n%s", value, language == LQ_WGSL ? "" : "#endif\n");
}

/* ======================================================================================
 *                                        Tables
 * ====================================================================================== */

static const char *outside(lq_language language, int channels) {
    static const char *const shader[] = {"65504.0", "$c2(65504.0$f, 65504.0$f)",
                                         "$c3(65504.0$f, 65504.0$f, 65504.0$f)",
                                         "$c4(65504.0$f, 65504.0$f, 65504.0$f, 65504.0$f)"};
    static const char *const c[] = {"NAN", "lacquer_make2(NAN, NAN)", "lacquer_make3(NAN, NAN, NAN)",
                                    "lacquer_make4(NAN, NAN, NAN, NAN)"};
    return language == LQ_C ? c[channels - 1] : shader[channels - 1];
}

void lq_say_outside(FILE *out, lq_language language, const lq_argument *checks, size_t count, int channels) {
    lq_draft text = {.text = NULL};
    FILE *value = lq_draft_open(&text);
    if (value) lq_say(value, language, "%s", outside(language, channels));
    if (value && lq_draft_close(&text, value)) lq_say_check(out, language, checks, count, text.text);
    else lq_draft_fail(out);
    free(text.text);
}

void lq_say_comment(FILE *out, const char *name, const lq_kind *kind) {
    fprintf(out, "\n/* %s: %s\n *   %s   [%s]", name, kind->title, kind->quantity, kind->source);
}

static void say_texture(FILE *out, lq_language language, const lq_texture *texture, const lq_kind *kind,
                        const lq_tile *tile) {
    const char c[] = {"xyzw"[tile->channel], "xyzw"[(tile->channel + 1) % 4],
                      "xyzw"[(tile->channel + 2) % 4]};
    lq_argument checks[LQ_TEXTURE_AXES];
    char head[256];
    int used = snprintf(head, sizeof head, "$(%d lacquer_%s|A", texture->channel_count, texture->name);
    lq_say_comment(out, texture->name, kind);
    for (int a = 0; a < texture->axis_count; a++) {
        const lq_axis *axis = &texture->axes[a];
        fprintf(out, "\n *   %s: %s, %g to %g", axis->name, kind->axes[texture->from[a]].meaning, axis->min,
                axis->max);
        checks[a] = (lq_argument){axis->name, axis->min, axis->max};
        used += snprintf(head + used, sizeof head - (size_t)used, "|1 %s", axis->name);
    }
    fputs(" */\n", out);
    lq_say(out, language, "%s$)\n{\n", head);
    lq_say_outside(out, language, checks, (size_t)texture->axis_count, texture->channel_count);
    fprintf(out, "    ");
    lq_say(out, language, "$=4 t = lacquer_fetch($a, ");
    lq_say_tile(out, language, tile, tile->image->height);
    for (int a = 0; a < LQ_TEXTURE_AXES - 1; a++) {
        fputs(", ", out);
        if (a < texture->axis_count)
            lq_say_coordinate(out, language, &texture->axes[a], texture->axes[a].name);
        else lq_say(out, language, "0.0$f");
    }
    lq_say(out, language, ");\n");
    if (texture->channel_count == 1) fprintf(out, "    return t.%c;\n}\n", c[0]);
    else if (texture->channel_count == 2)
        lq_say(out, language, "    return $c2(t.%c, t.%c);\n}\n", c[0], c[1]);
    else if (texture->channel_count == 3)
        lq_say(out, language, "    return $c3(t.%c, t.%c, t.%c);\n}\n", c[0], c[1], c[2]);
    else fputs("    return t;\n}\n", out);
}

/* The most that any of its pieces takes. */
size_t lq_atlas_table_fetches(const lq_atlas_table *table) {
    size_t most = 1;
    if (table->table.texture) return most;
    const lq_factored_textures *textures = table->table.factored;
    for (int p = 0; p < textures->factored->piece_count; p++) {
        size_t count = 0;
        for (size_t i = 0; i < textures->count; i++)
            if (textures->bases[i].piece == p) count += textures->bases[i].image.layers;
        most = count > most ? count : most;
    }
    return most;
}

/* ======================================================================================
 *                                       The file
 * ====================================================================================== */

static void say_all(FILE *out, lq_language language, const lq_atlas_contents *contents) {
    say_begin(out, language);
    say_fetch(out, language, &contents->atlas->image);
    lq_say(out, language, "%s", critical_text);
    for (size_t i = 0; i < contents->table_count; i++) {
        const lq_source_table *table = &contents->tables[i].table;
        const lq_tile *tiles = &contents->atlas->tiles[contents->tables[i].tile];
        if (table->texture) say_texture(out, language, table->texture, table->kind, tiles);
        else lq_say_factored(out, language, table->factored, table->kind, tiles);
    }
    const lq_general general = lq_general_find(contents);
    if (contents->material_count > 0 || lq_general_any(&general))
        lq_say_lobes(out, language, contents, general.albedo ? general.albedo->table.texture->name : NULL);
    lq_say_general(out, language, &general);
    if (language != LQ_WGSL) fputs("\n#endif\n", out);
}

lq_status lq_atlas_source_text(lq_language language, const lq_atlas_contents *contents, char **text,
                               lq_error *error) {
    lq_draft draft = {.text = NULL};
    FILE *out = lq_draft_open(&draft);
    *text = NULL;
    if (!out) return lq_fail(error, LQ_NO_MEMORY, "no memory for decode source");
    say_all(out, language, contents);
    const bool whole = lq_draft_close(&draft, out);
    *text = draft.text;
    return whole ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for decode source");
}

lq_status lq_atlas_source_write(lq_language language, const lq_atlas_contents *contents, const char *path,
                                lq_error *error) {
    char *text;
    lq_status status = lq_atlas_source_text(language, contents, &text, error);
    if (status == LQ_OK) status = lq_output_save(path, text, strlen(text), error);
    free(text);
    return status;
}
