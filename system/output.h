/* output.h - files that appear whole or not at all; every writer of the project goes through here. */
#ifndef LACQUER_SYSTEM_OUTPUT_H
#define LACQUER_SYSTEM_OUTPUT_H

#include <stdint.h>

#include "lacquer.h"

typedef struct lq_output lq_output;

/* Start a file that will become `path` at lq_output_commit, and not before: until then the bytes go to an
 * unnamed (or, where the file system has none, a temporary) file in the same folder. A target that exists
 * and is not a regular file (/dev/null, /dev/full, a pipe) is written directly. */
lq_status lq_output_open(lq_output **output, const char *path, lq_error *error);

/* Append bytes, or text; both are buffered. */
lq_status lq_output_write(lq_output *output, const void *bytes, size_t size, lq_error *error);
lq_status lq_output_print(lq_output *output, lq_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Write bytes at an offset, unbuffered; several threads may do so at once. One file is written either by
 * this call or by the two above. A pipe takes them only in order. */
lq_status lq_output_write_at(lq_output *output, const void *bytes, size_t size, uint64_t offset,
                             lq_error *error);

/* Publish the file under its name, replacing an older one, whose permissions it takes, and free `output`. On
 * an error nothing is left behind and the older file stands. */
lq_status lq_output_commit(lq_output *output, lq_error *error);

/* Wait until a file that was published is on the disk, before what it was made from is removed: a power cut
 * must not cost both. */
lq_status lq_output_settle(const char *path, lq_error *error);

/* A file without a name in the folder of `beside`, for reading and writing: it goes with the process. */
lq_status lq_output_scratch(int *file, const char *beside, lq_error *error);

/* Make the folder unless it is there; its parent must be. */
lq_status lq_output_folder(const char *path, lq_error *error);

/* All of that for a file whose bytes are at hand. */
lq_status lq_output_save(const char *path, const void *bytes, size_t size, lq_error *error);

/* Whether `path` is another user's in a sticky folder (/tmp), where only its owner may replace it. */
bool lq_output_is_protected(const char *path);

/* Forget the file and free `output` (NULL is fine): as if it had never been opened. */
void lq_output_abandon(lq_output *output);

#endif
