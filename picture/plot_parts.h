/* plot_parts.h - what the files of the plotter share: the page, scales, text, markers. */
#ifndef LACQUER_PICTURE_PLOT_PARTS_H
#define LACQUER_PICTURE_PLOT_PARTS_H

#include "picture/plot.h"

/* The page in px. The left margin holds tick labels, the top margin title, subtitle and legend. */
enum {
    LQ_PLOT_WIDTH = 800,
    LQ_PLOT_HEIGHT = 500,
    LQ_PLOT_LEFT = 72,
    LQ_PLOT_RIGHT = 28,
    LQ_PLOT_TOP = 104,
    LQ_PLOT_BOTTOM = 62
};

/* Hues that keep apart for colour-blind readers; both columns have contrast 3:1 or more on their page. */
extern const char lq_plot_style[];

typedef struct lq_plot_scale {
    bool logarithmic;
    double low, high, step; /* of the value or of its decimal logarithm; step between labels */
    double start, length;   /* px; length is negative where values grow upwards */
} lq_plot_scale;

/* Whether a point can be drawn, and where a value lies. */
bool lq_plot_has(const lq_plot *plot, const lq_plot_line *series, size_t i);
double lq_plot_at(const lq_plot_scale *scale, double value);

void lq_plot_text(FILE *out, double x, double y, const char *attributes, const char *text);
/* A rough width in px of a text of 12 px: characters, not bytes, at the mean width of a sans serif. */
double lq_plot_text_width(const char *text);

/* `style`: of a file of its own; NULL: the page has it. */
void lq_plot_head(FILE *out, const lq_plot *plot, const char *style);
void lq_plot_legend(FILE *out, const lq_plot *plot);
bool lq_plot_marked(const lq_plot_line *series, size_t i);
void lq_plot_marker(FILE *out, const lq_plot_line *series, double x, double y);
const char *lq_plot_dashes(const lq_plot_line *series);

void lq_plot_labels(FILE *out, const lq_plot *plot, const lq_plot_scale *x, const lq_plot_scale *y);

#endif
