/* npy.c - tables as NumPy .npy files, format 1.0: little-endian float32 in C order. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/output.h"
#include "system/parallel.h"
#include "system/status.h"
#include "tables/rows.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the floats are written as they lie in memory, which must be little-endian"
#endif

enum {
    PREAMBLE = 10,     /* magic, version, header length */
    HEADER_SIZE = 256, /* a multiple of 64, as the format asks, and room for five sizes */
    BATCH = 1 << 18    /* entries of a channel that a thread reads at a time */
};

/* "(last, ..., first)" or, with several channels, "(last, ..., first, channels)". */
static void describe_shape(const lq_table *table, char *text, size_t size) {
    size_t used = 0;
    for (int i = table->axis_count - 1; i >= 0; i--)
        used += (size_t)snprintf(text + used, size - used, "%zu, ", table->axes[i].size);
    if (table->channel_count > 1) snprintf(text + used, size - used, "%d, ", table->channel_count);
}

static lq_status write_header(const lq_table *table, lq_output *output, lq_error *error) {
    char shape[128], header[HEADER_SIZE + 1];
    describe_shape(table, shape, sizeof shape);
    memcpy(header, "\x93NUMPY\x01\x00", 8);
    header[8] = (char)((HEADER_SIZE - PREAMBLE) & 0xFF);
    header[9] = (char)((HEADER_SIZE - PREAMBLE) >> 8);
    int used = snprintf(header + PREAMBLE, sizeof header - PREAMBLE,
                        "{'descr': '<f4', 'fortran_order': False, 'shape': (%s), }", shape);
    size_t end = PREAMBLE + (size_t)used;
    memset(header + end, ' ', HEADER_SIZE - 1 - end);
    header[HEADER_SIZE - 1] = '\n';
    return lq_output_write(output, header, HEADER_SIZE, error);
}

/* Batches are read by any thread, as many as there are threads, and written in order: it may be a pipe. */
typedef struct batches {
    const lq_rows *rows;
    size_t count, at_once, first; /* rows; of a batch; of the first batch at work */
    size_t width, channels;
    float **batch; /* of each: channel after channel, then interleaved */
} batches;

static size_t rows_of(const batches *b, size_t batch) {
    const size_t first = b->first + batch * b->at_once, left = b->count - first;
    return left < b->at_once ? left : b->at_once;
}

/* Channels become the fastest index. */
static lq_status read_batch(void *user, size_t batch, int thread, lq_error *error) {
    (void)thread;
    const batches *b = user;
    const size_t entries = rows_of(b, batch) * b->width;
    float *channels[LQ_MAX_CHANNELS], *to = b->batch[batch];
    float *apart = b->channels > 1 ? to + entries * b->channels : to;
    for (size_t c = 0; c < b->channels; c++) channels[c] = apart + c * entries;
    const lq_status status =
        b->rows->read(b->rows->user, b->first + batch * b->at_once, rows_of(b, batch), channels, error);
    for (size_t i = 0; b->channels > 1 && i < entries; i++)
        for (size_t c = 0; c < b->channels; c++) to[i * b->channels + c] = channels[c][i];
    return status;
}

static lq_status write_batches(batches *b, size_t together, lq_output *output, lq_error *error) {
    lq_status status = LQ_OK;
    for (b->first = 0; status == LQ_OK && b->first < b->count; b->first += together * b->at_once) {
        const size_t left = (b->count - b->first + b->at_once - 1) / b->at_once;
        const size_t now = left < together ? left : together;
        status = lq_parallel(now, 0, read_batch, b, NULL, error);
        for (size_t i = 0; status == LQ_OK && i < now; i++)
            status = lq_output_write(output, b->batch[i],
                                     rows_of(b, i) * b->width * b->channels * sizeof(float), error);
    }
    return status;
}

static lq_status write_rows(const lq_rows *rows, lq_output *output, lq_error *error) {
    const size_t width = rows->shape->axes[0].size, channels = (size_t)rows->shape->channel_count;
    batches b = {.rows = rows,
                 .count = lq_rows_count(rows),
                 .at_once = width < BATCH ? BATCH / width : 1,
                 .width = width,
                 .channels = channels};
    const size_t most = (b.count + b.at_once - 1) / b.at_once;
    const size_t together = (size_t)lq_parallel_threads(most, 0);
    b.batch = calloc(together, sizeof *b.batch);
    bool ready = b.batch;
    for (size_t i = 0; ready && i < together; i++)
        ready = (b.batch[i] = malloc((channels > 1 ? 2 : 1) * b.at_once * width * channels * sizeof(float)));
    const lq_status status = ready ? write_batches(&b, together, output, error)
                                   : lq_fail(error, LQ_NO_MEMORY, "no memory to write");
    for (size_t i = 0; b.batch && i < together; i++) free(b.batch[i]);
    free((void *)b.batch);
    return status;
}

lq_status lq_rows_write_npy(const lq_rows *rows, const char *path, lq_error *error) {
    lq_output *output;
    lq_status status = lq_output_open(&output, path, error);
    if (status) return status;
    status = write_header(rows->shape, output, error);
    if (status == LQ_OK) status = write_rows(rows, output, error);
    if (status == LQ_OK) return lq_output_commit(output, error);
    lq_output_abandon(output);
    return status;
}

lq_status lq_table_write_npy(const lq_table *table, const char *path, lq_error *error) {
    const lq_rows rows = lq_table_rows(table);
    return lq_rows_write_npy(&rows, path, error);
}
