/* draw_chart.c - series over one axis: curves, or areas on top of each other. */
#include "picture/draw_parts.h"

#include <math.h>

static void set_colour(cairo_t *cr, const lq_panel *panel, size_t i) {
    const size_t count = panel->series_count - panel->reference;
    if (i == count) lq_draw_ink(cr, LQ_INK_AXIS);
    else if (panel->ordered || count > LQ_COLOUR_HUES) lq_draw_colour(cr, lq_colour_ordered(i, count));
    else lq_draw_colour(cr, lq_colour_hue(i));
}

static double x_of(const lq_panel *panel, const lq_box *box, size_t i) {
    return box->x + (panel->x.size > 1 ? box->width * (double)i / (double)(panel->x.size - 1) : 0.0);
}

/* Curves keep clear of the frame above and below. */
static double y_of(const lq_panel *panel, const lq_box *box, double value) {
    const double inset = panel->form == LQ_PANEL_LINES ? 6.0 : 0.0;
    return box->y + inset +
           (box->height - 2.0 * inset) * (1.0 - (value - panel->low) / (panel->high - panel->low));
}

static void draw_scale(cairo_t *cr, const lq_panel *panel, const lq_box *box) {
    lq_tick ticks[LQ_TICKS_MAX];
    const size_t count = lq_ticks_linear(panel->low, panel->high, 24.0 / box->height, ticks);
    cairo_set_line_width(cr, 1.0);
    for (size_t i = 0; i < count; i++) {
        const double at = y_of(panel, box, ticks[i].value);
        lq_draw_ink(cr, LQ_INK_GRID);
        lq_draw_line(cr, box->x, at, box->x + box->width, at);
        lq_draw_ink(cr, LQ_INK_SOFT);
        lq_draw_text(cr, (lq_label){box->x - 9.0, at + 4.0, 1.0, 11.5, 0.0, false}, ticks[i].text);
    }
    lq_draw_side(cr, box, panel->quantity);
}

/* A curve has gaps where there is no number. */
static void draw_line(cairo_t *cr, const lq_panel *panel, const lq_box *box, size_t series) {
    const float *values = panel->values + series * panel->x.size;
    for (size_t i = 0; i < panel->x.size; i++) {
        if (!isfinite(values[i])) cairo_new_sub_path(cr);
        else cairo_line_to(cr, x_of(panel, box, i), y_of(panel, box, (double)values[i]));
    }
    const double dash[] = {5.0, 4.0};
    if (panel->reference && series + 1 == panel->series_count) cairo_set_dash(cr, dash, 2, 0.0);
    cairo_set_line_width(cr, 1.75);
    cairo_stroke(cr);
    cairo_set_dash(cr, dash, 0, 0.0);
}

static double sum_below(const lq_panel *panel, size_t series, size_t i) {
    double sum = 0.0;
    for (size_t s = 0; s < series; s++) sum += (double)panel->values[s * panel->x.size + i];
    return sum;
}

static void draw_area(cairo_t *cr, const lq_panel *panel, const lq_box *box, size_t series) {
    const size_t size = panel->x.size;
    for (size_t i = 0; i < size; i++)
        cairo_line_to(cr, x_of(panel, box, i), y_of(panel, box, sum_below(panel, series, i)));
    for (size_t i = size; i-- > 0;)
        cairo_line_to(cr, x_of(panel, box, i), y_of(panel, box, sum_below(panel, series + 1, i)));
    cairo_fill(cr);
}

/* Names beside the plot, from the top of the pile down; of many series only some. */
static void draw_names(cairo_t *cr, const lq_panel *panel, const lq_box *box) {
    const size_t count = panel->series_count, fit = (size_t)(box->height / 18.0);
    const size_t every = (count + fit - 1) / fit;
    double y = box->y + 10.0;
    for (size_t k = 0; count > 1 && k < count; k++) {
        const size_t i = panel->form == LQ_PANEL_AREAS ? count - 1 - k : k;
        if (i % every != 0) continue;
        set_colour(cr, panel, i);
        cairo_rectangle(cr, box->x + box->width + 12.0, y - 9.0, 11.0, 11.0);
        cairo_fill(cr);
        lq_draw_ink(cr, LQ_INK_TEXT);
        lq_draw_text(cr, (lq_label){box->x + box->width + 28.0, y, 0.0, 11.5, 82.0, false}, panel->series[i]);
        y += 18.0;
    }
}

void lq_draw_chart(cairo_t *cr, const lq_panel *panel, const lq_box *box) {
    draw_scale(cr, panel, box);
    cairo_save(cr);
    cairo_rectangle(cr, box->x, box->y - 1.0, box->width, box->height + 2.0);
    cairo_clip(cr);
    for (size_t i = 0; i < panel->series_count; i++) {
        set_colour(cr, panel, i);
        if (panel->form == LQ_PANEL_AREAS) draw_area(cr, panel, box, i);
        else draw_line(cr, panel, box, i);
    }
    cairo_restore(cr);
    lq_draw_frame(cr, box);
    lq_draw_x(cr, box, &panel->x);
    draw_names(cr, panel, box);
}
