/* page_parts.h - what the files that write pages share: page.js and page.css, and JSON for them. */
#ifndef LACQUER_PICTURE_PAGE_PARTS_H
#define LACQUER_PICTURE_PAGE_PARTS_H

#include "picture/page.h"

#include <stdio.h>

extern const char lq_page_script[], lq_page_style[];

/* What stands where there are no scripts. */
void lq_page_unscripted(FILE *out);

/* A string; its '<' cannot end the element that it stands in. `text` is as lq_text_clean gives it. */
void lq_page_string(FILE *out, const char *text);
/* Float32, little end first, as a string of base64. */
void lq_page_values(FILE *out, const float *values, size_t count);

/* {"colours", "panels", "table"}: what page.js reads. */
void lq_page_colours(FILE *out);
/* The panels that fit into `bytes`; how many they are. */
size_t lq_page_panels(FILE *out, const lq_figure *figure, size_t bytes);
/* Of a table that kept so many nodes. */
lq_status lq_page_table(FILE *out, const lq_slice *start, const size_t *kept, lq_error *error);

#endif
