/* lobes_source.c - one function a material, and what shades with its lobes. */
#include "pack/atlas_source.h"

#include <stdio.h>
#include <string.h>

/* ======================================================================================
 *                                  What all materials share
 * ====================================================================================== */

static void say_struct(FILE *out, lq_language language) {
    const char *fields[][2] = {{"3", "top"},         {"1", "top_alpha"}, {"3", "inner"},
                               {"1", "inner_alpha"}, {"3", "base"},      {"1", "base_alpha"}};
    fputs(
        "\n/* What a material does to light that arrives at cosine mu: energies (flux reflected / arriving) "
        "and GGX\n"
        " * roughness of its lobes. top: reflected at once by the top interface. inner: was inside, about "
        "the\n"
        " * mirrored direction. base: left a Lambertian base, about the normal. Those it has not are 0. */\n",
        out);
    fprintf(out, "%s%s {\n", language == LQ_C ? "typedef struct " : "struct ",
            language == LQ_C ? "lacquer_lobes" : "LacquerLobes");
    for (int i = 0; i < 6; i++) {
        const char type[] = {'$', fields[i][0][0], '\0'};
        fputs("    ", out);
        if (language == LQ_WGSL) fprintf(out, "%s: ", fields[i][1]);
        lq_say(out, language, "%s", type);
        if (language == LQ_WGSL) fputs(",\n", out);
        else fprintf(out, " %s;\n", fields[i][1]);
    }
    fputs(language == LQ_C ? "} lacquer_lobes;\n" : language == LQ_WGSL ? "}\n" : "};\n", out);
}

static const char slices_text[] =
    "\n/* Between two slices of a tile, `pitch` texels below each other; w in [0,1] over all of them. */\n"
    "$(4 lacquer_slices|A|4 tile|1 pitch|1 slices|1 u|1 v|1 w$)\n{\n"
    "    $=1 s = w * (slices - 1.0$f);\n"
    "    $=1 k = @min(@floor(s), slices - 2.0$f);\n"
    "    $=1 t = s - k;\n"
    "    $=4 a = lacquer_fetch($a, $c4(tile.x, tile.y + k * pitch, tile.z, tile.w), u, v);\n"
    "    $=4 b = lacquer_fetch($a, $c4(tile.x, tile.y + (k + 1.0$f) * pitch, tile.z, tile.w), u, v);\n"
    "    return $c4(@mix(a.x, b.x, t), @mix(a.y, b.y, t), @mix(a.z, b.z, t), @mix(a.w, b.w, t));\n}\n";

static const char base_text[] = "\n/* Through the layers to a base of albedo rho and out again, with all "
                                "reflections between (D22 eq. 3). */\n"
                                "$(1 lacquer_base|1 through|1 rho|1 back$)\n{\n"
                                "    return through * rho / (1.0$f - rho * back);\n}\n";

/* The lobe that the roughnesses are for. */
static const char shade_text[] =
    "\n/* The GGX lobe D G2 / (4 mu_in), a BRDF times the cosine mu_out, cos_h that of the half vector; 0 "
    "for light "
    "from\n * below. 1 - cos_h^2 is written so that a narrow lobe keeps its digits. */\n"
    "$(1 lacquer_lobe|1 mu_in|1 mu_out|1 cos_h|1 alpha$)\n{\n"
    "    $=1 a2 = @max(alpha * alpha, 1e-7$f);\n"
    "    $=1 d = cos_h * cos_h * a2 + @max((1.0$f - cos_h) * (1.0$f + cos_h), 0.0$f);\n"
    "    $=1 i = @max(mu_in, 1e-4$f);\n"
    "    $=1 o = @max(mu_out, 0.0$f);\n"
    "    $=1 si = @sqrt(a2 + (1.0$f - a2) * i * i);\n"
    "    $=1 so = @sqrt(a2 + (1.0$f - a2) * o * o);\n"
    "    return a2 / (3.14159265$f * d * d) * o / (2.0$f * (o * si + i * so));\n}\n"
    "\n/* All lobes of a material together: BRDF times the cosine of the light, from the cosines of the view "
    "(the\n"
    " * one that the lobes were asked for), the light and the half vector to the normal. */\n"
    "$(3 lacquer_shade|A|L lobes|1 mu_view|1 mu_light|1 cos_h$)\n{\n"
    "    $=1 mu = @clamp(mu_view, 0.0$f, 1.0$f);\n"
    "    $=1 top = lacquer_lobe(mu_view, mu_light, cos_h, lobes.top_alpha)\n"
    "        / lacquer_%s($a, mu, lobes.top_alpha);\n"
    "    $=1 inner = lacquer_lobe(mu_view, mu_light, cos_h, lobes.inner_alpha)\n"
    "        / lacquer_%s($a, mu, lobes.inner_alpha);\n"
    "    $=1 base = lacquer_lobe(1.0$f, mu_light, @sqrt(0.5$f + 0.5$f * mu_light), lobes.base_alpha)\n"
    "        / lacquer_%s($a, 1.0$f, lobes.base_alpha);\n"
    "    return $c3(lobes.top.x * top + lobes.inner.x * inner + lobes.base.x * base,\n"
    "        lobes.top.y * top + lobes.inner.y * inner + lobes.base.y * base,\n"
    "        lobes.top.z * top + lobes.inner.z * inner + lobes.base.z * base);\n}\n";

static const char magenta_text[] = "\n/* What LACQUER_CHECK makes of an argument outside its range. */\n"
                                   "$(L lacquer_outside$)\n{\n"
                                   "    $~L l;\n"
                                   "    l.top = $c3(%s);\n"
                                   "    l.inner = $c3(%s);\n"
                                   "    l.base = $c3(%s);\n"
                                   "    l.top_alpha = 1.0$f;\n"
                                   "    l.inner_alpha = 1.0$f;\n"
                                   "    l.base_alpha = 1.0$f;\n"
                                   "    return l;\n}\n";

/* ======================================================================================
 *                                      A material
 * ====================================================================================== */

/* A number as an expression: a channel of a fetch, or a literal. */
static const char *number(const lq_lobes *lobes, int k, lq_language language, char text[LQ_LITERAL_SIZE]) {
    const int channel = lobes->channel[k];
    if (channel < 0) return lq_literal(lobes->constant[k], language, text);
    snprintf(text, LQ_LITERAL_SIZE, "t%d.%c", channel / LQ_LOBES_PER_TEXEL,
             "xyzw"[channel % LQ_LOBES_PER_TEXEL]);
    return text;
}

static void say_energy(FILE *out, lq_language language, const lq_lobes *lobes, const char *field, int first) {
    char text[3][LQ_LITERAL_SIZE];
    lq_say(out, language, "    l.%s = $c3(%s, %s, %s);\n", field, number(lobes, first, language, text[0]),
           number(lobes, first + 1, language, text[1]), number(lobes, first + 2, language, text[2]));
}

static void say_base(FILE *out, lq_language language, const lq_lobes *lobes) {
    char through[LQ_LITERAL_SIZE], back[LQ_LITERAL_SIZE], low[LQ_LITERAL_SIZE], high[LQ_LITERAL_SIZE];
    if (!lobes->material->open_rho) {
        say_energy(out, language, lobes, "base", LQ_MATERIAL_THROUGH);
        return;
    }
    lq_literal(lobes->material->rho_min, language, low);
    lq_literal(lobes->material->rho_max, language, high);
    lq_say(out, language, "    l.base = $c3(");
    for (int c = 0; c < LQ_MATERIAL_COLOURS; c++)
        lq_say(out, language, "%slacquer_base(%s, @clamp(rho.%c, %s, %s), %s)", c > 0 ? ",\n        " : "",
               number(lobes, LQ_MATERIAL_THROUGH + c, language, through), "xyz"[c], low, high,
               number(lobes, LQ_MATERIAL_BACK + c, language, back));
    fputs(");\n", out);
}

static void say_top_alpha(FILE *out, lq_language language, const lq_material *m) {
    char low[LQ_LITERAL_SIZE], high[LQ_LITERAL_SIZE];
    if (m->top_range < 0) {
        fprintf(out, "    l.top_alpha = %s;\n", lq_literal(m->top_alpha, language, low));
        return;
    }
    const lq_material_range *range = &m->ranges[m->top_range];
    lq_say(out, language, "    l.top_alpha = @clamp(%s, %s, %s);\n", range->name,
           lq_literal(range->min, language, low), lq_literal(range->max, language, high));
}

static void say_fetches(FILE *out, lq_language language, const lq_lobes *lobes, const lq_tile *tiles) {
    const lq_material *m = lobes->material;
    if (lobes->channel_count == 0) {
        if (language == LQ_C || language == LQ_METAL) fputs("    (void)atlas;\n    (void)mu;\n", out);
        if (language == LQ_METAL) fputs("    (void)linear_clamp;\n", out);
        return;
    }
    for (int a = 0; a < lobes->axis_count; a++) {
        lq_say(out, language, "    $=1 %c = ", "uvw"[a]);
        lq_say_coordinate(out, language, &lobes->axes[a], lobes->axes[a].name);
        fputs(";\n", out);
    }
    const size_t rows = lobes->axis_count > 1 ? lobes->axes[1].size : 1;
    const char *v = lobes->axis_count > 1 ? "v" : "0.0$f";
    for (size_t t = 0; t < lobes->texels; t++) {
        const bool sliced = m->range_count > 1;
        lq_say(out, language, "    $=4 t%zu = %s($a, ", t, sliced ? "lacquer_slices" : "lacquer_fetch");
        lq_say_tile(out, language, &tiles[t], rows);
        if (sliced) lq_say(out, language, ", %zu.0$f, %zu.0$f", lq_lobes_pitch(lobes), lobes->axes[2].size);
        lq_say(out, language, ", u, %s%s);\n", v, sliced ? ", w" : "");
    }
}

/* What a material takes: the comment, the head of its function and the check of its arguments. */
static void say_arguments(FILE *out, lq_language language, const lq_material *m, const char *name) {
    static const char *const rho[LQ_MATERIAL_COLOURS] = {"rho.x", "rho.y", "rho.z"};
    lq_argument checks[1 + LQ_MATERIAL_RANGES + LQ_MATERIAL_COLOURS] = {{"mu", 0.0, 1.0}};
    size_t count = 1;
    char head[512];
    int used = snprintf(head, sizeof head, "$(L lacquer_%s|A|1 mu", name);
    for (int r = 0; r < m->range_count; r++) {
        const lq_material_range *range = &m->ranges[r];
        fprintf(out, "\n *   %s: layer %s, %g to %g", range->name, range->path, range->min, range->max);
        checks[count++] = (lq_argument){range->name, range->min, range->max};
        used += snprintf(head + used, sizeof head - (size_t)used, "|1 %s", range->name);
    }
    if (m->open_rho) {
        fprintf(out, "\n *   rho: albedo of the base, %g to %g", m->rho_min, m->rho_max);
        snprintf(head + used, sizeof head - (size_t)used, "|3 rho");
        for (int c = 0; c < LQ_MATERIAL_COLOURS; c++)
            checks[count++] = (lq_argument){rho[c], m->rho_min, m->rho_max};
    }
    fputs(" */\n", out);
    lq_say(out, language, "%s$)\n{\n", head);
    lq_say_check(out, language, checks, count, "lacquer_outside()");
}

static void say_material(FILE *out, lq_language language, const lq_atlas_material *material,
                         const lq_tile *tiles) {
    const lq_lobes *lobes = material->lobes;
    const size_t fetches = lq_atlas_material_fetches(material);
    char text[LQ_LITERAL_SIZE];
    fprintf(out, "\n/* %s: %zu fetch%s.", material->name, fetches, fetches == 1 ? "" : "es");
    say_arguments(out, language, lobes->material, material->name);
    say_fetches(out, language, lobes, tiles);
    lq_say(out, language, "    $~L l;\n");
    say_energy(out, language, lobes, "top", LQ_MATERIAL_TOP);
    say_top_alpha(out, language, lobes->material);
    say_energy(out, language, lobes, "inner", LQ_MATERIAL_INNER);
    fprintf(out, "    l.inner_alpha = %s;\n", number(lobes, LQ_MATERIAL_INNER_ALPHA, language, text));
    say_base(out, language, lobes);
    fprintf(out, "    l.base_alpha = %s;\n    return l;\n}\n",
            number(lobes, LQ_MATERIAL_BASE_ALPHA, language, text));
}

size_t lq_atlas_material_fetches(const lq_atlas_material *material) {
    return material->lobes->texels * (material->lobes->axis_count > 2 ? 2 : 1);
}

void lq_say_lobes(FILE *out, lq_language language, const lq_atlas_contents *contents, const char *albedo) {
    const char *bad = language == LQ_C ? "NAN, NAN, NAN" : "1.0$f, 0.0$f, 1.0$f";
    const char *none = language == LQ_C ? bad : "0.0$f, 0.0$f, 0.0$f";
    bool sliced = false;
    say_struct(out, language);
    lq_say(out, language, magenta_text, bad, none, none);
    for (size_t i = 0; i < contents->material_count; i++)
        sliced = sliced || contents->materials[i].lobes->axis_count > 2;
    if (sliced) lq_say(out, language, "%s", slices_text);
    lq_say(out, language, "%s", base_text);
    if (albedo) lq_say(out, language, shade_text, albedo, albedo, albedo);
    for (size_t i = 0; i < contents->material_count; i++)
        say_material(out, language, &contents->materials[i],
                     &contents->atlas->tiles[contents->materials[i].tile]);
}
