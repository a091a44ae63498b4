/* status.c - messages: one line, always terminated, never longer than an lq_error holds. */
#include "system/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A multi-byte character cut in two by the end of the buffer would be an invalid string to JSON and
 * terminals: drop its first half. */
static size_t whole_characters(const char *text, size_t length) {
    size_t start = length;
    while (start > 0 && ((unsigned char)text[start - 1] & 0xC0) == 0x80) start--;
    if (start == 0) return length;
    unsigned char lead = (unsigned char)text[start - 1];
    size_t needed = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
    return length - (start - 1) < needed ? start - 1 : length;
}

static size_t tidy(char *text, size_t length) {
    for (size_t i = 0; i < length; i++)
        if ((unsigned char)text[i] < 0x20 || text[i] == 0x7F) text[i] = ' ';
    while (length > 0 && text[length - 1] == ' ') length--;
    if (length > 0 && text[length - 1] == '.') length--;
    text[length] = '\0';
    return length;
}

lq_status lq_fail(lq_error *error, lq_status status, const char *format, ...) {
    if (!error) return status;
    char text[LQ_MESSAGE_SIZE]; /* not error->text: it may be among the arguments */
    va_list arguments;
    va_start(arguments, format);
    int wanted = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    size_t length = wanted < 0 ? 0 : (size_t)wanted;
    if (length >= sizeof text) length = whole_characters(text, sizeof text - 1);
    length = tidy(text, length);
    memcpy(error->text, text, length + 1);
    return status;
}

void lq_list_add(char *list, size_t size, const char *word) {
    const size_t used = strlen(list);
    snprintf(list + used, size - used, "%s%s", used > 0 ? ", " : "", word);
}
