/* layout.c - where the panels of a figure lie: one large, or tiles in rows of two or three. */
#include "picture/draw_parts.h"

#include <math.h>

/* Room around a plot for its title, the labels of its axes, and its colours or names; in units. */
enum { LEFT = 66, RIGHT = 112, ABOVE = 48, BELOW = 54, HEAD = 66, COLUMNS = 3 };

static size_t columns(const lq_figure *figure) {
    if (figure->panel_count == 4) return 2;
    return figure->panel_count < COLUMNS ? (figure->panel_count ? figure->panel_count : 1) : COLUMNS;
}

static double target_width(const lq_figure *figure) {
    return figure->panel_count == 1 ? 600.0 : 290.0;
}

static double target_height(const lq_figure *figure) {
    return figure->panel_count == 1 ? 450.0 : 210.0;
}

/* A map gets a whole number of pixels from node to node, so that every node is a pixel, unless that leaves
 * too little of it. */
static double fit(double target, size_t nodes) {
    const size_t pixels = (size_t)target * LQ_DRAW_SCALE;
    if (nodes < 2 || nodes > pixels) return target;
    const double whole = (double)((pixels - 1) / (nodes - 1) * (nodes - 1) + 1) / LQ_DRAW_SCALE;
    return whole > 0.7 * target ? whole : target;
}

lq_box lq_draw_plot(const lq_figure *figure, size_t i) {
    const lq_panel *panel = &figure->panels[i];
    const double width = target_width(figure), height = target_height(figure);
    const double column = (double)(i % columns(figure)), row = floor((double)i / (double)columns(figure));
    lq_box box = {LEFT + column * (LEFT + width + RIGHT), HEAD + ABOVE + row * (ABOVE + height + BELOW),
                  width, height};
    if (panel->form != LQ_PANEL_MAP) return box;
    box.width = fit(width, panel->x.size);
    box.height = fit(height, panel->y.size);
    return box;
}

void lq_draw_size(const lq_figure *figure, double *width, double *height) {
    const double rows = ceil((double)figure->panel_count / (double)columns(figure));
    *width = (double)columns(figure) * (LEFT + target_width(figure) + RIGHT);
    *height = HEAD + rows * (ABOVE + target_height(figure) + BELOW);
}
