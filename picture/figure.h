/* figure.h - what a picture shows, before it is drawn: titled panels of maps, curves and areas. */
#ifndef LACQUER_PICTURE_FIGURE_H
#define LACQUER_PICTURE_FIGURE_H

#include "lacquer.h"

typedef enum lq_panel_form {
    LQ_PANEL_MAP,   /* values over two axes, in colours */
    LQ_PANEL_LINES, /* series over one axis */
    LQ_PANEL_AREAS  /* series over one axis, on top of each other */
} lq_panel_form;

enum { LQ_PANEL_SERIES = 64, LQ_FIGURE_PANELS = 512 };

/* Texts are valid UTF-8 without control characters, whatever they were made from. */
typedef struct lq_panel {
    lq_panel_form form;
    char *title, *caption; /* caption: "" where there is none */
    char *quantity;        /* what the values are: the label of their scale */
    lq_axis x, y;          /* y: of a map */
    size_t series_count;   /* of curves and areas; 1 in a map */
    char *series[LQ_PANEL_SERIES];
    float *values;    /* map: x fastest; otherwise series after series; NaN: none */
    double low, high; /* of the scale, low < high */
    bool is_signed;   /* colours that tell the sign, around the middle of the scale */
    bool ordered;     /* series that follow each other have colours that do */
    bool reference;   /* the last series is what the others are held against */
} lq_panel;

typedef struct lq_figure {
    char *title, *subtitle;
    size_t fact_count;
    lq_fact *facts; /* said on a page, not in an image */
    size_t panel_count;
    lq_panel *panels;
} lq_figure;

lq_status lq_figure_create(lq_figure **figure, const char *title, const char *subtitle, lq_error *error);
void lq_figure_free(lq_figure *figure);

/* A line of the page's list. */
lq_status lq_figure_tell(lq_figure *figure, const char *key, const char *value, lq_error *error);

/* What a panel is made of; everything is copied. `range`: the scale's ends; NULL: from the values, around 0
 * for a map of both signs, from 0 for areas. */
typedef struct lq_panel_parts {
    lq_panel_form form;
    const char *title, *caption, *quantity; /* caption may be NULL */
    const lq_axis *x, *y;                   /* y: of a map */
    size_t series_count;                    /* of curves and areas */
    const char *const *series;
    const float *values;
    const double *range;
    bool ordered, reference;
} lq_panel_parts;

lq_status lq_figure_add(lq_figure *figure, const lq_panel_parts *parts, lq_error *error);

/* One channel of a table over two of its axes (`y` -1: one, as a curve), through the point `at`. */
typedef struct lq_slice {
    const lq_table *table;
    int channel, x, y;
    const double *at;    /* one coordinate an axis; those of x and y are not read */
    const double *range; /* as above */
    const char *title;   /* NULL: the channel's name */
    const char *note;    /* NULL, or what its caption says besides */
} lq_slice;

lq_status lq_figure_add_slice(lq_figure *figure, const lq_slice *slice, lq_error *error);

/* The first two axes of several nodes; -1 where there are fewer. */
void lq_slice_axes(const lq_table *table, int *x, int *y);

/* The range of a scale: finite and not empty, whatever the values are. */
void lq_panel_range(lq_panel_form form, const float *values, size_t count, double range[2], bool *is_signed);

/* Rows of values: those of a map, or one a series. */
size_t lq_panel_rows(const lq_panel *panel);

#endif
