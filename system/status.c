/* status.c - messages: one line, always terminated, never longer than an lq_error holds. */
#include "system/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "system/number.h"
#include "system/utf8.h"

static size_t tidy(char *text, size_t length) {
    lq_utf8_clean(text, length, "");
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
    int wanted = lq_vprint(text, sizeof text, format, arguments);
    va_end(arguments);
    size_t length = wanted < 0 ? 0 : (size_t)wanted;
    if (length >= sizeof text) length = lq_utf8_whole(text, sizeof text - 1);
    length = tidy(text, length);
    memcpy(error->text, text, length + 1);
    return status;
}

void lq_list_add(char *list, size_t size, const char *word) {
    const size_t used = strlen(list);
    snprintf(list + used, size - used, "%s%s", used > 0 ? ", " : "", word);
}
