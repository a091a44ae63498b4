/* The SVG plotter: scales and ticks first, then the parts of the page from back to front. */
#include "tables/plot.h"

#include "system/number.h"
#include "system/status.h"
#include "system/stream.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The page in px. The left margin holds tick labels, the top margin title, subtitle and legend. */
static const double width = 800, height = 500, left = 72, right = 28, top = 104, bottom = 62;

/* Hues that keep apart for colour-blind readers; both columns have contrast 3:1 or more on their page. */
static const char style[] =
    "<style>\n"
    "text{font-family:system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif;font-size:12px}\n"
    ".page{fill:#fcfcfb}.ring{stroke:#fcfcfb}.ink{fill:#1a1a19}.soft{fill:#63625e}\n"
    ".halo{stroke:#fcfcfb;stroke-width:3px;stroke-linejoin:round;paint-order:stroke}\n"
    ".grid{stroke:#e6e5e0}.axis{stroke:#8f8e88}\n"
    ".h0{color:#2a6fdb}.h1{color:#c8501e}.h2{color:#0f8a66}.h3{color:#8a4fc7}\n"
    "@media (prefers-color-scheme:dark){\n"
    ".page{fill:#1a1a19}.ring{stroke:#1a1a19}.ink{fill:#f4f3ef}.soft{fill:#b3b2ab}\n"
    ".halo{stroke:#1a1a19}.grid{stroke:#33332f}.axis{stroke:#7a7973}\n"
    ".h0{color:#5b9bf2}.h1{color:#f0824f}.h2{color:#35b78f}.h3{color:#b48ae6}}\n"
    "</style>\n";

/* ======================================================================================
 *                                    Scales and ticks
 * ====================================================================================== */

typedef struct scale {
    bool logarithmic;
    double low, high, step; /* of the value or of its decimal logarithm; step between labels */
    double start, length;   /* px; length is negative where values grow upwards */
} scale;

static bool drawable(double v, bool logarithmic) {
    return isfinite(v) && (!logarithmic || v > 0.0);
}

static bool has_point(const lq_plot *plot, const lq_plot_line *series, size_t i) {
    return drawable(series->x[i], plot->x.logarithmic) && drawable(series->y[i], plot->y.logarithmic);
}

static double position(const scale *s, double v) {
    const double at = s->logarithmic ? log10(v) : v;
    return s->start + s->length * (at - s->low) / (s->high - s->low);
}

/* 1, 2 or 5 times a power of ten that cuts `range` into about `parts`. */
static double nice_step(double range, double parts) {
    const double raw = range / parts;
    const double power = pow(10.0, floor(log10(raw)));
    const double lead = raw / power;
    return power * (lead <= 1.0 ? 1.0 : lead <= 2.0 ? 2.0 : lead <= 5.0 ? 5.0 : 10.0);
}

/* Widen [low, high] to whole steps: whole decades on a logarithmic axis. */
static void round_out(scale *s) {
    if (s->high - s->low < 1e-12 * fmax(fabs(s->low), 1.0)) {
        s->low -= 0.5;
        s->high += 0.5;
    }
    s->step = s->logarithmic ? ceil((s->high - s->low) / 10.0) : nice_step(s->high - s->low, 5.0);
    const double slack = 1e-9 * s->step;
    s->low = s->step * floor((s->low + slack) / s->step);
    s->high = s->step * ceil((s->high - slack) / s->step);
}

static void include(scale *s, double v) {
    const double at = s->logarithmic ? log10(v) : v;
    s->low = fmin(s->low, at);
    s->high = fmax(s->high, at);
}

/* False: no point can be drawn. */
static bool make_scales(const lq_plot *plot, scale *x, scale *y) {
    *x = (scale){plot->x.logarithmic, INFINITY, -INFINITY, 1.0, left, width - left - right};
    *y = (scale){plot->y.logarithmic, INFINITY, -INFINITY, 1.0, height - bottom, top + bottom - height};
    for (size_t k = 0; k < plot->series_count; k++)
        for (size_t i = 0; i < plot->series[k].count; i++) {
            if (!has_point(plot, &plot->series[k], i)) continue;
            include(x, plot->series[k].x[i]);
            include(y, plot->series[k].y[i]);
        }
    if (!isfinite(x->low)) return false;
    round_out(x);
    round_out(y);
    return true;
}

/* ======================================================================================
 *                                          Text
 * ====================================================================================== */

static void put_text(FILE *out, const char *text) {
    for (const char *c = text; *c; c++) {
        if (*c == '<') fputs("&lt;", out);
        else if (*c == '>') fputs("&gt;", out);
        else if (*c == '&') fputs("&amp;", out);
        else if ((unsigned char)*c >= ' ') fputc(*c, out);
    }
}

static void put_line(FILE *out, double x, double y, const char *attributes, const char *text) {
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, attributes);
    put_text(out, text);
    fputs("</text>\n", out);
}

void lq_plot_power(char *text, int power) {
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int digits = abs(power) % 1000;
    snprintf(text, 24, "10%s%s%s%s", power < 0 ? "⁻" : "", digits >= 100 ? raised[digits / 100] : "",
             digits >= 10 ? raised[digits / 10 % 10] : "", raised[digits % 10]);
}

/* A tick at `at`: 1, 10, 100 or 10 to a superscript power on a logarithmic axis, otherwise a plain number. */
static void format_tick(char *text, const scale *s, double at) {
    const double power = round(at);
    if (!s->logarithmic) lq_print(text, 24, "%.6g", fabs(at) < 1e-9 * s->step ? 0.0 : at);
    else if (power >= 0.0 && power <= 2.0) lq_print(text, 24, "%.0f", pow(10.0, power));
    else lq_plot_power(text, (int)power);
}

/* A rough width in px of a text of 12 px: characters, not bytes, at the mean width of a sans serif. */
static double text_width(const char *text) {
    double characters = 0.0;
    for (const char *c = text; *c; c++) characters += ((unsigned char)*c & 0xC0) != 0x80;
    return 6.6 * characters;
}

/* ======================================================================================
 *                                   Parts of the page
 * ====================================================================================== */

static void draw_head(FILE *out, const lq_plot *plot) {
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
            "height=\"%.0f\" role=\"img\">\n<title>",
            width, height, width, height);
    put_text(out, plot->title);
    fprintf(out, "</title>\n%s<rect class=\"page\" width=\"%.0f\" height=\"%.0f\"/>\n", style, width, height);
    put_line(out, 20, 32, "class=\"ink\" style=\"font-size:17px;font-weight:600\"", plot->title);
    if (plot->subtitle) put_line(out, 20, 52, "class=\"soft\"", plot->subtitle);
}

static void draw_grid(FILE *out, const scale *s, bool horizontal) {
    char text[24];
    for (double at = s->low; at < s->high + 0.5 * s->step; at += s->step) {
        const double p = s->start + s->length * (at - s->low) / (s->high - s->low);
        format_tick(text, s, at);
        if (horizontal) {
            fprintf(out, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", p, top, height - bottom);
            put_line(out, p, height - bottom + 19, "class=\"soft\" text-anchor=\"middle\"", text);
        } else {
            fprintf(out, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", left, p, width - right);
            put_line(out, left - 9, p + 4, "class=\"soft\" text-anchor=\"end\"", text);
        }
    }
}

static void draw_axes(FILE *out, const lq_plot *plot, const scale *x, const scale *y) {
    draw_grid(out, x, true);
    draw_grid(out, y, false);
    fprintf(out, "<path class=\"axis\" fill=\"none\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", left, top,
            height - bottom, width - right);
    put_line(out, 0.5 * (left + width - right), height - 16, "class=\"ink\" text-anchor=\"middle\"",
             plot->x.label);
    char place[128];
    const double middle = 0.5 * (top + height - bottom);
    lq_print(place, sizeof place, "class=\"ink\" text-anchor=\"middle\" transform=\"rotate(-90 22 %.1f)\"",
             middle);
    put_line(out, 22, middle, place, plot->y.label);
}

/* One shape a hue, so that colour is never the only difference. */
static void draw_marker(FILE *out, const lq_plot_line *series, double x, double y) {
    static const char *const shapes[LQ_PLOT_HUES] = {"M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z",
                                                     "M-4 -4h8v8h-8z", "M0 -5.2L5 3.8H-5z",
                                                     "M0 -5.6L5.6 0L0 5.6L-5.6 0z"};
    const char *paint = series->secondary ? "class=\"page\" stroke=\"currentColor\" stroke-width=\"1.6\""
                                          : "class=\"ring\" fill=\"currentColor\" stroke-width=\"1\"";
    fprintf(out, "<path %s d=\"%s\" transform=\"translate(%.1f %.1f)\"/>\n", paint, shapes[series->hue], x,
            y);
}

static const char *dashes(const lq_plot_line *series) {
    return series->secondary ? " stroke-dasharray=\"5 4\"" : "";
}

static void draw_series(FILE *out, const lq_plot *plot, const lq_plot_line *series, const scale *x,
                        const scale *y) {
    fprintf(
        out,
        "<g class=\"h%d\">\n<polyline fill=\"none\" stroke=\"currentColor\" stroke-width=\"2\"%s points=\"",
        series->hue, dashes(series));
    for (size_t i = 0; i < series->count; i++)
        if (has_point(plot, series, i))
            fprintf(out, "%.1f,%.1f ", position(x, series->x[i]), position(y, series->y[i]));
    fputs("\"/>\n", out);
    for (size_t i = 0; i < series->count; i++)
        if (has_point(plot, series, i))
            draw_marker(out, series, position(x, series->x[i]), position(y, series->y[i]));
    fputs("</g>\n", out);
}

/* Below and left of the point, where falling curves leave room; above and right at the left edge. */
static void draw_labels(FILE *out, const lq_plot *plot, const lq_plot_line *series, const scale *x,
                        const scale *y) {
    for (size_t i = 0; series->labels && i < series->count; i++) {
        if (!has_point(plot, series, i)) continue;
        const double px = position(x, series->x[i]), py = position(y, series->y[i]);
        if (px - 10 - text_width(series->labels[i]) > left)
            put_line(out, px - 8, py + 15, "class=\"soft halo\" text-anchor=\"end\"", series->labels[i]);
        else put_line(out, px + 9, py - 8, "class=\"soft halo\"", series->labels[i]);
    }
}

static void draw_legend(FILE *out, const lq_plot *plot) {
    double x = left;
    for (size_t k = 0; k < plot->series_count; k++) {
        const lq_plot_line *series = &plot->series[k];
        fprintf(out,
                "<g class=\"h%d\"><path stroke=\"currentColor\" stroke-width=\"2\"%s d=\"M%.1f %.1fh28\"/>\n",
                series->hue, dashes(series), x, top - 24);
        draw_marker(out, series, x + 14, top - 24);
        fputs("</g>\n", out);
        put_line(out, x + 36, top - 20, "class=\"ink\"", series->name);
        x += 60 + text_width(series->name);
    }
}

static void draw_span(FILE *out, const lq_plot_span *span, const scale *x, const scale *y) {
    const double from = position(x, span->x_from), to = position(x, span->x_to), p = position(y, span->y);
    const double gap = 9.0; /* keeps the tips off the markers */
    const double a = fmax(fmin(from, to) + gap, left), b = fmin(fmax(from, to) - gap, width - right);
    if (!(p >= top && p <= height - bottom) || !(b - a > 20.0)) return;
    fprintf(out,
            "<path fill=\"none\" class=\"axis\" stroke-width=\"1.5\" d=\"M%.1f %.1fH%.1f"
            "M%.1f %.1fl-7 4l7 4M%.1f %.1fl7 4l-7 4\"/>\n",
            a, p, b, a + 7, p - 4, b - 7, p - 4);
    put_line(out, 0.5 * (a + b), p - 8, "class=\"ink halo\" text-anchor=\"middle\" style=\"font-weight:600\"",
             span->label);
}

/* ======================================================================================
 *                                        The file
 * ====================================================================================== */

static void draw(FILE *out, const lq_plot *plot, const scale *x, const scale *y) {
    draw_head(out, plot);
    draw_axes(out, plot, x, y);
    if (plot->span) draw_span(out, plot->span, x, y);
    for (size_t k = 0; k < plot->series_count; k++) draw_series(out, plot, &plot->series[k], x, y);
    for (size_t k = 0; k < plot->series_count; k++) draw_labels(out, plot, &plot->series[k], x, y);
    draw_legend(out, plot);
    fputs("</svg>\n", out);
}

static lq_status check(const lq_plot *plot, lq_error *error) {
    if (plot->series_count == 0 || plot->series_count > LQ_PLOT_MAX_SERIES)
        return lq_fail(error, LQ_BAD_INPUT, "plot: %zu series, accepted are 1 to %d", plot->series_count,
                       LQ_PLOT_MAX_SERIES);
    for (size_t k = 0; k < plot->series_count; k++)
        if (plot->series[k].hue < 0 || plot->series[k].hue >= LQ_PLOT_HUES)
            return lq_fail(error, LQ_BAD_INPUT, "plot: hue %d, accepted are 0 to %d", plot->series[k].hue,
                           LQ_PLOT_HUES - 1);
    return LQ_OK;
}

lq_status lq_plot_draw(const lq_plot *plot, FILE *out, lq_error *error) {
    scale x, y;
    const lq_status status = check(plot, error);
    if (status != LQ_OK) return status;
    if (!make_scales(plot, &x, &y)) return lq_fail(error, LQ_BAD_INPUT, "plot: no point that can be drawn");
    draw(out, plot, &x, &y);
    return LQ_OK;
}

lq_status lq_plot_write(const lq_plot *plot, const char *path, lq_error *error) {
    lq_stream stream;
    const lq_status opened = lq_stream_open(&stream, path, error);
    if (opened != LQ_OK) return opened;
    return lq_stream_close(&stream, lq_plot_draw(plot, stream.out, error), error);
}
