/* rows.h - a table that need not be there as a whole: rows as they are asked for.
 *
 * A row is all nodes of the first axis at one set of the others.
 */
#ifndef LACQUER_TABLES_ROWS_H
#define LACQUER_TABLES_ROWS_H

#include "lacquer.h"

/* Rows `first` to first + count - 1 into channels[c] of every channel; any thread may ask. */
typedef lq_status lq_rows_read(void *user, size_t first, size_t count, float *const *channels,
                               lq_error *error);

typedef struct lq_rows {
    const lq_table *shape; /* axes, names of channels and facts; data are not looked at */
    lq_rows_read *read;
    void *user;
} lq_rows;

/* Axes and channels without data, as lq_table_create makes them with: channels[c] is NULL. It may describe a
 * table larger than memory. */
lq_status lq_table_describe(lq_table **table, const lq_axis *axes, int axis_count,
                            const char *const *channel_names, int channel_count, lq_error *error);

/* Those of a table that is held. */
lq_rows lq_table_rows(const lq_table *table);

size_t lq_rows_count(const lq_rows *rows);

/* Into a table like the shape, with data. */
lq_status lq_rows_hold(const lq_rows *rows, int threads, lq_table *table, lq_error *error);

/* The same file as of a table that is held, in memory for a few rows a thread. */
lq_status lq_rows_write_exr(const lq_rows *rows, const char *path, lq_error *error);
lq_status lq_rows_write_npy(const lq_rows *rows, const char *path, lq_error *error);

#endif
