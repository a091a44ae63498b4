/* utf8.h - text that comes from a file, made fit for a terminal and for JSON. */
#ifndef LACQUER_SYSTEM_UTF8_H
#define LACQUER_SYSTEM_UTF8_H

#include <stddef.h>

/* Bytes of the UTF-8 character at the start of `text`, which has `length` bytes; 0 where there is none: no
 * overlong forms, surrogates, or numbers beyond U+10FFFF. */
size_t lq_utf8_character(const char *text, size_t length);

/* How many of `length` bytes end with a whole character: all but the first part of one cut in two. */
size_t lq_utf8_whole(const char *text, size_t length);

/* Nothing in `text` can steer a terminal afterwards: control characters (C0 without those in `kept`, DEL, C1)
 * become spaces, bytes that are not UTF-8 question marks. Its length stays. */
void lq_utf8_clean(char *text, size_t length, const char *kept);

#endif
