/* draw.h - a figure as an image: PNG or SVG, one drawing through cairo. */
#ifndef LACQUER_PICTURE_DRAW_H
#define LACQUER_PICTURE_DRAW_H

#include "picture/colour.h"
#include "picture/figure.h"

typedef enum lq_image_form { LQ_IMAGE_PNG, LQ_IMAGE_SVG } lq_image_form;

/* Pixels of a PNG a unit of length. */
enum { LQ_DRAW_SCALE = 2 };

/* Where things lie, in units; a PNG has LQ_DRAW_SCALE pixels a unit. */
typedef struct lq_box {
    double x, y, width, height;
} lq_box;

/* The plot of a panel: what is inside its frame. In a map node i of n is the column of pixels at
 * i / (n - 1) of the width less one pixel, counted from the left, and rows likewise from below. */
lq_box lq_draw_plot(const lq_figure *figure, size_t panel);
void lq_draw_size(const lq_figure *figure, double *width, double *height);

/* The file appears whole or not at all. */
lq_status lq_draw_write(const lq_figure *figure, lq_image_form form, const char *path, lq_error *error);

/* Pixels as they are, as PNG; row 0 is the top. */
lq_status lq_draw_pixels(const lq_rgb *pixels, size_t width, size_t height, const char *path,
                         lq_error *error);

#endif
