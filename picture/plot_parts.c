/* plot_parts.c - where a value lies on a page, and text. */
#include "picture/plot_parts.h"

#include "picture/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool drawable(double v, bool logarithmic) {
    return isfinite(v) && (!logarithmic || v > 0.0);
}

bool lq_plot_has(const lq_plot *plot, const lq_plot_line *series, size_t i) {
    return drawable(series->x[i], plot->x.logarithmic) && drawable(series->y[i], plot->y.logarithmic);
}

double lq_plot_at(const lq_plot_scale *s, double v) {
    const double at = s->logarithmic ? log10(v) : v;
    return s->start + s->length * (at - s->low) / (s->high - s->low);
}

/* ======================================================================================
 *                                          Text
 * ====================================================================================== */

void lq_plot_text(FILE *out, double x, double y, const char *attributes, const char *text) {
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, attributes);
    lq_text_put(out, text);
    fputs("</text>\n", out);
}

void lq_plot_power(char *text, int power) {
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int digits = abs(power) % 1000;
    snprintf(text, 24, "10%s%s%s%s", power < 0 ? "⁻" : "", digits >= 100 ? raised[digits / 100] : "",
             digits >= 10 ? raised[digits / 10 % 10] : "", raised[digits % 10]);
}

double lq_plot_text_width(const char *text) {
    double characters = 0.0;
    for (const char *c = text; *c; c++) characters += ((unsigned char)*c & 0xC0) != 0x80;
    return 6.6 * characters;
}
