/* terminal.c - stdout through a filter: one place, so that no verb can forget it. */
#include "program/terminal.h"

#include "system/utf8.h"

#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

enum { CHUNK = 4096, MOST_CUT = 3 /* bytes of a character cut in two */ };

/* The first part of a character whose rest has not come yet. */
typedef struct cut {
    char bytes[MOST_CUT];
    size_t count;
} cut;

static bool put(const char *text, size_t length) {
    while (length > 0) {
        const ssize_t wrote = write(STDOUT_FILENO, text, length);
        if (wrote <= 0) return false;
        text += wrote;
        length -= (size_t)wrote;
    }
    return true;
}

static bool put_clean(cut *rest, const char *text, size_t length) {
    char line[MOST_CUT + CHUNK];
    memcpy(line, rest->bytes, rest->count);
    memcpy(line + rest->count, text, length);
    length += rest->count;
    const size_t whole = lq_utf8_whole(line, length);
    rest->count = length - whole;
    memcpy(rest->bytes, line + whole, rest->count);
    lq_utf8_clean(line, whole, "\n\t");
    return put(line, whole);
}

/* 0 tells stdio of an error. */
static ssize_t clean_write(void *cookie, const char *text, size_t length) {
    for (size_t at = 0; at < length;) {
        const size_t part = length - at < CHUNK ? length - at : CHUNK;
        if (!put_clean(cookie, text + at, part)) return 0;
        at += part;
    }
    return (ssize_t)length;
}

bool cli_guard_stdout(void) {
    static cut rest;
    FILE *guarded = fopencookie(&rest, "w", (cookie_io_functions_t){.write = clean_write});
    if (!guarded) return false;
    setvbuf(guarded, NULL, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF, BUFSIZ);
    stdout = guarded;
    return true;
}
