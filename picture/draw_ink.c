/* draw_ink.c - ink, text, and the axes around a plot. */
#include "picture/draw_parts.h"
#include "system/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void lq_draw_colour(cairo_t *cr, lq_rgb colour) {
    cairo_set_source_rgb(cr, colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

void lq_draw_ink(cairo_t *cr, lq_ink ink) {
    static const lq_rgb inks[] = {[LQ_INK_TEXT] = {0x1a, 0x1a, 0x19},
                                  [LQ_INK_SOFT] = {0x63, 0x62, 0x5e},
                                  [LQ_INK_AXIS] = {0x8f, 0x8e, 0x88},
                                  [LQ_INK_GRID] = {0xe6, 0xe5, 0xe0},
                                  [LQ_INK_PAGE] = {0xfc, 0xfc, 0xfb}};
    lq_draw_colour(cr, inks[ink]);
}

/* Cut `text` before its last character, which may be of several bytes, and end it with an ellipsis. */
static void shorten(char *text, size_t size) {
    static const char ellipsis[] = "\xe2\x80\xa6";
    size_t end = strlen(text);
    if (end >= 3 && strcmp(text + end - 3, ellipsis) == 0) end -= 3;
    while (end > 0 && ((unsigned char)text[--end] & 0xc0) == 0x80) continue;
    snprintf(text + end, size - end, "%s", ellipsis);
}

void lq_draw_text(cairo_t *cr, lq_label label, const char *text) {
    char shown[LQ_MESSAGE_SIZE + 4];
    cairo_text_extents_t extents;
    snprintf(shown, LQ_MESSAGE_SIZE, "%s", text);
    if (strlen(text) >= LQ_MESSAGE_SIZE) shorten(shown, sizeof shown);
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           label.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, label.size);
    cairo_text_extents(cr, shown, &extents);
    while (label.width > 0.0 && extents.x_advance > label.width && strlen(shown) > 3) {
        shorten(shown, sizeof shown);
        cairo_text_extents(cr, shown, &extents);
    }
    cairo_move_to(cr, label.x - label.align * extents.x_advance, label.y);
    cairo_show_text(cr, shown);
}

void lq_draw_line(cairo_t *cr, double x0, double y0, double x1, double y1) {
    cairo_move_to(cr, x0, y0);
    cairo_line_to(cr, x1, y1);
    cairo_stroke(cr);
}

void lq_draw_frame(cairo_t *cr, const lq_box *box) {
    lq_draw_ink(cr, LQ_INK_AXIS);
    cairo_set_line_width(cr, 1.0);
    cairo_rectangle(cr, box->x - 0.5, box->y - 0.5, box->width + 1.0, box->height + 1.0);
    cairo_stroke(cr);
}

/* "mu, 64 nodes, sqrt". */
static void describe(const lq_axis *axis, char *text, size_t size) {
    char map[48];
    snprintf(map, sizeof map, ", %s", lq_map_name(axis->map));
    if (axis->map == LQ_MAP_POWER) lq_print(map, sizeof map, ", power %g", axis->exponent);
    if (axis->map == LQ_MAP_LINEAR) map[0] = '\0';
    snprintf(text, size, "%s (%zu nodes%s)", axis->name, axis->size, map);
}

/* Nodes closer than this, in units, are not marked one by one. */
static const double node_gap = 3.0;

static bool marks_nodes(const lq_axis *axis, double length) {
    return axis->size > 1 && length / (double)(axis->size - 1) >= node_gap;
}

void lq_draw_x(cairo_t *cr, const lq_box *box, const lq_axis *axis) {
    lq_tick ticks[LQ_TICKS_MAX];
    char text[128];
    const double bottom = box->y + box->height + 1.0;
    lq_draw_ink(cr, LQ_INK_AXIS);
    cairo_set_line_width(cr, 0.75);
    for (size_t i = 0; marks_nodes(axis, box->width) && i < axis->size; i++) {
        const double at = box->x + box->width * (double)i / (double)(axis->size - 1);
        lq_draw_line(cr, at, bottom, at, bottom + 2.5);
    }
    const size_t count = lq_ticks(axis, 42.0 / box->width, ticks);
    for (size_t i = 0; i < count; i++) {
        const double at = box->x + box->width * ticks[i].at;
        lq_draw_ink(cr, LQ_INK_SOFT);
        cairo_set_line_width(cr, 1.0);
        lq_draw_line(cr, at, bottom, at, bottom + 6.0);
        lq_draw_text(cr, (lq_label){at, bottom + 18.0, 0.5, 11.5, 0.0, false}, ticks[i].text);
    }
    describe(axis, text, sizeof text);
    lq_draw_ink(cr, LQ_INK_TEXT);
    lq_draw_text(cr, (lq_label){box->x + 0.5 * box->width, bottom + 36.0, 0.5, 12.0, box->width, false},
                 text);
}

void lq_draw_side(cairo_t *cr, const lq_box *box, const char *text) {
    lq_draw_ink(cr, LQ_INK_TEXT);
    cairo_save(cr);
    cairo_translate(cr, box->x - 51.0, box->y + 0.5 * box->height);
    cairo_rotate(cr, -0.5 * 3.14159265358979323846);
    lq_draw_text(cr, (lq_label){0.0, 0.0, 0.5, 12.0, box->height, false}, text);
    cairo_restore(cr);
}

void lq_draw_y(cairo_t *cr, const lq_box *box, const lq_axis *axis) {
    lq_tick ticks[LQ_TICKS_MAX];
    char text[128];
    const double left = box->x - 1.0, bottom = box->y + box->height;
    lq_draw_ink(cr, LQ_INK_AXIS);
    cairo_set_line_width(cr, 0.75);
    for (size_t i = 0; marks_nodes(axis, box->height) && i < axis->size; i++) {
        const double at = bottom - box->height * (double)i / (double)(axis->size - 1);
        lq_draw_line(cr, left, at, left - 2.5, at);
    }
    const size_t count = lq_ticks(axis, 24.0 / box->height, ticks);
    for (size_t i = 0; i < count; i++) {
        const double at = bottom - box->height * ticks[i].at;
        lq_draw_ink(cr, LQ_INK_SOFT);
        cairo_set_line_width(cr, 1.0);
        lq_draw_line(cr, left, at, left - 6.0, at);
        lq_draw_text(cr, (lq_label){left - 9.0, at + 4.0, 1.0, 11.5, 0.0, false}, ticks[i].text);
    }
    describe(axis, text, sizeof text);
    lq_draw_side(cr, box, text);
}
