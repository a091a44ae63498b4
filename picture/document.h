/* document.h - the frame of every page that the program writes: one head, one style, light and dark, for
 * windows of any width. */
#ifndef LACQUER_PICTURE_DOCUMENT_H
#define LACQUER_PICTURE_DOCUMENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Opens the page, with `title` (any text) as its first heading. */
void lq_document_begin(FILE *out, const char *title);
void lq_document_end(FILE *out);

/* What a reader asks first: is it good enough? A line that says so, `date` ("" where there is none) and
 * `words` after it, any text. */
void lq_document_verdict(FILE *out, bool good, const char *verdict, const char *date, const char *words);

/* A table of numbers with these heads of its columns, the first of words; it scrolls in a narrow window. Rows
 * are the caller's. */
void lq_document_table(FILE *out, const char *const *heads, size_t count);
void lq_document_table_end(FILE *out);

/* A heading that a table of contents may lead to. */
void lq_document_heading(FILE *out, int level, const char *id, const char *text);

#endif
