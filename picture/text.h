/* text.h - text of anybody's (file names, facts) inside a picture, a page or a report. */
#ifndef LACQUER_PICTURE_TEXT_H
#define LACQUER_PICTURE_TEXT_H

#include <stddef.h>
#include <stdio.h>

enum { LQ_TEXT_CODE_SIZE = 12 };

/* The first character of `text` as XML and HTML write it, into `code`: valid UTF-8, markup escaped, U+FFFD
 * for a byte that is not UTF-8 and for what XML 1.0 (sec. 2.2) cannot hold. Returns how many bytes it took.
 */
size_t lq_text_character(const char *text, char code[LQ_TEXT_CODE_SIZE]);

/* A copy in which every such byte or control character is U+FFFD, and nothing is escaped; NULL: no memory. */
char *lq_text_clean(const char *text);

/* `text` as HTML and XML write it. */
void lq_text_put(FILE *out, const char *text);

#endif
