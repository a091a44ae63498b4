/* source_text.c - pieces of decode source that several functions are made of. */
#include "pack/source_text.h"

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
