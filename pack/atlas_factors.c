/* atlas_factors.c - functions of factored tables in the decode source of an atlas. */
#include "pack/atlas_source.h"

#include <string.h>

static bool is_fixed(const lq_factored *factored, int axis) {
    return factored->axes[axis].min == factored->axes[axis].max;
}

/* The arguments of some axes within their ranges: c_mu of mu; c_tau of tau.x where `part` is ".x". */
static void say_clamped(FILE *out, lq_language language, const lq_factored *factored, unsigned axes,
                        const char *part) {
    char low[LQ_LITERAL_SIZE], high[LQ_LITERAL_SIZE];
    for (int a = 0; a < factored->axis_count; a++) {
        if (!(axes >> a & 1)) continue;
        const char *name = factored->axes[a].name;
        lq_literal(factored->axes[a].min, language, low);
        lq_literal(factored->axes[a].max, language, high);
        if (is_fixed(factored, a)) lq_say(out, language, "    $=1 c_%s = %s;\n", name, low);
        else lq_say(out, language, "    $=1 c_%s = @clamp(%s%s, %s, %s);\n", name, name, part, low, high);
        if (language == LQ_C || language == LQ_METAL) fprintf(out, "    (void)c_%s;\n", name);
    }
}

/* Where in its tile a factor's axis is read. */
static void say_position(FILE *out, lq_language language, const lq_factored *factored,
                         const lq_factor *factor, int a) {
    if (a >= factor->axis_count || factor->axes[a].texels.size == 1) {
        lq_say(out, language, "0.0$f");
        return;
    }
    const lq_texture_axis *axis = &factor->axes[a];
    const char *name = factored->axes[axis->axis].name;
    char value[128];
    if (axis->coordinate == LQ_COORDINATE_AXIS) snprintf(value, sizeof value, "c_%s", name);
    else if (axis->coordinate == LQ_COORDINATE_COSINE)
        snprintf(value, sizeof value, "lacquer_cosine(c_%s)", name);
    else
        snprintf(value, sizeof value, "lacquer_critical(c_%s, c_%s)", name, factored->axes[axis->other].name);
    lq_say_coordinate(out, language, &axis->texels, value);
}

static void say_bases(FILE *out, lq_language language, const lq_factored *factored, const lq_bases *bases,
                      const lq_tile *tiles) {
    const lq_factor *factor = &factored->pieces[bases->piece].factors[bases->factor];
    const char *id = bases->suffix;
    for (int a = 0; a < 2; a++) {
        lq_say(out, language, "    $=1 %c%s = ", "uv"[a], id);
        say_position(out, language, factored, factor, a);
        fputs(";\n", out);
    }
    for (size_t k = 0; k < bases->image.layers; k++) {
        lq_say(out, language, "    $=4 b%s_%zu = lacquer_fetch($a, ", id, k);
        lq_say_tile(out, language, &tiles[k], tiles[k].image->height);
        fprintf(out, ", u%s, v%s);\n", id, id);
    }
}

/* The first tile of the bases of a factor. */
static const lq_tile *tiles_of(const lq_factored_textures *textures, const lq_tile *tiles, int piece,
                               int factor) {
    for (size_t i = 0; i < textures->count; tiles += textures->bases[i++].image.layers)
        if (textures->bases[i].piece == piece && textures->bases[i].factor == factor) break;
    return tiles;
}

/* A stream: products of bases, a few a line. */
static void say_stream(FILE *out, lq_language language, const lq_factored_textures *textures,
                       const lq_tile *tiles, int p, int k) {
    enum { PER_LINE = 3 };
    const lq_factored *factored = textures->factored;
    const lq_term_sum *sum = &factored->pieces[p].streams[k];
    lq_say(out, language, "    $=1 s%d = ", k);
    if (sum->term_count == 0) lq_say(out, language, "0.0$f");
    for (size_t t = 0; t < sum->term_count; t++) {
        if (t > 0) fputs(t % PER_LINE == 0 ? "\n        + " : " + ", out);
        for (int g = 0; g < sum->factor_count; g++) {
            const int base = sum->index[t * (size_t)sum->factor_count + (size_t)g];
            const int layer = base / LQ_BASES_PER_LAYER;
            const lq_tile *tile = tiles_of(textures, tiles, p, sum->factors[g]) + layer;
            fprintf(out, "%sb%d_%d_%d.%c", g > 0 ? " * " : "", p, sum->factors[g], layer,
                    "xyzw"[tile->channel + base % LQ_BASES_PER_LAYER]);
        }
    }
    fputs(";\n", out);
}

/* `to`: "return", or "v0 =". */
static void say_value(FILE *out, lq_language language, const lq_factored *factored, const lq_piece *piece,
                      const char *to) {
    char low[LQ_LITERAL_SIZE], high[LQ_LITERAL_SIZE];
    lq_say(out, language, "    %s @clamp(", to);
    if (piece->value == LQ_VALUE_SQUARE) fputs("s0 * s0", out);
    else if (piece->value == LQ_VALUE_BEER)
        lq_say(out, language, "s0 * @pow(c_%s, @exp2(s1))", factored->axes[piece->value_axis].name);
    else fputs("s0", out);
    fprintf(out, ", %s, %s);\n", lq_literal(factored->value_min, language, low),
            lq_literal(factored->value_max, language, high));
}

/* The sides of a piece's box that are not the table's own. */
static void say_condition(FILE *out, lq_language language, const lq_factored *factored,
                          const lq_piece *piece) {
    bool first = true;
    char text[LQ_LITERAL_SIZE];
    fputs("    if (", out);
    for (int a = 0; a < factored->axis_count; a++)
        for (int upper = 0; upper < 2; upper++) {
            const double side = upper ? piece->max[a] : piece->min[a];
            if (side == (upper ? factored->axes[a].max : factored->axes[a].min)) continue;
            fprintf(out, "%sc_%s %s %s", first ? "" : " && ", factored->axes[a].name,
                    upper ? "<=" : ">=", lq_literal(side, language, text));
            first = false;
        }
    fputs(first ? "true) {\n" : ") {\n", out);
}

/* The axes that a factor is read at. */
static unsigned axes_of(const lq_factor *factor) {
    unsigned axes = 0;
    for (int a = 0; a < factor->axis_count; a++) {
        axes |= 1u << factor->axes[a].axis;
        if (factor->axes[a].coordinate == LQ_COORDINATE_CRITICAL) axes |= 1u << factor->axes[a].other;
    }
    return axes;
}

static unsigned axes_of_bases(const lq_factored_textures *textures, size_t i) {
    const lq_bases *bases = &textures->bases[i];
    return axes_of(&textures->factored->pieces[bases->piece].factors[bases->factor]);
}

/* Bases of a piece: those that depend on one of the axes `colours`, or those that do not. */
static void say_all_bases(FILE *out, lq_language language, const lq_factored_textures *textures,
                          const lq_tile *tiles, int piece, unsigned colours, bool coloured) {
    size_t tile = 0;
    for (size_t i = 0; i < textures->count; tile += textures->bases[i++].image.layers)
        if (textures->bases[i].piece == piece && ((axes_of_bases(textures, i) & colours) != 0) == coloured)
            say_bases(out, language, textures->factored, &textures->bases[i], tiles + tile);
}

/* One value, or one a colour. */
static void say_piece(FILE *out, lq_language language, const lq_factored_textures *textures,
                      const lq_tile *tiles, int p, unsigned colours) {
    const lq_factored *factored = textures->factored;
    const lq_piece *piece = &factored->pieces[p];
    say_all_bases(out, language, textures, tiles, p, colours, false);
    if (colours == 0) {
        for (int k = 0; k < piece->stream_count; k++) say_stream(out, language, textures, tiles, p, k);
        say_value(out, language, factored, piece, "return");
        return;
    }
    for (int c = 0; c < 3; c++) lq_say(out, language, "    $~1 v%d;\n", c);
    for (int c = 0; c < 3; c++) {
        const char part[] = {'.', "xyz"[c], '\0'}, to[] = {'v', (char)('0' + c), ' ', '=', '\0'};
        fputs("    {\n", out);
        say_clamped(out, language, factored, colours, part);
        say_all_bases(out, language, textures, tiles, p, colours, true);
        for (int k = 0; k < piece->stream_count; k++) say_stream(out, language, textures, tiles, p, k);
        say_value(out, language, factored, piece, to);
        fputs("    }\n", out);
    }
    lq_say(out, language, "    return $c3(v0, v1, v2);\n");
}

static void say_pieces(FILE *out, lq_language language, const lq_factored_textures *textures,
                       const lq_tile *tiles, unsigned colours) {
    const lq_factored *factored = textures->factored;
    say_clamped(out, language, factored, ~colours, "");
    for (int p = 0; p < factored->piece_count; p++) {
        const bool last = p == factored->piece_count - 1;
        if (!last) say_condition(out, language, factored, &factored->pieces[p]);
        say_piece(out, language, textures, tiles, p, colours);
        if (!last) fputs("    }\n", out);
    }
}

/* The comment, the head and the check of the arguments, of which those of the axes `colours` are three. */
static void say_head(FILE *out, lq_language language, const lq_factored_textures *textures,
                     const lq_kind *kind, unsigned colours) {
    const lq_factored *factored = textures->factored;
    char names[3 * LQ_MAX_AXES][LQ_NAME_SIZE + 2], head[512];
    lq_argument checks[3 * LQ_MAX_AXES];
    size_t count = 0;
    int used = snprintf(head, sizeof head, "$(%d lacquer_%s%s|A", colours ? 3 : 1, textures->name,
                        colours ? "_rgb" : "");
    for (int a = 0; a < factored->axis_count; a++) {
        const char *name = factored->axes[a].name;
        const double min = factored->axes[a].min, max = factored->axes[a].max;
        const bool coloured = colours >> a & 1;
        if (colours == 0) fprintf(out, "\n *   %s: %s, %g to %g", name, kind->axes[a].meaning, min, max);
        if (is_fixed(factored, a)) continue;
        for (int c = 0; c < (coloured ? 3 : 1); c++, count++) {
            snprintf(names[count], sizeof names[count], coloured ? "%s.%c" : "%s", name, "xyz"[c]);
            checks[count] = (lq_argument){names[count], min, max};
        }
        used += snprintf(head + used, sizeof head - (size_t)used, "|%d %s", coloured ? 3 : 1, name);
    }
    fputs(" */\n", out);
    lq_say(out, language, "%s$)\n{\n", head);
    lq_say_outside(out, language, checks, count, colours ? 3 : 1);
}

unsigned lq_colour_axes(const lq_kind *kind) {
    static const char *const names[] = {"n", "kappa", "tau"};
    unsigned axes = 0;
    for (int a = 0; a < kind->axis_count; a++)
        for (size_t i = 0; i < sizeof names / sizeof *names; i++)
            if (strcmp(kind->axes[a].name, names[i]) == 0) axes |= 1u << a;
    return axes;
}

/* Pieces that are chosen by what may differ by colour would need three choices. */
bool lq_factored_has_colours(const lq_factored_textures *textures, const lq_kind *kind) {
    const lq_factored *factored = textures->factored;
    const unsigned colours = lq_colour_axes(kind);
    for (int a = 0; a < factored->axis_count; a++) {
        if (!(colours >> a & 1)) continue;
        if (is_fixed(factored, a)) return false;
        for (int p = 0; p < factored->piece_count; p++)
            if (factored->pieces[p].min[a] != factored->axes[a].min ||
                factored->pieces[p].max[a] != factored->axes[a].max)
                return false;
    }
    return colours != 0;
}

size_t lq_factored_colour_fetches(const lq_factored_textures *textures, const lq_kind *kind) {
    size_t most = 0;
    for (int p = 0; p < textures->factored->piece_count; p++) {
        size_t count = 0;
        for (size_t i = 0; i < textures->count; i++)
            if (textures->bases[i].piece == p)
                count += textures->bases[i].image.layers *
                         (axes_of_bases(textures, i) & lq_colour_axes(kind) ? 3 : 1);
        most = count > most ? count : most;
    }
    return most;
}

void lq_say_factored(FILE *out, lq_language language, const lq_factored_textures *textures,
                     const lq_kind *kind, const lq_tile *tiles) {
    lq_say_comment(out, textures->name, kind);
    say_head(out, language, textures, kind, 0);
    say_pieces(out, language, textures, tiles, 0);
    fputs("}\n", out);
    if (!lq_factored_has_colours(textures, kind)) return;
    fprintf(out, "\n/* The same for three colours, %zu fetches.", lq_factored_colour_fetches(textures, kind));
    say_head(out, language, textures, kind, lq_colour_axes(kind));
    say_pieces(out, language, textures, tiles, lq_colour_axes(kind));
    fputs("}\n", out);
}
