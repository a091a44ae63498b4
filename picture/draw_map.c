/* draw_map.c - values over two axes as colours, interpolated as a look-up does, and the bar that reads them.
 */
#include "picture/draw_parts.h"

#include <math.h>
#include <stdint.h>

/* A pixel's two nodes of one axis and how far it is from the first. */
typedef struct between {
    size_t low, high;
    double fraction;
} between;

static between find(size_t pixel, size_t pixels, size_t nodes) {
    if (nodes < 2) return (between){0, 0, 0.0};
    const double at = (double)pixel * (double)(nodes - 1) / (double)(pixels - 1);
    const double low = fmin(floor(at), (double)(nodes - 2));
    return (between){(size_t)low, (size_t)low + 1, at - low};
}

/* A node that has no weight has no say: it may be no number. */
static double mix(double a, double b, double fraction) {
    return fraction == 0.0 ? a : fraction == 1.0 ? b : a + (b - a) * fraction;
}

static double value_at(const lq_panel *panel, between x, between y) {
    const float *low = panel->values + y.low * panel->x.size, *high = panel->values + y.high * panel->x.size;
    return mix(mix((double)low[x.low], (double)low[x.high], x.fraction),
               mix((double)high[x.low], (double)high[x.high], x.fraction), y.fraction);
}

/* What a pixel's value is; row 0 is the top. */
typedef double pixel_value(const lq_panel *panel, size_t column, size_t row, size_t width, size_t height);

static double map_value(const lq_panel *panel, size_t column, size_t row, size_t width, size_t height) {
    return value_at(panel, find(column, width, panel->x.size), find(height - 1 - row, height, panel->y.size));
}

static double bar_value(const lq_panel *panel, size_t column, size_t row, size_t width, size_t height) {
    (void)column, (void)width;
    return panel->high + (panel->low - panel->high) * (double)row / (double)(height - 1);
}

static uint32_t pixel_of(const lq_panel *panel, const lq_rgb *steps, double value) {
    const int step = lq_colour_step(value, panel->low, panel->high);
    const lq_rgb colour = step < 0 ? lq_colour_bad() : steps[step];
    return (uint32_t)colour.r << 16 | (uint32_t)colour.g << 8 | colour.b;
}

static void fill(cairo_surface_t *image, const lq_panel *panel, size_t width, size_t height,
                 pixel_value *value) {
    lq_rgb steps[LQ_COLOUR_STEPS];
    unsigned char *data = cairo_image_surface_get_data(image);
    const size_t stride = (size_t)cairo_image_surface_get_stride(image);
    lq_colour_steps(panel->is_signed ? LQ_COLOURS_SIGNED : LQ_COLOURS_VALUE, steps);
    for (size_t row = 0; row < height; row++)
        for (size_t column = 0; column < width; column++)
            ((uint32_t *)(void *)(data + row * stride))[column] =
                pixel_of(panel, steps, value(panel, column, row, width, height));
    cairo_surface_mark_dirty(image);
}

/* An image of its own, a pixel a pixel of the page: cairo notes in `cr` where it cannot be made. */
static void paint(cairo_t *cr, const lq_panel *panel, const lq_box *box, pixel_value *value) {
    const size_t width = (size_t)lround(box->width * LQ_DRAW_SCALE);
    const size_t height = (size_t)lround(box->height * LQ_DRAW_SCALE);
    cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)width, (int)height);
    cairo_surface_flush(image);
    if (cairo_surface_status(image) == CAIRO_STATUS_SUCCESS) fill(image, panel, width, height, value);
    cairo_save(cr);
    cairo_translate(cr, box->x, box->y);
    cairo_scale(cr, 1.0 / LQ_DRAW_SCALE, 1.0 / LQ_DRAW_SCALE);
    cairo_set_source_surface(cr, image, 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
    cairo_paint(cr);
    cairo_restore(cr);
    cairo_surface_destroy(image);
}

static void draw_bar(cairo_t *cr, const lq_panel *panel, const lq_box *plot) {
    const lq_box box = {plot->x + plot->width + 16.0, plot->y, 14.0, plot->height};
    lq_tick ticks[LQ_TICKS_MAX];
    paint(cr, panel, &box, bar_value);
    lq_draw_frame(cr, &box);
    const size_t count = lq_ticks_linear(panel->low, panel->high, 30.0 / box.height, ticks);
    for (size_t i = 0; i < count; i++) {
        const double at = box.y + box.height * (1.0 - ticks[i].at), right = box.x + box.width + 1.0;
        lq_draw_ink(cr, LQ_INK_SOFT);
        lq_draw_line(cr, right, at, right + 5.0, at);
        lq_draw_text(cr, (lq_label){right + 8.0, at + 4.0, 0.0, 11.5, 0.0, false}, ticks[i].text);
    }
    lq_draw_ink(cr, LQ_INK_SOFT);
    lq_draw_text(cr, (lq_label){box.x, box.y - 8.0, 0.0, 11.5, 90.0, false}, panel->quantity);
}

void lq_draw_map(cairo_t *cr, const lq_panel *panel, const lq_box *box) {
    paint(cr, panel, box, map_value);
    lq_draw_frame(cr, box);
    lq_draw_x(cr, box, &panel->x);
    lq_draw_y(cr, box, &panel->y);
    draw_bar(cr, panel, box);
}
