/* page.h - a figure as a page: one file that needs no network, drawn by its own script. */
#ifndef LACQUER_PICTURE_PAGE_H
#define LACQUER_PICTURE_PAGE_H

#include "picture/figure.h"

/* The numbers of a page take at most this much of it. */
enum { LQ_PAGE_BYTES = 1700000 };

/* Beside the panels a page can hold a table, which its reader cuts along any two axes. A table too large for
 * the page keeps some nodes of every axis, the first and the last among them; the page says so. */
typedef struct lq_page {
    const lq_figure *figure;
    const lq_slice *start; /* of the table shown, and where the reader starts; NULL: panels alone */
    bool facts_first;      /* the list of facts is what the page is about */
} lq_page;

/* The file appears whole or not at all. */
lq_status lq_page_write(const lq_page *page, const char *path, lq_error *error);

/* Which nodes of the table a page keeps: `kept` of each axis, `budget` entries in all. Axes x and y keep up
 * to twice as many as the others. */
void lq_page_thin(const lq_table *table, int x, int y, size_t budget, size_t kept[LQ_MAX_AXES]);
/* Node `i` of the `kept` ones of an axis of `size`. */
size_t lq_page_node(size_t i, size_t kept, size_t size);

#endif
