/* factored_source.c - the decode function of a factored table, in GLSL, HLSL or C.
 *
 * Texture t0_1 holds the bases of factor 1 of piece 0, b0_1_k the four of its layer k, filtered. */
#include "pack/factored.h"
#include "pack/source_text.h"

#include <string.h>

/* One value: no argument, but a name that the rest may use. */
static bool is_fixed(const lq_factored *factored, int axis) {
    return factored->axes[axis].min == factored->axes[axis].max;
}

static void print_fixed(FILE *out, const lq_factored *factored, int axis, lq_language language) {
    const char *name = factored->axes[axis].name;
    fprintf(out, "    float %s = ", name);
    lq_print_number(out, factored->axes[axis].min, language);
    fputs(";\n", out);
    if (language == LQ_C) fprintf(out, "    (void)%s;\n", name);
}

static void print_clamped(FILE *out, const lq_factored *factored, lq_language language) {
    static const char *const clamps[] = {"clamp", "clamp", "lacquer_clamp"};
    for (int a = 0; a < factored->axis_count; a++) {
        const char *name = factored->axes[a].name;
        if (is_fixed(factored, a)) {
            print_fixed(out, factored, a, language);
            continue;
        }
        fprintf(out, "    %s = %s(%s, ", name, clamps[language], name);
        lq_print_number(out, factored->axes[a].min, language);
        fputs(", ", out);
        lq_print_number(out, factored->axes[a].max, language);
        fputs(");\n", out);
    }
}

/* The value that a texture axis measures, as an expression. */
static void name_coordinate(const lq_factored *factored, const lq_texture_axis *axis, char *text,
                            size_t size) {

    const char *name = factored->axes[axis->axis].name;
    if (axis->coordinate == LQ_COORDINATE_AXIS) snprintf(text, size, "%s", name);
    else if (axis->coordinate == LQ_COORDINATE_COSINE) snprintf(text, size, "lacquer_cosine(%s)", name);
    else snprintf(text, size, "lacquer_critical(%s, %s)", name, factored->axes[axis->other].name);
}

static void print_axis(FILE *out, const lq_factored *factored, const lq_texture_axis *axis,
                       lq_language language) {
    char text[128];
    name_coordinate(factored, axis, text, sizeof text);
    if (axis->texels.size == 1) fputs(language == LQ_C ? "0.0f" : "0.0", out);
    else lq_print_coordinate(out, &axis->texels, text, language);
}

static void print_fetch_c(FILE *out, const lq_factored *factored, const lq_bases *bases, const char *indent) {
    const lq_factor *factor = &factored->pieces[bases->piece].factors[bases->factor];
    const lq_image *image = &bases->image;
    const char *id = bases->suffix;
    fprintf(out, "%sconst int n%s[] = {%zu, %zu};\n%sconst float u%s[] = {", indent, id, image->width,
            image->height, indent, id);
    for (int a = 0; a < factor->axis_count; a++) {
        if (a > 0) fputs(", ", out);
        print_axis(out, factored, &factor->axes[a], LQ_C);
    }
    fprintf(out, "};\n%sfloat b%s[%zu];\n", indent, id, image->layers * LQ_BASES_PER_LAYER);
    for (size_t k = 0; k < image->layers; k++)
        fprintf(out, "%slacquer_filter(t%s + %zu, %d, n%s, u%s, 4, 4, b%s + %zu);\n", indent, id,
                k * image->width * image->height * LQ_BASES_PER_LAYER, factor->axis_count, id, id, id,
                k * LQ_BASES_PER_LAYER);
}

static void print_fetch(FILE *out, lq_language language, const lq_factored *factored, const lq_bases *bases,
                        const char *indent) {
    const lq_factor *factor = &factored->pieces[bases->piece].factors[bases->factor];
    const bool glsl = language == LQ_GLSL;
    const char *id = bases->suffix;
    for (int a = 0; a < 2; a++) {
        fprintf(out, "%sfloat %c%s = ", indent, "uv"[a], id);
        if (a >= factor->axis_count) {
            fputs("0.5;\n", out);
            continue;
        }
        fputs("lacquer_texel(", out);
        print_axis(out, factored, &factor->axes[a], language);
        fprintf(out, ", %zu.0);\n", factor->axes[a].texels.size);
    }
    for (size_t k = 0; k < bases->image.layers; k++) {
        fprintf(out, "%s%s b%s_%zu = ", indent, glsl ? "vec4" : "float4", id, k);
        if (glsl) fprintf(out, "textureLod(t%s, vec3(u%s, v%s, %zu.0), 0.0);\n", id, id, id, k);
        else fprintf(out, "t%s.SampleLevel(linear_clamp, float3(u%s, v%s, %zu.0), 0.0);\n", id, id, id, k);
    }
}

/* A stream: products of bases, a few a line. */
static void print_stream(FILE *out, lq_language language, const lq_factored *factored, int p, int k,
                         const char *indent) {
    enum { PER_LINE = 3 };
    const lq_term_sum *sum = &factored->pieces[p].streams[k];
    fprintf(out, "%sfloat s%d = ", indent, k);
    if (sum->term_count == 0) fputs(language == LQ_C ? "0.0f" : "0.0", out);
    for (size_t t = 0; t < sum->term_count; t++) {
        if (t > 0) fprintf(out, t % PER_LINE == 0 ? "\n%s         + " : " + ", indent);
        for (int g = 0; g < sum->factor_count; g++) {
            const int base = sum->index[t * (size_t)sum->factor_count + (size_t)g], f = sum->factors[g];
            if (g > 0) fputs(" * ", out);
            if (language == LQ_C) fprintf(out, "b%d_%d[%d]", p, f, base);
            else
                fprintf(out, "b%d_%d_%d.%c", p, f, base / LQ_BASES_PER_LAYER,
                        "xyzw"[base % LQ_BASES_PER_LAYER]);
        }
    }
    fputs(";\n", out);
}

static void print_value(FILE *out, lq_language language, const lq_factored *factored, const lq_piece *piece,
                        const char *indent) {
    const char *clamp = language == LQ_C ? "lacquer_clamp" : "clamp", *f = language == LQ_C ? "f" : "";
    fprintf(out, "%sreturn %s(", indent, clamp);
    if (piece->value == LQ_VALUE_SQUARE) fputs("s0 * s0", out);
    else if (piece->value == LQ_VALUE_BEER)
        fprintf(out, "s0 * pow%s(%s, exp2%s(s1))", f, factored->axes[piece->value_axis].name, f);
    else fputs("s0", out);
    fputs(", ", out);
    lq_print_number(out, factored->value_min, language);
    fputs(", ", out);
    lq_print_number(out, factored->value_max, language);
    fputs(");\n", out);
}

/* The sides of the box that are not the table's own. */
static void print_condition(FILE *out, lq_language language, const lq_factored *factored,
                            const lq_piece *piece) {
    bool first = true;
    fputs("    if (", out);
    for (int a = 0; a < factored->axis_count; a++)
        for (int upper = 0; upper < 2; upper++) {
            const double side = upper ? piece->max[a] : piece->min[a];
            if (side == (upper ? factored->axes[a].max : factored->axes[a].min)) continue;
            fprintf(out, "%s%s %s ", first ? "" : " && ", factored->axes[a].name, upper ? "<=" : ">=");
            lq_print_number(out, side, language);
            first = false;
        }
    fputs(first ? "true) {\n" : ") {\n", out);
}

static void print_arguments(FILE *out, lq_language language, const lq_factored_textures *textures) {
    static const char *const types[] = {"sampler2DArray ", "Texture2DArray<float4> ", "const float *"};
    for (size_t i = 0; i < textures->count; i++)
        fprintf(out, "%s%st%s", i > 0 ? ", " : "", types[language], textures->bases[i].suffix);
    if (language == LQ_HLSL) fputs(", SamplerState linear_clamp", out);
    for (int a = 0; a < textures->factored->axis_count; a++)
        if (!is_fixed(textures->factored, a)) fprintf(out, ", float %s", textures->factored->axes[a].name);
}

static void print_comment(FILE *out, const lq_factored_textures *textures, const lq_kind *kind) {
    fprintf(out, "\n/* %s: %s\n *   %s   [%s]\n", textures->name, kind->title, kind->quantity, kind->source);
    for (size_t i = 0; i < textures->count; i++) {
        const lq_image *image = &textures->bases[i].image;
        fprintf(out, " *   t%s: file %s.%s, %zu x %zu texels, %zu layers of 4 bases\n",
                textures->bases[i].suffix, textures->stem, textures->bases[i].suffix, image->width,
                image->height, image->layers);
    }
    for (int a = 0; a < kind->axis_count; a++)
        fprintf(out, " *   %s: %s, %g to %g\n", kind->axes[a].name, kind->axes[a].meaning,
                textures->factored->axes[a].min, textures->factored->axes[a].max);
    fputs(" */\n", out);
}

void lq_factored_source(FILE *out, lq_language language, const lq_factored_textures *textures,
                        const lq_kind *kind) {
    const lq_factored *factored = textures->factored;
    print_comment(out, textures, kind);
    fprintf(out, "%sfloat lacquer_%s(", language == LQ_C ? "static inline " : "", textures->name);
    print_arguments(out, language, textures);
    fputs(language == LQ_C ? ") {\n" : ")\n{\n", out);
    print_clamped(out, factored, language);
    for (int p = 0; p < factored->piece_count; p++) {
        const lq_piece *piece = &factored->pieces[p];
        const bool last = p == factored->piece_count - 1;
        const char *indent = last ? "    " : "        ";
        if (!last) print_condition(out, language, factored, piece);
        for (size_t i = 0; i < textures->count; i++) {
            if (textures->bases[i].piece != p) continue;
            if (language == LQ_C) print_fetch_c(out, factored, &textures->bases[i], indent);
            else print_fetch(out, language, factored, &textures->bases[i], indent);
        }
        for (int k = 0; k < piece->stream_count; k++) print_stream(out, language, factored, p, k, indent);
        print_value(out, language, factored, piece, indent);
        if (!last) fputs("    }\n", out);
    }
    fputs("}\n", out);
}
