/* precompute.h - what the files of `lacquer precompute` share. */
#ifndef LACQUER_PROGRAM_PRECOMPUTE_PRECOMPUTE_H
#define LACQUER_PROGRAM_PRECOMPUTE_PRECOMPUTE_H

#include "lacquer.h"
#include "program/options.h"
#include "program/settings.h"
#include "tables/rows.h"

/* The first two follow from the ending of a file, the published layouts do not. */
enum {
    FORMAT_EXR,
    FORMAT_NPY,
    FORMAT_BELCOUR,
    FORMAT_TM,
    FORMAT_MITSUBA,
    FORMATS,
    FORMAT_ENDINGS = FORMAT_BELCOUR
};

typedef struct table_request {
    const char *table;
    cli_texts axes; /* name=spec */
    cli_settings settings;
    size_t threads;
    int format; /* -1: from the ending of the output file */
    const char *output;
    const char *stack; /* of table stack, like the two below */
    int interfaces, from;
    bool trusted, resume;
    char *command; /* what determines the table, as a command line; owned */
} table_request;

/* Write a table that was solved with this status, and say so; an exit code. `shape` is that of the rows, or
 * for a published format holds them; `found`: parts from a run before. *written: the file is there. */
int precompute_finish(const table_request *request, const lq_rows *rows, lq_table *shape, size_t found,
                      lq_status status, const lq_error *error, double seconds, bool *written);

/* `lacquer precompute stack`. */
int precompute_stack(const table_request *request);

#endif
