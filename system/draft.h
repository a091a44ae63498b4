/* draft.h - a text printed into memory, that is whole or not there. */
#ifndef LACQUER_SYSTEM_DRAFT_H
#define LACQUER_SYSTEM_DRAFT_H

#include <locale.h>
#include <stdbool.h>
#include <stdio.h>

/* Starts as {0}. */
typedef struct lq_draft {
    char *text; /* ends with a zero byte; NULL while there is nothing */
    size_t size, room;
    bool failed; /* there was no memory: some of it is lost */
    locale_t before;
} lq_draft;

/* A stream into the draft; until it is closed this thread prints numbers as C does. NULL: no memory. */
FILE *lq_draft_open(lq_draft *draft);
/* True: the text is whole; free it. False: there was no memory, and there is none. */
bool lq_draft_close(lq_draft *draft, FILE *stream);

/* For what prints into the stream of a draft: something is missing there. */
void lq_draft_fail(FILE *stream);

/* Append bytes. */
bool lq_draft_add(lq_draft *draft, const char *bytes, size_t size);

#endif
