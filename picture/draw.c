/* draw.c - the whole figure onto a surface of cairo, and that into a file. */
#include "picture/draw_parts.h"

#include <cairo/cairo-svg.h>
#include <math.h>
#include <stdint.h>

#include "system/output.h"
#include "system/status.h"

/* A file that cairo writes to, and the first thing that went wrong with it. */
typedef struct sink {
    lq_output *output;
    lq_status status;
    lq_error *error;
} sink;

static cairo_status_t take(void *user, const unsigned char *bytes, unsigned int size) {
    sink *to = user;
    if (to->status == LQ_OK) to->status = lq_output_write(to->output, bytes, size, to->error);
    return to->status == LQ_OK ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static void draw_panel(cairo_t *cr, const lq_figure *figure, size_t i) {
    const lq_panel *panel = &figure->panels[i];
    const lq_box box = lq_draw_plot(figure, i);
    lq_draw_ink(cr, LQ_INK_TEXT);
    lq_draw_text(cr, (lq_label){box.x, box.y - 36.0, 0.0, 13.0, box.width + 100.0, true}, panel->title);
    lq_draw_ink(cr, LQ_INK_SOFT);
    lq_draw_text(cr, (lq_label){box.x, box.y - 21.0, 0.0, 11.5, box.width + 100.0, false}, panel->caption);
    if (panel->form == LQ_PANEL_MAP) lq_draw_map(cr, panel, &box);
    else lq_draw_chart(cr, panel, &box);
}

static void draw(cairo_t *cr, const lq_figure *figure, double width) {
    lq_draw_ink(cr, LQ_INK_PAGE);
    cairo_paint(cr);
    lq_draw_ink(cr, LQ_INK_TEXT);
    lq_draw_text(cr, (lq_label){20.0, 32.0, 0.0, 17.0, width - 40.0, true}, figure->title);
    lq_draw_ink(cr, LQ_INK_SOFT);
    lq_draw_text(cr, (lq_label){20.0, 52.0, 0.0, 12.0, width - 40.0, false}, figure->subtitle);
    for (size_t i = 0; i < figure->panel_count; i++) draw_panel(cr, figure, i);
}

static cairo_surface_t *open_surface(lq_image_form form, double width, double height, sink *to) {
    cairo_surface_t *surface = NULL;
    if (form == LQ_IMAGE_SVG) {
        surface = cairo_svg_surface_create_for_stream(take, to, width, height);
        cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
        return surface;
    }
    surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)(width * LQ_DRAW_SCALE),
                                         (int)(height * LQ_DRAW_SCALE));
    cairo_surface_set_device_scale(surface, LQ_DRAW_SCALE, LQ_DRAW_SCALE);
    return surface;
}

static lq_status draw_into(const lq_figure *figure, lq_image_form form, sink *to) {
    double width = 0.0, height = 0.0;
    lq_draw_size(figure, &width, &height);
    cairo_surface_t *surface = open_surface(form, width, height, to);
    cairo_t *cr = cairo_create(surface);
    draw(cr, figure, width);
    cairo_status_t status = cairo_status(cr);
    cairo_destroy(cr);
    if (status == CAIRO_STATUS_SUCCESS && form == LQ_IMAGE_PNG)
        status = cairo_surface_write_to_png_stream(surface, take, to);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    if (to->status != LQ_OK || status == CAIRO_STATUS_SUCCESS) return to->status;
    return lq_fail(to->error, status == CAIRO_STATUS_NO_MEMORY ? LQ_NO_MEMORY : LQ_BAD_INPUT,
                   "a picture of %.0f x %.0f: %s", width, height, cairo_status_to_string(status));
}

lq_status lq_draw_write(const lq_figure *figure, lq_image_form form, const char *path, lq_error *error) {
    sink to = {NULL, LQ_OK, error};
    const lq_status opened = lq_output_open(&to.output, path, error);
    if (opened != LQ_OK) return opened;
    const lq_status status = draw_into(figure, form, &to);
    if (status == LQ_OK) return lq_output_commit(to.output, error);
    lq_output_abandon(to.output);
    return status;
}

static lq_status draw_rows(const lq_rgb *pixels, size_t width, size_t height, sink *to) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)width, (int)height);
    cairo_status_t status = cairo_surface_status(surface);
    for (size_t y = 0; status == CAIRO_STATUS_SUCCESS && y < height; y++) {
        uint32_t *row = (uint32_t *)(void *)(cairo_image_surface_get_data(surface) +
                                             y * (size_t)cairo_image_surface_get_stride(surface));
        for (size_t x = 0; x < width; x++) {
            const lq_rgb *p = &pixels[y * width + x];
            row[x] = (uint32_t)p->r << 16 | (uint32_t)p->g << 8 | p->b;
        }
    }
    cairo_surface_mark_dirty(surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_write_to_png_stream(surface, take, to);
    cairo_surface_destroy(surface);
    if (to->status != LQ_OK || status == CAIRO_STATUS_SUCCESS) return to->status;
    return lq_fail(to->error, LQ_NO_MEMORY, "an image of %zu x %zu: %s", width, height,
                   cairo_status_to_string(status));
}

lq_status lq_draw_pixels(const lq_rgb *pixels, size_t width, size_t height, const char *path,
                         lq_error *error) {
    sink to = {NULL, LQ_OK, error};
    const lq_status opened = lq_output_open(&to.output, path, error);
    if (opened != LQ_OK) return opened;
    const lq_status status = draw_rows(pixels, width, height, &to);
    if (status == LQ_OK) return lq_output_commit(to.output, error);
    lq_output_abandon(to.output);
    return status;
}
