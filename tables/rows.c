/* rows.c - rows of tables that are held, and tables that rows make. */
#include "tables/rows.h"

#include <string.h>

#include "system/parallel.h"

/* Bytes of a channel that are asked for at once. */
enum { AT_ONCE = 1 << 20 };

static lq_status copy_rows(void *user, size_t first, size_t count, float *const *channels, lq_error *error) {
    (void)error;
    const lq_table *table = user;
    const size_t width = table->axes[0].size;
    for (int c = 0; c < table->channel_count; c++)
        memcpy(channels[c], table->channels[c] + first * width, count * width * sizeof(float));
    return LQ_OK;
}

lq_rows lq_table_rows(const lq_table *table) {
    return (lq_rows){table, copy_rows, (void *)table};
}

size_t lq_rows_count(const lq_rows *rows) {
    return lq_table_entries(rows->shape) / rows->shape->axes[0].size;
}

typedef struct holding {
    const lq_rows *rows;
    lq_table *table;
    size_t count, at_once;
} holding;

static lq_status hold_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    const holding *h = user;
    const size_t first = turn * h->at_once, left = h->count - first, width = h->table->axes[0].size;
    float *channels[LQ_MAX_CHANNELS];
    for (int c = 0; c < h->table->channel_count; c++) channels[c] = h->table->channels[c] + first * width;
    return h->rows->read(h->rows->user, first, left < h->at_once ? left : h->at_once, channels, error);
}

lq_status lq_rows_hold(const lq_rows *rows, int threads, lq_table *table, lq_error *error) {
    const size_t row = rows->shape->axes[0].size * sizeof(float), count = lq_rows_count(rows);
    holding h = {rows, table, count, AT_ONCE / row > 0 ? AT_ONCE / row : 1};
    return lq_parallel((count + h.at_once - 1) / h.at_once, threads, hold_turn, &h, NULL, error);
}
