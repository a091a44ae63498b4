/* draw_parts.h - what the files that draw share: ink, text, ticks. */
#ifndef LACQUER_PICTURE_DRAW_PARTS_H
#define LACQUER_PICTURE_DRAW_PARTS_H

#include <cairo/cairo.h>

#include "picture/colour.h"
#include "picture/draw.h"
#include "picture/ticks.h"

typedef enum lq_ink { LQ_INK_TEXT, LQ_INK_SOFT, LQ_INK_AXIS, LQ_INK_GRID, LQ_INK_PAGE } lq_ink;

void lq_draw_ink(cairo_t *cr, lq_ink ink);
void lq_draw_colour(cairo_t *cr, lq_rgb colour);

/* Text at a point, `align` of its width to the left of it: 0, 0.5 or 1; cut with an ellipsis at `width`. */
typedef struct lq_label {
    double x, y, align, size, width;
    bool bold;
} lq_label;
void lq_draw_text(cairo_t *cr, lq_label label, const char *text);

void lq_draw_line(cairo_t *cr, double x0, double y0, double x1, double y1);

/* The frame of a plot with the ticks of x below it, and the name of its axis. */
void lq_draw_frame(cairo_t *cr, const lq_box *box);
void lq_draw_x(cairo_t *cr, const lq_box *box, const lq_axis *axis);
/* Upwards, left of the plot. */
void lq_draw_side(cairo_t *cr, const lq_box *box, const char *text);
void lq_draw_y(cairo_t *cr, const lq_box *box, const lq_axis *axis);

void lq_draw_map(cairo_t *cr, const lq_panel *panel, const lq_box *box);
void lq_draw_chart(cairo_t *cr, const lq_panel *panel, const lq_box *box);

#endif
