/* report_text.h - text of anybody's (file names, facts) inside a report. */
#ifndef LACQUER_VALIDATE_REPORT_TEXT_H
#define LACQUER_VALIDATE_REPORT_TEXT_H

#include <stddef.h>

enum { LQ_REPORT_CODE_SIZE = 12 };

/* The first character of `text` as XML and HTML write it, into `code`: valid UTF-8, markup escaped, U+FFFD
 * for a byte that is not UTF-8 and for what XML 1.0 (sec. 2.2) cannot hold. Returns how many bytes it took.
 */
size_t lq_report_character(const char *text, char code[LQ_REPORT_CODE_SIZE]);

#endif
