/* The SVG plotter: scales and ticks first, then the parts of the page from back to front. */
#include "picture/plot_parts.h"

#include "picture/text.h"
#include "system/number.h"
#include "system/status.h"
#include "system/stream.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double width = LQ_PLOT_WIDTH, height = LQ_PLOT_HEIGHT, left = LQ_PLOT_LEFT,
                    right = LQ_PLOT_RIGHT, top = LQ_PLOT_TOP, bottom = LQ_PLOT_BOTTOM;

/* ======================================================================================
 *                                    Scales and ticks
 * ====================================================================================== */

/* 1, 2 or 5 times a power of ten that cuts `range` into about `parts`. */
static double nice_step(double range, double parts) {
    const double raw = range / parts;
    const double power = pow(10.0, floor(log10(raw)));
    const double lead = raw / power;
    return power * (lead <= 1.0 ? 1.0 : lead <= 2.0 ? 2.0 : lead <= 5.0 ? 5.0 : 10.0);
}

/* Widen [low, high] to whole steps: whole decades on a logarithmic axis. */
static void round_out(lq_plot_scale *s) {
    if (s->high - s->low < 1e-12 * fmax(fabs(s->low), 1.0)) {
        s->low -= 0.5;
        s->high += 0.5;
    }
    s->step = s->logarithmic ? ceil((s->high - s->low) / 10.0) : nice_step(s->high - s->low, 5.0);
    const double slack = 1e-9 * s->step;
    s->low = s->step * floor((s->low + slack) / s->step);
    s->high = s->step * ceil((s->high - slack) / s->step);
}

static void include(lq_plot_scale *s, double v) {
    const double at = s->logarithmic ? log10(v) : v;
    s->low = fmin(s->low, at);
    s->high = fmax(s->high, at);
}

/* A tick at `at`: 1, 10, 100 or 10 to a superscript power on a logarithmic axis, otherwise a plain number. */
static void format_tick(char *text, const lq_plot_scale *s, double at) {
    const double power = round(at);
    if (!s->logarithmic) lq_print(text, 24, "%.6g", fabs(at) < 1e-9 * s->step ? 0.0 : at);
    else if (power >= 0.0 && power <= 2.0) lq_print(text, 24, "%.0f", pow(10.0, power));
    else lq_plot_power(text, (int)power);
}

/* False: no point can be drawn. */
static bool make_scales(const lq_plot *plot, lq_plot_scale *x, lq_plot_scale *y) {
    *x = (lq_plot_scale){plot->x.logarithmic, INFINITY, -INFINITY, 1.0, left, width - left - right};
    *y = (lq_plot_scale){plot->y.logarithmic,  INFINITY, -INFINITY, 1.0, height - bottom,
                         top + bottom - height};
    for (size_t k = 0; k < plot->series_count; k++)
        for (size_t i = 0; i < plot->series[k].count; i++) {
            if (!lq_plot_has(plot, &plot->series[k], i)) continue;
            include(x, plot->series[k].x[i]);
            include(y, plot->series[k].y[i]);
        }
    if (!isfinite(x->low)) return false;
    if (plot->rule) include(y, plot->rule->y);
    round_out(x);
    round_out(y);
    return true;
}

/* ======================================================================================
 *                                   Parts of the page
 * ====================================================================================== */

static void draw_grid(FILE *out, const lq_plot_scale *s, bool horizontal) {
    char text[24];
    for (double at = s->low; at < s->high + 0.5 * s->step; at += s->step) {
        const double p = s->start + s->length * (at - s->low) / (s->high - s->low);
        format_tick(text, s, at);
        if (horizontal) {
            fprintf(out, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", p, top, height - bottom);
            lq_plot_text(out, p, height - bottom + 19, "class=\"soft\" text-anchor=\"middle\"", text);
        } else {
            fprintf(out, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", left, p, width - right);
            lq_plot_text(out, left - 9, p + 4, "class=\"soft\" text-anchor=\"end\"", text);
        }
    }
}

static void draw_axes(FILE *out, const lq_plot *plot, const lq_plot_scale *x, const lq_plot_scale *y) {
    draw_grid(out, x, true);
    draw_grid(out, y, false);
    fprintf(out, "<path class=\"axis\" fill=\"none\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", left, top,
            height - bottom, width - right);
    lq_plot_text(out, 0.5 * (left + width - right), height - 16, "class=\"ink\" text-anchor=\"middle\"",
                 plot->x.label);
    char place[128];
    const double middle = 0.5 * (top + height - bottom);
    lq_print(place, sizeof place, "class=\"ink\" text-anchor=\"middle\" transform=\"rotate(-90 22 %.1f)\"",
             middle);
    lq_plot_text(out, 22, middle, place, plot->y.label);
}

static void draw_series(FILE *out, const lq_plot *plot, const lq_plot_line *series, const lq_plot_scale *x,
                        const lq_plot_scale *y) {
    fprintf(out, "<g class=\"h%d\"%s>\n", series->hue,
            series->scatter || series->under ? " opacity=\"0.55\"" : "");
    if (!series->scatter) {
        fprintf(out, "<polyline fill=\"none\" stroke=\"currentColor\" stroke-width=\"%d\"%s points=\"",
                series->under ? 7 : 2, lq_plot_dashes(series));
        for (size_t i = 0; i < series->count; i++)
            if (lq_plot_has(plot, series, i))
                fprintf(out, "%.1f,%.1f ", lq_plot_at(x, series->x[i]), lq_plot_at(y, series->y[i]));
        fputs("\"/>\n", out);
    }
    for (size_t i = 0; i < series->count; i++)
        if (lq_plot_has(plot, series, i) && lq_plot_marked(series, i))
            lq_plot_marker(out, series, lq_plot_at(x, series->x[i]), lq_plot_at(y, series->y[i]));
    fputs("</g>\n", out);
}

static void draw_rule(FILE *out, const lq_plot_rule *rule, const lq_plot_scale *y) {
    const double p = lq_plot_at(y, rule->y);
    fprintf(out,
            "<path class=\"rule\" stroke-width=\"1.5\" stroke-dasharray=\"8 3\" d=\"M%.1f %.1fH%.1f\"/>\n",
            left, p, width - right);
    lq_plot_text(out, width - right - 4, p - 6, "class=\"ruled halo\" text-anchor=\"end\"", rule->label);
}

static void draw_span(FILE *out, const lq_plot_span *span, const lq_plot_scale *x, const lq_plot_scale *y) {
    const double from = lq_plot_at(x, span->x_from), to = lq_plot_at(x, span->x_to),
                 p = lq_plot_at(y, span->y);
    const double gap = 9.0; /* keeps the tips off the markers */
    const double a = fmax(fmin(from, to) + gap, left), b = fmin(fmax(from, to) - gap, width - right);
    if (!(p >= top && p <= height - bottom) || !(b - a > 20.0)) return;
    fprintf(out,
            "<path fill=\"none\" class=\"axis\" stroke-width=\"1.5\" d=\"M%.1f %.1fH%.1f"
            "M%.1f %.1fl-7 4l7 4M%.1f %.1fl7 4l-7 4\"/>\n",
            a, p, b, a + 7, p - 4, b - 7, p - 4);
    lq_plot_text(out, 0.5 * (a + b), p - 8,
                 "class=\"ink halo\" text-anchor=\"middle\" style=\"font-weight:600\"", span->label);
}

/* ======================================================================================
 *                                        The file
 * ====================================================================================== */

static void draw(FILE *out, const lq_plot *plot, const lq_plot_scale *x, const lq_plot_scale *y,
                 const char *style) {
    lq_plot_head(out, plot, style);
    draw_axes(out, plot, x, y);
    if (plot->rule) draw_rule(out, plot->rule, y);
    if (plot->span) draw_span(out, plot->span, x, y);
    for (size_t k = 0; k < plot->series_count; k++) draw_series(out, plot, &plot->series[k], x, y);
    lq_plot_labels(out, plot, x, y);
    lq_plot_legend(out, plot);
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

static lq_status draw_checked(const lq_plot *plot, FILE *out, const char *style, lq_error *error) {
    lq_plot_scale x, y;
    const lq_status status = check(plot, error);
    if (status != LQ_OK) return status;
    if (!make_scales(plot, &x, &y)) return lq_fail(error, LQ_BAD_INPUT, "plot: no point that can be drawn");
    draw(out, plot, &x, &y, style);
    return LQ_OK;
}

lq_status lq_plot_draw(const lq_plot *plot, FILE *out, lq_error *error) {
    return draw_checked(plot, out, NULL, error);
}

lq_status lq_plot_write(const lq_plot *plot, const char *path, lq_error *error) {
    lq_stream stream;
    const lq_status opened = lq_stream_open(&stream, path, error);
    if (opened != LQ_OK) return opened;
    return lq_stream_close(&stream, draw_checked(plot, stream.out, lq_plot_style, error), error);
}
