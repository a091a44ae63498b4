/* general_source.c - conductor, coated Lambertian base (D22) and dielectric over conductor (B18) as functions
 * of the tables of a pack. */
#include "pack/general_source.h"

#include "pca/factors.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* ======================================================================================
 *                                  The tables they need
 * ====================================================================================== */

/* The range of an axis; false where the table's function does not take it. */
static bool range_of(const lq_atlas_table *table, int axis, double range[2]) {
    const lq_texture *texture = table->table.texture;
    if (!texture) {
        const lq_factored *factored = table->table.factored->factored;
        range[0] = factored->axes[axis].min;
        range[1] = factored->axes[axis].max;
        return range[0] < range[1];
    }
    for (int a = 0; a < texture->axis_count; a++) {
        if (texture->from[a] != axis) continue;
        range[0] = texture->axes[a].min;
        range[1] = texture->axes[a].max;
        return true;
    }
    return false;
}

static bool takes_all(const lq_atlas_table *table) {
    double range[2];
    for (int a = 0; a < table->table.kind->axis_count; a++)
        if (!range_of(table, a, range)) return false;
    return true;
}

/* As the lobes and models mean it: GGX, all orders. */
static bool is_usual(const lq_atlas_table *table) {
    if (table->table.texture) return table->table.texture->channel_count == table->table.kind->channel_count;
    const lq_factored *factored = table->table.factored->factored;
    const char *scattering = lq_factored_fact(factored, "scattering"),
               *ndf = lq_factored_fact(factored, "ndf");
    return table->table.kind->channel_count == 1 && (!ndf || strcmp(ndf, "ggx") == 0) &&
           (!scattering || strcmp(scattering, "multiple") == 0);
}

/* Tables that enter both sides of an interface: below says which, 1 the far side is denser. */
static bool has_side(const lq_atlas_table *table, int side) {
    double range[2];
    if (side == 0) return true;
    if (!range_of(table, 2, range)) return false;
    return side > 0 ? range[1] > 1.0 : range[0] < 1.0;
}

static const lq_atlas_table *find(const lq_atlas_contents *contents, const char *kind, int side) {
    for (size_t i = 0; i < contents->table_count; i++) {
        const lq_atlas_table *table = &contents->tables[i];
        if (strcmp(table->table.kind->id, kind) == 0 && takes_all(table) && is_usual(table) &&
            has_side(table, side))
            return table;
    }
    return NULL;
}

lq_general lq_general_find(const lq_atlas_contents *contents) {
    return (lq_general){
        .albedo = find(contents, "albedo", 0),
        .conductor = find(contents, "fgd", 0),
        .dielectric = find(contents, "fgd-dielectric", 1),
        .inside = find(contents, "fgd-dielectric", -1),
        .pass = find(contents, "tir-pass", -1),
        .f = find(contents, "f", 0),
        .inverse = find(contents, "f-inverse", 0),
        .enters = find(contents, "transmission", 1),
        .leaves = find(contents, "diffuse-transmission", 0),
        .returns = find(contents, "diffuse-reflection", 0),
        .variance = find(contents, "variance", 0),
    };
}

static bool coloured(const lq_atlas_table *table) {
    return table && !table->table.texture &&
           lq_factored_has_colours(table->table.factored, table->table.kind);
}

bool lq_general_has_conductor(const lq_general *g) {
    return coloured(g->conductor);
}

bool lq_general_has_coated_lambertian(const lq_general *g) {
    return g->dielectric && coloured(g->enters) && coloured(g->leaves) && coloured(g->returns) && g->variance;
}

bool lq_general_has_layered(const lq_general *g) {
    return g->dielectric && g->inside && g->pass && coloured(g->conductor) && g->f && g->inverse;
}

/* ======================================================================================
 *                                     Calls of them
 * ====================================================================================== */

static const char *name_of(const lq_atlas_table *table) {
    return table->table.texture ? table->table.texture->name : table->table.factored->name;
}

static size_t fetches_of(const lq_atlas_table *table, bool colours) {
    return colours ? lq_factored_colour_fetches(table->table.factored, table->table.kind)
                   : lq_atlas_table_fetches(table);
}

/* "lacquer_fgd_rgb(atlas, ...)": arguments by axis, within the ranges of the table, so that none of its own
 * checks is met. Of an axis that differs by colour `x` is a vector. */
static void say_call(FILE *out, lq_language language, const lq_atlas_table *table, bool colours,
                     const char *const *arguments) {
    const lq_kind *kind = table->table.kind;
    lq_say(out, language, "lacquer_%s%s($a", name_of(table), colours ? "_rgb" : "");
    for (int a = 0; a < kind->axis_count; a++) {
        char low[LQ_LITERAL_SIZE], high[LQ_LITERAL_SIZE];
        const char *x = arguments[a];
        double range[2] = {0.0, 1.0};
        range_of(table, a, range);
        lq_literal(range[0], language, low);
        lq_literal(range[1], language, high);
        if (colours && lq_colour_axes(kind) >> a & 1)
            lq_say(out, language,
                   ",\n        $c3(@clamp(%s.x, %s, %s), @clamp(%s.y, %s, %s), @clamp(%s.z, %s, %s))", x, low,
                   high, x, low, high, x, low, high);
        else lq_say(out, language, ", @clamp(%s, %s, %s)", x, low, high);
    }
    fputc(')', out);
}

#define CALL(table, colours, ...) say_call(out, language, table, colours, (const char *const[]){__VA_ARGS__})

/* What all tables of an argument hold; the checks are made of these. */
static void narrow(lq_argument *check, const lq_atlas_table *table, int axis) {
    double range[2];
    if (!range_of(table, axis, range)) return;
    check->min = fmax(check->min, range[0]);
    check->max = fmin(check->max, range[1]);
}

static void say_ranges(FILE *out, const lq_argument *checks, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const size_t length = strcspn(checks[i].name, ".");
        if (checks[i].name[length] && checks[i].name[length + 1] != 'x') continue;
        fprintf(out, "\n *   %.*s: %g to %g", (int)length, checks[i].name, checks[i].min, checks[i].max);
    }
    fputs(" */\n", out);
}

#define COLOURS(name, min, max)                                                                              \
    {name ".x", min, max}, {name ".y", min, max}, {                                                          \
        name ".z", min, max                                                                                  \
    }

static const char none_text[] = "    l.inner = $c3(0.0$f, 0.0$f, 0.0$f);\n    l.inner_alpha = 0.0$f;\n";
static const char no_base_text[] = "    l.base = $c3(0.0$f, 0.0$f, 0.0$f);\n    l.base_alpha = 0.0$f;\n";

/* ======================================================================================
 *                                       Conductor
 * ====================================================================================== */

static void say_conductor(FILE *out, lq_language language, const lq_general *g) {
    double n[2] = {0.0}, kappa[2] = {0.0};
    range_of(g->conductor, 2, n);
    range_of(g->conductor, 3, kappa);
    const lq_argument checks[] = {{"mu", 0.0, 1.0},
                                  {"alpha", 0.0, 1.0},
                                  COLOURS("n", n[0], n[1]),
                                  COLOURS("kappa", kappa[0], kappa[1])};
    const size_t count = sizeof checks / sizeof *checks;
    fprintf(out, "\n/* A metal of index n + i kappa relative to the medium above: %zu fetches.",
            fetches_of(g->conductor, true));
    say_ranges(out, checks, count);
    lq_say(out, language, "$(L lacquer_conductor|A|1 mu|1 alpha|3 n|3 kappa$)\n{\n");
    lq_say_check(out, language, checks, count, "lacquer_outside()");
    lq_say(out, language, "    $~L l;\n    l.top = ");
    CALL(g->conductor, true, "mu", "alpha", "n", "kappa");
    lq_say(out, language, ";\n    l.top_alpha = @clamp(alpha, 0.0$f, 1.0$f);\n");
    lq_say(out, language, none_text);
    lq_say(out, language, no_base_text);
    fputs("    return l;\n}\n", out);
}

/* ======================================================================================
 *                               A coated Lambertian base (D22)
 * ====================================================================================== */

/* What stays clamps: R + T <= 1 and R10 + T10 <= 1, each of a table of its own with its own error, or light
 * would be made. */
static void say_coated_lambertian(FILE *out, lq_language language, const lq_general *g) {
    lq_argument checks[] = {{"mu", 0.0, 1.0},
                            {"alpha", 0.0, 1.0},
                            {"eta", 0.0, INFINITY},
                            COLOURS("tau", 0.0, 1.0),
                            COLOURS("rho", 0.0, 1.0)};
    const size_t count = sizeof checks / sizeof *checks;
    const lq_atlas_table *const of_eta[] = {g->dielectric, g->enters}, *const diffuse[] = {g->leaves,
                                                                                           g->returns,
                                                                                           g->variance};
    for (int i = 0; i < 2; i++) narrow(&checks[2], of_eta[i], 2);
    for (int i = 0; i < 3; i++) narrow(&checks[2], diffuse[i], 0);
    fprintf(out,
            "\n/* A Lambertian base of albedo rho under a coating of index eta that leaves tau of light at "
            "normal\n * incidence (D22 eq. 3-5): %zu fetches.",
            fetches_of(g->dielectric, false) + fetches_of(g->enters, true) + fetches_of(g->leaves, true) +
                fetches_of(g->returns, true) + fetches_of(g->variance, false));
    say_ranges(out, checks, count);
    lq_say(out, language, "$(L lacquer_coated_lambertian|A|1 mu|1 alpha|1 eta|3 tau|3 rho$)\n{\n");
    lq_say_check(out, language, checks, count, "lacquer_outside()");
    lq_say(out, language, "    $=1 r01 = ");
    CALL(g->dielectric, false, "mu", "alpha", "eta");
    lq_say(out, language, ";\n    $=3 t01 = ");
    CALL(g->enters, true, "mu", "alpha", "eta", "tau");
    lq_say(out, language, ";\n    $=3 t10 = ");
    CALL(g->leaves, true, "eta", "alpha", "tau");
    lq_say(out, language, ";\n    $=3 r10 = ");
    CALL(g->returns, true, "eta", "alpha", "tau");
    lq_say(out, language,
           ";\n    $~L l;\n"
           "    l.top = $c3(@min(r01, 1.0$f - t01.x), @min(r01, 1.0$f - t01.y), @min(r01, 1.0$f - t01.z));\n"
           "    l.top_alpha = @clamp(alpha, 0.0$f, 1.0$f);\n");
    lq_say(out, language, none_text);
    fputs("    l.base = ", out);
    lq_say(out, language, "$c3(");
    for (int c = 0; c < 3; c++)
        lq_say(out, language,
               "%slacquer_base(t01.%c * t10.%c, @clamp(rho.%c, 0.0$f, 1.0$f), @min(r10.%c, 1.0$f - t10.%c))",
               c > 0 ? ",\n        " : "", "xyz"[c], "xyz"[c], "xyz"[c], "xyz"[c], "xyz"[c]);
    fputs(");\n    l.base_alpha = ", out);
    CALL(g->variance, false, "eta", "alpha");
    fputs(".y;\n    return l;\n}\n", out);
}

/* ======================================================================================
 *                              A dielectric over a conductor (B18)
 * ====================================================================================== */

/* f of a roughness, below its table by the square law that it tends to: nothing of a smooth interface. */
static void say_f(FILE *out, lq_language language, const lq_general *g, const char *name, const char *alpha) {
    char low[LQ_LITERAL_SIZE];
    double range[2] = {0.0, 1.0};
    range_of(g->f, 0, range);
    lq_say(out, language, "    $=1 %s_low = @clamp(%s / %s, 0.0$f, 1.0$f);\n    $=1 %s = %s_low * %s_low * ",
           name, alpha, lq_literal(range[0], language, low), name, name, name);
    CALL(g->f, false, alpha);
    fputs(";\n", out);
}

static void say_inverse(FILE *out, lq_language language, const lq_general *g, const char *s) {
    char low[LQ_LITERAL_SIZE];
    double range[2] = {0.0, 1.0};
    range_of(g->inverse, 0, range);
    lq_say(out, language, "@sqrt(@clamp(%s / %s, 0.0$f, 1.0$f)) * ", s, lq_literal(range[0], language, low));
    CALL(g->inverse, false, s);
}

/* Cosines on both sides, and the base's index as it is seen from inside, which has ranges of its own. */
static void say_inside(FILE *out, lq_language language, const lq_argument *eta, const lq_argument *index) {
    char low[LQ_LITERAL_SIZE], high[LQ_LITERAL_SIZE];
    lq_say(out, language,
           "    $=1 i = @clamp(mu, 0.0$f, 1.0$f);\n"
           "    $=1 m = @clamp(eta, %s, %s);\n"
           "    $=1 t = @sqrt(@max(1.0$f - (1.0$f - i * i) / (m * m), 1e-6$f));\n"
           "    $=3 base_n = $c3(n.x / m, n.y / m, n.z / m);\n"
           "    $=3 base_kappa = $c3(kappa.x / m, kappa.y / m, kappa.z / m);\n",
           lq_literal(eta->min, language, low), lq_literal(eta->max, language, high));
    lq_say_check(out, language, index, 6, "lacquer_outside()");
}

/* Energies: interface, total reflection, medium, base (B18 eq. 15, 22, 28-35). */
static void say_energies(FILE *out, lq_language language, const lq_general *g) {
    lq_say(out, language, "    $=1 r01 = ");
    CALL(g->dielectric, false, "i", "alpha", "m");
    lq_say(out, language, ";\n    $=1 r = ");
    CALL(g->inside, false, "t", "alpha", "1.0$f / m");
    lq_say(out, language, ";\n    $=1 t10 = (1.0$f - r) * ");
    CALL(g->pass, false, "t", "base_alpha", "1.0$f / m");
    lq_say(out, language, ";\n    $=1 r10 = 1.0$f - t10;\n    $=3 r12 = ");
    CALL(g->conductor, true, "t", "base_alpha", "base_n", "base_kappa");
    lq_say(out, language,
           ";\n    $=3 back = $c3(r12.x * @pow(@clamp(tau.x, 0.0$f, 1.0$f), 2.0$f / t),\n"
           "        r12.y * @pow(@clamp(tau.y, 0.0$f, 1.0$f), 2.0$f / t),\n"
           "        r12.z * @pow(@clamp(tau.z, 0.0$f, 1.0$f), 2.0$f / t));\n"
           "    $~L l;\n"
           "    l.top = $c3(r01, r01, r01);\n"
           "    l.top_alpha = @clamp(alpha, 0.0$f, 1.0$f);\n"
           "    l.inner = $c3(");
    for (int c = 0; c < 3; c++)
        lq_say(out, language, "%slacquer_base((1.0$f - r01) * t10, back.%c, r10)", c > 0 ? ",\n        " : "",
               "xyz"[c]);
    fputs(");\n", out);
}

/* Roughness: variances add in f (eq. 10, 38, 47-51); those met inside count by the change of the projected
 * disc across the interface, and are the means of the colours. */
static void say_roughness(FILE *out, lq_language language, const lq_general *g) {
    lq_say(out, language,
           "    $=1 o = @max(i, 1e-3$f);\n"
           "    $=1 jacobian = m * t / o;\n"
           "    $=1 mean = (back.x + back.y + back.z) / 3.0$f * r10;\n"
           "    $=1 again = mean / @max(1.0$f - mean, 1e-3$f);\n"
           "    $=1 down = 0.5$f * alpha * @max(1.0$f - i / (m * t), i / (m * t) - 1.0$f);\n"
           "    $=1 up = 0.5$f * alpha * @max(1.0$f - jacobian, jacobian - 1.0$f);\n");
    say_f(out, language, g, "s_top", "alpha");
    say_f(out, language, g, "s_base", "base_alpha");
    say_f(out, language, g, "s_down", "down");
    say_f(out, language, g, "s_up", "up");
    lq_say(out, language,
           "    $=1 s = s_up + jacobian * (s_down + s_base + again * (s_base + s_top));\n"
           "    l.inner_alpha = ");
    say_inverse(out, language, g, "s");
    fputs(";\n", out);
}

static void say_layered(FILE *out, lq_language language, const lq_general *g) {
    double inside[2] = {0.0, 1.0}, pass[2] = {0.0, 1.0}, n[2] = {0.0}, kappa[2] = {0.0};
    range_of(g->inside, 2, inside);
    range_of(g->pass, 2, pass);
    range_of(g->conductor, 2, n);
    range_of(g->conductor, 3, kappa);
    const lq_argument index[] = {COLOURS("base_n", n[0], n[1]), COLOURS("base_kappa", kappa[0], kappa[1])};
    const double most = 1.0 / fmax(inside[0], pass[0]), least = 1.0 / fmin(inside[1], pass[1]);
    lq_argument checks[] = {{"mu", 0.0, 1.0},
                            {"alpha", 0.0, 1.0},
                            {"eta", least, most},
                            COLOURS("tau", 0.0, 1.0),
                            {"base_alpha", 0.0, 1.0}};
    const size_t count = sizeof checks / sizeof *checks;
    narrow(&checks[2], g->dielectric, 2);
    fprintf(out,
            "\n/* A metal of index n + i kappa and roughness base_alpha under a coating of index eta that "
            "leaves tau of\n * light at normal incidence, each relative to the outside (B18): %zu fetches.",
            fetches_of(g->dielectric, false) + fetches_of(g->inside, false) + fetches_of(g->pass, false) +
                fetches_of(g->conductor, true) + 4 * fetches_of(g->f, false) + fetches_of(g->inverse, false));
    fprintf(out, "\n *   n / eta: %g to %g, kappa / eta: %g to %g", n[0], n[1], kappa[0], kappa[1]);
    say_ranges(out, checks, count);
    lq_say(out, language, "$(L lacquer_layered|A|1 mu|1 alpha|1 eta|3 tau|1 base_alpha|3 n|3 kappa$)\n{\n");
    lq_say_check(out, language, checks, count, "lacquer_outside()");
    say_inside(out, language, &checks[2], index);
    say_energies(out, language, g);
    say_roughness(out, language, g);
    lq_say(out, language, no_base_text);
    fputs("    return l;\n}\n", out);
}

void lq_say_general(FILE *out, lq_language language, const lq_general *general) {
    if (lq_general_has_conductor(general)) say_conductor(out, language, general);
    if (lq_general_has_coated_lambertian(general)) say_coated_lambertian(out, language, general);
    if (lq_general_has_layered(general)) say_layered(out, language, general);
}
