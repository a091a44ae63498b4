/* published.h - what the readers and writers of published layouts share: bytes of strangers, taken with care.
 */
#ifndef LACQUER_TABLES_PUBLISHED_H
#define LACQUER_TABLES_PUBLISHED_H

#include <stdint.h>

#include "lacquer.h"

/* What a layout stores. */
typedef struct lq_stored {
    lq_layout layout;
    const char *kind;
    const char *ndf;     /* the only one it is published for; NULL: any */
    const char *masking; /* the only one it is meant for; NULL: any */
    int axis_count;
    const char *axes[4]; /* in the order of the file's header */
} lq_stored;

/* A whole file, read up to `at`. */
typedef struct lq_bytes {
    unsigned char *data;
    size_t size, at;
} lq_bytes;

/* The next bytes; false where there are not so many left. */
bool lq_published_take(lq_bytes *file, void *to, size_t size);

/* The message that the file is too short to be such a table. */
lq_status lq_published_foreign(const char *path, const lq_stored *what, lq_error *error);

/* Do `count` sizes and `extra` more entries make up what is left of the file, as float32? */
lq_status lq_published_check_length(const lq_bytes *file, const char *path, const lq_stored *what,
                                    const uint64_t *size, int count, uint64_t extra, lq_error *error);
lq_status lq_published_check_range(const char *path, const char *axis, float min, float max, lq_error *error);

/* An empty table over `axes`, if all went well so far; the axes are freed either way. */
lq_status lq_published_make_table(lq_table **table, lq_status status, const lq_stored *what, lq_axis *axes,
                                  lq_error *error);

/* Mitsuba's .dat, from the start of `file`. */
lq_status lq_mitsuba_read(lq_table **table, lq_bytes *file, const char *path, const lq_stored *what,
                          lq_error *error);

/* Can its outside block be over these axes? */
lq_status lq_mitsuba_check(const lq_stored *what, const lq_axis *axes, int axis_count, lq_error *error);

#endif
