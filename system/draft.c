/* draft.c - a stream of our own: open_memstream of glibc 2.36 drops what it has no memory for and says so
 * only to the call that printed it, neither by ferror nor by fclose. */
#define _GNU_SOURCE /* fopencookie */
#include "system/draft.h"

#include <stdlib.h>
#include <string.h>

#include "system/number.h"

static bool make_room(lq_draft *draft, size_t size) {
    if (draft->room - draft->size > size) return true;
    const size_t room = 2 * (draft->size + size) + 256;
    char *longer = realloc(draft->text, room);
    if (!longer) return false;
    draft->text = longer;
    draft->room = room;
    return true;
}

bool lq_draft_add(lq_draft *draft, const char *bytes, size_t size) {
    draft->failed = draft->failed || memchr(bytes, 0, size) || !make_room(draft, size);
    if (draft->failed) return false;
    memcpy(draft->text + draft->size, bytes, size);
    draft->size += size;
    draft->text[draft->size] = '\0';
    return true;
}

static ssize_t take(void *draft, const char *bytes, size_t size) {
    return lq_draft_add(draft, bytes, size) ? (ssize_t)size : 0;
}

FILE *lq_draft_open(lq_draft *draft) {
    FILE *stream = fopencookie(draft, "w", (cookie_io_functions_t){.write = take});
    if (stream) draft->before = lq_locale_c();
    return stream;
}

/* A byte that no text has. */
void lq_draft_fail(FILE *stream) {
    fputc('\0', stream);
}

bool lq_draft_close(lq_draft *draft, FILE *stream) {
    const bool printed = !ferror(stream);
    lq_locale_back(draft->before);
    if (fclose(stream) == 0 && printed && lq_draft_add(draft, "", 0)) return true;
    free(draft->text);
    *draft = (lq_draft){.text = NULL};
    return false;
}
