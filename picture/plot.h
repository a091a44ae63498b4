/* Charts as SVG: a few named series over linear or logarithmic axes, readable on light and dark pages. */
#ifndef LACQUER_PICTURE_PLOT_H
#define LACQUER_PICTURE_PLOT_H

#include "lacquer.h"

#include <stdio.h>

typedef struct lq_plot_axis {
    const char *label;
    bool logarithmic;
} lq_plot_axis;

enum { LQ_PLOT_HUES = 4, LQ_PLOT_MAX_SERIES = 8 };

typedef struct lq_plot_line {
    const char *name;
    size_t count;
    const double *x, *y;       /* a point that is not finite, or not positive on a log axis, is left out */
    const char *const *labels; /* a short text beside each point, or NULL; some may be NULL */
    int hue;                   /* 0 to LQ_PLOT_HUES - 1 */
    bool secondary;            /* dashed and hollow: the same thing measured another way */
    bool under;                /* what the others are held against: wide and faint, below them */
    bool curve;                /* known everywhere: only points with a label have a marker */
    bool scatter;              /* points that no line joins, small and faint */
} lq_plot_line;

/* An arrow at height y from x_from to x_to that states the distance between two curves. */
typedef struct lq_plot_span {
    double y, x_from, x_to;
    const char *label;
} lq_plot_span;

/* A line across the chart at height y: a limit. */
typedef struct lq_plot_rule {
    double y;
    const char *label;
} lq_plot_rule;

typedef struct lq_plot {
    const char *title, *subtitle; /* subtitle may be NULL */
    lq_plot_axis x, y;
    const lq_plot_line *series;
    size_t series_count;
    const lq_plot_span *span; /* or NULL */
    const lq_plot_rule *rule; /* or NULL */
} lq_plot;

/* "10⁻⁵" for -5, in at most 24 bytes; for labels. */
void lq_plot_power(char *text, int power);

/* A long title takes two lines, and smaller letters. A label goes where it meets no other and no marker;
 * where there is no such place it is left out.
 *
 * LQ_BAD_INPUT where there is nothing to draw. The first writes the <svg> element for a page, whose style it
 * needs (picture/document.h). The file has a style of its own, and appears whole or not at all. */
lq_status lq_plot_draw(const lq_plot *plot, FILE *out, lq_error *error);
lq_status lq_plot_write(const lq_plot *plot, const char *path, lq_error *error);

#endif
