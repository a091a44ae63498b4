/* plot_head.c - above a chart: its title, which fits, and the legend with its markers. */
#include "picture/plot_parts.h"

#include <math.h>
#include <string.h>

#include "picture/text.h"
#include "system/number.h"

/* ======================================================================================
 *                                         Title
 * ====================================================================================== */

enum { TITLE = 17, SMALLER = 14, TITLE_TEXT = 400 };

static double title_width(const char *text, double size) {
    return lq_plot_text_width(text) * size / 12.0 * 1.04; /* bold */
}

/* Where the first of two lines ends: the last blank before it is full; 0: there is none. */
static size_t fold(const char *text, double size, double room) {
    char part[TITLE_TEXT];
    size_t at = 0;
    for (size_t i = 0; text[i] && i < sizeof part; i++) {
        memcpy(part, text, i);
        part[i] = '\0';
        if (title_width(part, size) > room) break;
        if (text[i] == ' ') at = i;
    }
    return at;
}

static void put_title(FILE *out, double y, double size, const char *text) {
    char attributes[96];
    lq_print(attributes, sizeof attributes, "class=\"ink\" style=\"font-size:%.3gpx;font-weight:600\"", size);
    lq_plot_text(out, 20, y, attributes, text);
}

/* One line; smaller; two lines; as small as it takes. Returns the base line of what is below. */
static double draw_title(FILE *out, const char *text) {
    const double room = LQ_PLOT_WIDTH - 40.0;
    if (title_width(text, TITLE) <= room || title_width(text, SMALLER) <= room) {
        put_title(out, 32, title_width(text, TITLE) <= room ? TITLE : SMALLER, text);
        return 52;
    }
    char first[TITLE_TEXT];
    const size_t end = fold(text, SMALLER, room);
    snprintf(first, sizeof first, "%.*s", (int)end, text);
    const char *rest = end > 0 ? text + end + 1 : text;
    if (end > 0) put_title(out, 24, SMALLER, first);
    put_title(out, 42, fmin(SMALLER, SMALLER * room / title_width(rest, SMALLER)), rest);
    return 60;
}

void lq_plot_head(FILE *out, const lq_plot *plot, const char *style) {
    fprintf(out,
            "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" "
            "height=\"%d\" role=\"img\">\n<title>",
            LQ_PLOT_WIDTH, LQ_PLOT_HEIGHT, LQ_PLOT_WIDTH, LQ_PLOT_HEIGHT);
    lq_text_put(out, plot->title);
    fputs("</title>\n", out);
    if (style) fprintf(out, "<style>\n%s</style>\n", style);
    fprintf(out, "<rect class=\"page\" width=\"%d\" height=\"%d\"/>\n", LQ_PLOT_WIDTH, LQ_PLOT_HEIGHT);
    const double below = draw_title(out, plot->title);
    if (plot->subtitle) lq_plot_text(out, 20, below, "class=\"soft\"", plot->subtitle);
}

/* ======================================================================================
 *                                        Legend
 * ====================================================================================== */

const char *lq_plot_dashes(const lq_plot_line *series) {
    return series->secondary ? " stroke-dasharray=\"5 4\"" : "";
}

bool lq_plot_marked(const lq_plot_line *series, size_t i) {
    return !series->curve || (series->labels && series->labels[i]);
}

/* One shape a hue, so that colour is never the only difference. */
void lq_plot_marker(FILE *out, const lq_plot_line *series, double x, double y) {
    static const char *const shapes[LQ_PLOT_HUES] = {"M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z",
                                                     "M-4 -4h8v8h-8z", "M0 -5.2L5 3.8H-5z",
                                                     "M0 -5.6L5.6 0L0 5.6L-5.6 0z"};
    const char *paint = series->secondary ? "class=\"page\" stroke=\"currentColor\" stroke-width=\"1.6\""
                                          : "class=\"ring\" fill=\"currentColor\" stroke-width=\"1\"";
    fprintf(out, "<path %s d=\"%s\" transform=\"translate(%.1f %.1f)%s\"/>\n", paint, shapes[series->hue], x,
            y, series->scatter ? " scale(0.7)" : "");
}

void lq_plot_legend(FILE *out, const lq_plot *plot) {
    double x = LQ_PLOT_LEFT, y = LQ_PLOT_TOP - 24;
    for (size_t k = 0; k < plot->series_count; k++) {
        const lq_plot_line *series = &plot->series[k];
        const double size = 36 + lq_plot_text_width(series->name);
        if (k > 0 && x + size > LQ_PLOT_WIDTH - 8) x = LQ_PLOT_LEFT, y += 16;
        fprintf(out, "<g class=\"h%d\">", series->hue);
        if (!series->scatter)
            fprintf(out, "<path stroke=\"currentColor\" stroke-width=\"%d\"%s d=\"M%.1f %.1fh28\"/>\n",
                    series->under ? 7 : 2, lq_plot_dashes(series), x, y);
        if (!series->curve) lq_plot_marker(out, series, x + 14, y);
        fputs("</g>\n", out);
        lq_plot_text(out, x + 36, y + 4, "class=\"ink\"", series->name);
        x += size + 24;
    }
}
