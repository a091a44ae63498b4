/* stream.h - an output as a stdio stream, for text that is put together with fprintf. */
#ifndef LACQUER_SYSTEM_STREAM_H
#define LACQUER_SYSTEM_STREAM_H

#include <locale.h>
#include <stdio.h>

#include "system/output.h"

typedef struct lq_stream {
    FILE *out; /* what is written to it goes to the output; nobody else closes it */
    lq_output *output;
    lq_status status; /* of the first write that failed */
    lq_error *error;
    locale_t before;
} lq_stream;

/* `stream` must stay where it is until it is closed; so long this thread prints numbers as C does. */
lq_status lq_stream_open(lq_stream *stream, const char *path, lq_error *error);

/* Publish the file if all went well, `so_far` included; otherwise forget it, as lq_output_abandon does. */
lq_status lq_stream_close(lq_stream *stream, lq_status so_far, lq_error *error);

#endif
