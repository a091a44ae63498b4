/* npy.c - tables as NumPy .npy files, format 1.0: little-endian float32 in C order. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/output.h"
#include "system/status.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the floats are written as they lie in memory, which must be little-endian"
#endif

enum {
    PREAMBLE = 10,     /* magic, version, header length */
    HEADER_SIZE = 256, /* a multiple of 64, as the format asks, and room for five sizes */
    BATCH = 4096       /* entries interleaved at a time */
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

/* Channels become the fastest index. */
static lq_status write_interleaved(const lq_table *table, lq_output *output, lq_error *error) {
    float batch[BATCH * LQ_MAX_CHANNELS];
    size_t entries = lq_table_entries(table), channels = (size_t)table->channel_count;
    for (size_t first = 0; first < entries; first += BATCH) {
        size_t count = entries - first < BATCH ? entries - first : BATCH;
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < channels; c++) batch[i * channels + c] = table->channels[c][first + i];
        lq_status status = lq_output_write(output, batch, count * channels * sizeof(float), error);
        if (status) return status;
    }
    return LQ_OK;
}

lq_status lq_table_write_npy(const lq_table *table, const char *path, lq_error *error) {
    lq_output *output;
    lq_status status = lq_output_open(&output, path, error);
    if (status) return status;
    status = write_header(table, output, error);
    if (status == LQ_OK && table->channel_count == 1)
        status = lq_output_write(output, table->channels[0], lq_table_entries(table) * sizeof(float), error);
    else if (status == LQ_OK) status = write_interleaved(table, output, error);
    if (status == LQ_OK) return lq_output_commit(output, error);
    lq_output_abandon(output);
    return status;
}
