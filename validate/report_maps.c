/* report_maps.c - error over pairs of axes, as coloured cells. */
#include "validate/report_maps.h"

#include <math.h>
#include <stdlib.h>

#include "picture/colour.h"
#include "picture/ticks.h"
#include "system/number.h"
#include "system/status.h"
#include "validate/report_parts.h"

/* Cells a side, their size in px, room for labels left and below, steps of the colours, nodes of an axis
 * whose table is not there. */
enum {
    CELLS = 20,
    CELL = 13,
    LEFT = 58,
    ABOVE = 10,
    BELOW = 38,
    SIDE = CELLS * CELL,
    SHADES = 64,
    NODES = 65
};

/* Decades that a scale has at most: what is smaller has the first colour. */
static const double DECADES = 4.0;

/* All maps of a certificate, whose colours are one scale. */
typedef struct maps {
    const lq_certified *certified;
    lq_axis axes[LQ_MAX_AXES]; /* over the domain, in the map of the table's own */
    double low, high;          /* log10 of the error */
    double *most; /* largest error: [pair * CELLS * CELLS + row * CELLS + column]; < 0: no point */
} maps;

/* ======================================================================================
 *                                        Numbers
 * ====================================================================================== */

/* The axis of the stored table over the domain; without a table, that of its kind. */
static lq_status make_axis(const lq_certified *certified, int a, lq_axis *axis, lq_error *error) {
    const lq_domain *d = &certified->certificate.request.domain;
    const lq_axis_info *info = &certified->certificate.request.kind->axes[a];
    const lq_table *table = certified->subject.table;
    const lq_axis *own = table && a < table->axis_count ? &table->axes[a] : NULL;
    if (own && own->size > 1 && own->min == d->min[a] && own->max == d->max[a])
        return lq_axis_copy(axis, own, error);
    const bool flat = !(d->max[a] > d->min[a]);
    const lq_map map = flat ? LQ_MAP_LINEAR : own ? own->map : info->map;
    return lq_axis_make(axis, info->name, d->min[a], d->max[a], flat ? 1 : NODES,
                        map == LQ_MAP_CUSTOM ? LQ_MAP_LINEAR : map, own ? own->exponent : 2.0, error);
}

static size_t cell_of(const lq_axis *axis, double x) {
    return (size_t)fmin(fmax(lq_tick_at(axis, x) * CELLS, 0.0), CELLS - 1);
}

static void count_error(const maps *m, const double *at, double error) {
    const lq_kind *kind = m->certified->certificate.request.kind;
    double *cells = m->most;
    for (int y = 1; y < kind->axis_count; y++)
        for (int x = 0; x < y; x++, cells += (ptrdiff_t)CELLS * CELLS) {
            double *cell = &cells[cell_of(&m->axes[y], at[y]) * CELLS + cell_of(&m->axes[x], at[x])];
            *cell = fmax(*cell, error);
        }
}

static size_t pairs_of(const lq_kind *kind) {
    return (size_t)(kind->axis_count * (kind->axis_count - 1) / 2);
}

/* Every point, what the search found too; then the scale. */
static void gather(maps *m) {
    const lq_sampled *c = &m->certified->certificate;
    const double *decoded = c->decoded[c->request.stage_count - 1];
    const size_t axes = (size_t)c->request.kind->axis_count;
    const size_t cells = pairs_of(c->request.kind) * CELLS * CELLS;
    for (size_t i = 0; i < cells; i++) m->most[i] = -1.0;
    for (size_t i = 0; i < c->points * (size_t)c->request.kind->channel_count; i++)
        count_error(m, c->at + i % c->points * axes, fabs(decoded[i] - c->exact[i]));
    count_error(m, c->found.at, c->found.error);
    double least = c->max;
    for (size_t i = 0; i < cells; i++)
        if (m->most[i] > 0.0) least = fmin(least, m->most[i]);
    m->high = log10(fmax(c->max, 1e-30));
    m->low = fmax(log10(fmax(least, 1e-30)), m->high - DECADES);
    if (!(m->low < m->high)) m->low = m->high - 1.0;
}

static int shade(const maps *m, double error) {
    const double t = (log10(fmax(error, 1e-30)) - m->low) / (m->high - m->low);
    return (int)lround(fmin(fmax(t, 0.0), 1.0) * (SHADES - 1));
}

/* ======================================================================================
 *                                         Pictures
 * ====================================================================================== */

static void put_colour(FILE *out, int step) {
    lq_rgb steps[LQ_COLOUR_STEPS];
    lq_colour_steps(LQ_COLOURS_VALUE, steps);
    const lq_rgb c = steps[step * (LQ_COLOUR_STEPS - 1) / (SHADES - 1)];
    fprintf(out, "#%02x%02x%02x", c.r, c.g, c.b);
}

/* One path a colour: runs of cells. */
static void put_shade(FILE *out, const maps *m, const double *cells, int step) {
    bool any = false;
    for (int row = 0; row < CELLS; row++)
        for (int from = 0, to; from < CELLS; from = to) {
            to = from + 1;
            if (cells[row * CELLS + from] < 0.0 || shade(m, cells[row * CELLS + from]) != step) continue;
            while (to < CELLS && cells[row * CELLS + to] >= 0.0 && shade(m, cells[row * CELLS + to]) == step)
                to++;
            if (!any) {
                fputs("<path fill=\"", out);
                put_colour(out, step);
                fputs("\" d=\"", out);
                any = true;
            }
            fprintf(out, "M%d %dh%dv%dh-%dz", LEFT + from * CELL, ABOVE + (CELLS - 1 - row) * CELL,
                    (to - from) * CELL, CELL, (to - from) * CELL);
        }
    if (any) fputs("\"/>\n", out);
}

static void put_axes(FILE *out, const lq_axis *x, const lq_axis *y) {
    lq_tick ticks[LQ_TICKS_MAX];
    size_t count = lq_ticks(x, 38.0 / SIDE, ticks);
    for (size_t i = 0; i < count; i++)
        fprintf(out,
                "<path class=\"axis\" d=\"M%.1f %dv5\"/><text class=\"soft\" x=\"%.1f\" y=\"%d\" "
                "text-anchor=\"middle\">%s</text>",
                LEFT + SIDE * ticks[i].at, ABOVE + SIDE, LEFT + SIDE * ticks[i].at, ABOVE + SIDE + 18,
                ticks[i].text);
    count = lq_ticks(y, 22.0 / SIDE, ticks);
    for (size_t i = 0; i < count; i++)
        fprintf(out,
                "<path class=\"axis\" d=\"M%d %.1fh-5\"/><text class=\"soft\" x=\"%d\" y=\"%.1f\" "
                "text-anchor=\"end\">%s</text>",
                LEFT, ABOVE + SIDE * (1.0 - ticks[i].at), LEFT - 8, ABOVE + SIDE * (1.0 - ticks[i].at) + 4.0,
                ticks[i].text);
    fprintf(out,
            "<rect class=\"axis\" fill=\"none\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/><text "
            "class=\"ink\" x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text><text class=\"ink\" "
            "transform=\"translate(13 %d) rotate(-90)\" text-anchor=\"middle\">%s</text>\n",
            LEFT, ABOVE, SIDE, SIDE, LEFT + SIDE / 2, ABOVE + SIDE + 34, x->name, ABOVE + SIDE / 2, y->name);
}

/* A ring, and what it was. */
static void put_worst(FILE *out, const maps *m, int x, int y) {
    const lq_sampled *c = &m->certified->certificate;
    const double *at = lq_report_worst(c);
    const double px = LEFT + SIDE * lq_tick_at(&m->axes[x], at[x]);
    const double py = ABOVE + SIDE * (1.0 - lq_tick_at(&m->axes[y], at[y]));
    const bool right = px > LEFT + SIDE / 2.0;
    const double base = fmin(fmax(py + 4.0, ABOVE + 12.0), ABOVE + SIDE - 4.0);
    fprintf(out,
            "<circle fill=\"none\" stroke=\"#000\" stroke-width=\"4\" cx=\"%.1f\" cy=\"%.1f\" r=\"6\"/>"
            "<circle fill=\"none\" stroke=\"#fff\" stroke-width=\"2\" cx=\"%.1f\" cy=\"%.1f\" r=\"6\"/>"
            "<text class=\"ink halo\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%.2g</text>\n",
            px, py, px, py, right ? px - 11.0 : px + 11.0, base, right ? "end" : "start", c->max);
}

static void put_map(FILE *out, const maps *m, const double *cells, int x, int y) {
    fprintf(out, "<svg viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" role=\"img\">", LEFT + SIDE + 14,
            ABOVE + SIDE + BELOW, LEFT + SIDE + 14, ABOVE + SIDE + BELOW);
    fprintf(out, "<title>largest error over %s and %s</title>\n", m->axes[x].name, m->axes[y].name);
    fprintf(out, "<rect class=\"bare\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/>\n", LEFT, ABOVE, SIDE,
            SIDE);
    for (int step = 0; step < SHADES; step++) put_shade(out, m, cells, step);
    put_axes(out, &m->axes[x], &m->axes[y]);
    put_worst(out, m, x, y);
    fputs("</svg>\n", out);
}

static void put_scale(FILE *out, const maps *m) {
    enum { WIDTH = 320 };
    lq_tick ticks[LQ_TICKS_MAX];
    fprintf(out,
            "<svg viewBox=\"0 0 %d 40\" width=\"%d\" height=\"40\" role=\"img\"><title>scale of the "
            "errors</title>",
            WIDTH + 60, WIDTH + 60);
    for (int i = 0; i < SHADES; i++) {
        fprintf(out, "<rect x=\"%d\" width=\"6\" height=\"14\" fill=\"", 30 + i * WIDTH / SHADES);
        put_colour(out, i);
        fputs("\"/>", out);
    }
    const size_t count = lq_ticks_linear(m->low, m->high, 60.0 / WIDTH, ticks);
    for (size_t i = 0; i < count; i++)
        fprintf(out, "<text class=\"soft\" x=\"%.1f\" y=\"32\" text-anchor=\"middle\">%.2g</text>",
                30.0 + WIDTH * ticks[i].at, pow(10.0, ticks[i].value));
    fputs("</svg>\n", out);
}

static void put_all(FILE *out, const maps *m) {
    const lq_kind *kind = m->certified->certificate.request.kind;
    const double *cells = m->most;
    put_scale(out, m);
    fputs("<div class=\"maps\">\n", out);
    for (int y = 1; y < kind->axis_count; y++)
        for (int x = 0; x < y; x++, cells += (ptrdiff_t)CELLS * CELLS)
            if (m->axes[x].size > 1 && m->axes[y].size > 1) put_map(out, m, cells, x, y);
    fputs("</div>\n", out);
}

lq_status lq_report_maps(const lq_certified *certified, FILE *out, lq_error *error) {
    maps m = {.certified = certified};
    const lq_kind *kind = certified->certificate.request.kind;
    lq_status status = LQ_OK;
    if (kind->axis_count < 2) return LQ_OK;
    for (int a = 0; status == LQ_OK && a < kind->axis_count; a++)
        status = make_axis(certified, a, &m.axes[a], error);
    if (status == LQ_OK && !(m.most = malloc(pairs_of(kind) * CELLS * CELLS * sizeof *m.most)))
        status = lq_fail(error, LQ_NO_MEMORY, "no memory for a report");
    if (status == LQ_OK) {
        gather(&m);
        put_all(out, &m);
    }
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&m.axes[a]);
    free(m.most);
    return status;
}
