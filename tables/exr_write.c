/* exr_write.c - tables into EXR archives: scan lines of float32, ZIP, compressed on all cores.
 *
 * OpenEXRCore lays out the file; the chunks are packed here, for two reasons. Its compressor sets up and
 * tears down a zlib stream for every chunk, and a chunk of a 64-wide table is 4 KB: a 64 x 64^3 table takes
 * 1.4 s that way on two cores and 0.5 s with one stream a thread. And its encoder works under one lock.
 *
 * Rows are asked for group by group, so that no more of a table is in memory. The header has the checksum of
 * what follows it, and is put into its place last.
 */
#define _GNU_SOURCE /* memmem */
#include <limits.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "system/output.h"
#include "system/status.h"
#include "tables/exr_layout.h"
#include "tables/rows.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the floats are written as they lie in memory, which must be little-endian"
#endif

enum {
    /* The low mantissa bits of computed tables are noise: every level from 1 to 6 gives 67.2 MB for the
     * 64 x 64^3 table, where stored chunks are 67.4, in the same time. 4 is for constant and stepped tables.
     */
    ZIP_LEVEL = 4,
    CHUNK_ROWS = 16, /* of EXR_COMPRESSION_ZIP */
    /* Threads wait for their turn to write once a group. Turns of single 4 KB chunks, 16384 of them, took
     * 26 s where another program held one of the two cores. */
    GROUP_BYTES = 1 << 20,
    GROUP_MAX = 256,
    NOISE_LIMIT = 400,     /* see is_noise */
    NOISE_MIN_SIZE = 2048, /* fewer bytes say little about 256 values */
    DIGITS = 8,            /* of the checksum */
    SHORT_NAME_MAX = 31    /* longer attribute names set a flag that pre-2.0 readers refuse */
};

typedef struct writer {
    const lq_rows *rows;
    const lq_table *shape;
    const char *path;
    lq_output *output;
    exr_context_t context;
    int part;
    size_t width, height, row_bytes; /* a row holds one line of every channel */
    int order[LQ_MAX_CHANNELS];      /* table channel of each channel of the file */
    uint32_t sums[LQ_MAX_CHANNELS];  /* of the data written so far, by table channel */
    unsigned char *header;           /* until all chunks are there */
    size_t header_size;
    bool has_header;  /* it is complete */
    lq_status status; /* first failure; the rest of the work is skipped after it */
    int stopped;      /* likewise, for threads that are not at their turn to write */
    lq_error failure;
} writer;

/* ------------------------------------------------------------------ OpenEXR's side */

/* Without a handler the library prints. Asking it for its user data in here can deadlock, and what goes
 * wrong while writing is either our own I/O or memory: the result code says enough. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static bool out_of_memory(writer *w) {
    w->status = lq_fail(&w->failure, LQ_NO_MEMORY, "%s: no memory to write it", w->path);
    return false;
}

/* The header in memory, as it grows. */
static bool put_header(writer *w, const void *bytes, size_t size, size_t offset) {
    if (offset + size > w->header_size) {
        unsigned char *longer = realloc(w->header, offset + size);
        if (!longer) return out_of_memory(w);
        memset(longer + w->header_size, 0, offset + size - w->header_size);
        w->header = longer;
        w->header_size = offset + size;
    }
    memcpy(w->header + offset, bytes, size);
    return true;
}

static int64_t put_bytes(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                         uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    writer *w = user;
    const bool of_header = !w->has_header || offset + size <= w->header_size;
    if (of_header) return !w->status && put_header(w, bytes, size, offset) ? (int64_t)size : -1;
    if (!w->status) w->status = lq_output_write_at(w->output, bytes, size, offset, &w->failure);
    return w->status ? -1 : (int64_t)size;
}

/* True when `result` is success; else the first failure is kept. */
static bool check(writer *w, exr_result_t result) {
    if (result == EXR_ERR_SUCCESS) return true;
    if (w->status) return false; /* put_bytes or an earlier call knows better */
    w->status = result == EXR_ERR_OUT_OF_MEMORY ? LQ_NO_MEMORY : LQ_IO;
    lq_fail(&w->failure, w->status, "%s: OpenEXR cannot write it: %s", w->path,
            exr_get_default_error_message(result));
    return false;
}

/* ------------------------------------------------------------------ header */

/* Sets and frees `text`. */
static bool set_text(writer *w, const char *name, char *text) {
    if (!text) return out_of_memory(w);
    bool done = check(w, exr_attr_set_string(w->context, w->part, name, text));
    free(text);
    return done;
}

static bool set_facts(writer *w) {
    for (size_t i = 0; i < w->shape->fact_count; i++) {
        char name[LQ_EXR_FACT_SIZE];
        snprintf(name, sizeof name, "%s%s", LQ_EXR_FACT, w->shape->facts[i].key);
        if (!check(w, exr_attr_set_string(w->context, w->part, name, w->shape->facts[i].value))) return false;
    }
    return set_text(w, LQ_EXR_FACTS, lq_exr_facts_text(w->shape));
}

static bool set_attributes(writer *w) {
    return check(w, exr_attr_set_string(w->context, w->part, LQ_EXR_FORMAT, LQ_EXR_FORMAT_VERSION)) &&
           check(w, exr_attr_set_string(w->context, w->part, LQ_EXR_CHECKSUM, "00000000")) &&
           set_text(w, LQ_EXR_AXES, lq_exr_axes_text(w->shape)) &&
           set_text(w, LQ_EXR_CHANNELS, lq_exr_channels_text(w->shape)) && set_facts(w);
}

static bool needs_long_names(const lq_table *table) {
    for (size_t i = 0; i < table->fact_count; i++)
        if (strlen(LQ_EXR_FACT) + strlen(table->facts[i].key) > SHORT_NAME_MAX) return true;
    return false;
}

static bool add_channels(writer *w) {
    for (int c = 0; c < w->shape->channel_count; c++)
        if (!check(w, exr_add_channel(w->context, w->part, w->shape->channel_names[c], EXR_PIXEL_FLOAT,
                                      EXR_PERCEPTUALLY_LINEAR, 1, 1)))
            return false;
    return true;
}

/* OpenEXR sorts channels; ask it in which order. */
static bool find_order(writer *w) {
    const exr_attr_chlist_t *list;
    if (!check(w, exr_get_channels(w->context, w->part, &list))) return false;
    for (int i = 0; i < list->num_channels; i++)
        for (int c = 0; c < w->shape->channel_count; c++)
            if (strcmp(list->entries[i].name.str, w->shape->channel_names[c]) == 0) w->order[i] = c;
    return true;
}

static bool write_header(writer *w) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = w;
    setup.write_fn = put_bytes;
    return check(w, exr_start_write(&w->context, w->path, EXR_WRITE_FILE_DIRECTLY, &setup)) &&
           check(w, exr_set_longname_support(w->context, needs_long_names(w->shape))) &&
           check(w, exr_add_part(w->context, NULL, EXR_STORAGE_SCANLINE, &w->part)) &&
           check(w, exr_initialize_required_attr_simple(w->context, w->part, (int32_t)w->width,
                                                        (int32_t)w->height, EXR_COMPRESSION_ZIP)) &&
           add_channels(w) && set_attributes(w) && check(w, exr_write_header(w->context)) && find_order(w);
}

/* The checksum takes its place, and the header goes into the file. */
static void write_sealed_header(writer *w) {
    static const char before[] = LQ_EXR_CHECKSUM "\0string\0"; /* then four bytes, the length */
    uint32_t sum;
    char digits[DIGITS + 1];
    unsigned char *found = memmem(w->header, w->header_size, before, sizeof before - 1);
    const size_t skip = sizeof before - 1 + sizeof(uint32_t);
    if (!found || (size_t)(w->header + w->header_size - found) < skip + DIGITS) {
        check(w, EXR_ERR_FILE_BAD_HEADER);
        return;
    }
    w->status = lq_exr_checksum_join(w->shape, w->sums, &sum, &w->failure);
    snprintf(digits, sizeof digits, "%08x", (unsigned)sum);
    memcpy(found + skip, digits, DIGITS);
    if (!w->status) w->status = lq_output_write_at(w->output, w->header, w->header_size, 0, &w->failure);
}

/* ------------------------------------------------------------------ chunks */

/* What one thread needs to compress one group of chunks after the other. */
typedef struct packer {
    z_stream stream;
    bool ready;
    size_t chunk_bytes;
    unsigned char *raw, *split; /* one chunk */
    unsigned char *packed;      /* a group: chunk i starts at i * chunk_bytes and takes sizes[i] */
    size_t sizes[GROUP_MAX];
    float *lines[LQ_MAX_CHANNELS]; /* the rows of a group, by table channel, and their sums */
    uint32_t sums[LQ_MAX_CHANNELS];
    lq_status status; /* of the rows of a group */
    lq_error failure;
} packer;

static bool packer_start(packer *p, const writer *w, size_t chunk_bytes, size_t group) {
    const size_t channels = (size_t)w->shape->channel_count;
    memset(p, 0, sizeof *p);
    p->chunk_bytes = chunk_bytes;
    p->ready = deflateInit(&p->stream, ZIP_LEVEL) == Z_OK;
    p->raw = malloc(chunk_bytes);
    p->split = malloc(chunk_bytes);
    p->packed = malloc(group * chunk_bytes);
    p->lines[0] = malloc(group * chunk_bytes);
    for (size_t c = 1; c < channels && p->lines[0]; c++)
        p->lines[c] = p->lines[c - 1] + group * chunk_bytes / sizeof(float) / channels;
    return p->ready && p->raw && p->split && p->packed && p->lines[0];
}

static void packer_end(packer *p) {
    if (p->ready) deflateEnd(&p->stream);
    free(p->raw);
    free(p->split);
    free(p->packed);
    free(p->lines[0]);
}

/* `rows` rows of a group from its row `first` on, as a chunk of the file has them. */
static size_t gather_rows(const writer *w, const packer *p, size_t first, size_t rows, unsigned char *raw) {
    size_t line = w->width * sizeof(float);
    for (size_t row = first; row < first + rows; row++)
        for (int i = 0; i < w->shape->channel_count; i++, raw += line)
            memcpy(raw, p->lines[w->order[i]] + row * w->width, line);
    return rows * w->row_bytes;
}

/* The ZIP filter of OpenEXR: even bytes, then odd bytes, each as the difference from the one before. */
static void split_bytes(const unsigned char *raw, unsigned char *split, size_t size) {
    size_t half = size / 2; /* rows of floats: always even */
    for (size_t i = 0; i < half; i++) {
        split[i] = raw[2 * i];
        split[half + i] = raw[2 * i + 1];
    }
    for (size_t i = size - 1; i > 0; i--) split[i] = (unsigned char)(split[i] - split[i - 1] + 128);
}

/* Whether the bytes are as evenly spread as noise: chi^2 over the 256 values, whose mean is 255 with a
 * deviation of 23 for noise. Bytes that repeat r times raise it r-fold, so that what deflate would find
 * (pairs of equal rows: 510) is above NOISE_LIMIT. Worth asking because most chunks of a computed table are
 * noise to deflate, and asking takes a twentieth of its time: 0.5 s of the 64 x 64^3 table become 0.1 s. */
static bool is_noise(const unsigned char *bytes, size_t size) {
    size_t counts[256] = {0};
    double squares = 0;
    for (size_t i = 0; i < size; i++) counts[bytes[i]]++;
    for (int i = 0; i < 256; i++) squares += (double)counts[i] * (double)counts[i];
    return size >= NOISE_MIN_SIZE && 256 * squares / (double)size - (double)size < NOISE_LIMIT;
}

static bool deflate_chunk(packer *p, size_t size, unsigned char *packed) {
    deflateReset(&p->stream);
    p->stream.next_in = p->split;
    p->stream.avail_in = (uInt)size;
    p->stream.next_out = packed;
    p->stream.avail_out = (uInt)(size - 1);
    return deflate(&p->stream, Z_FINISH) == Z_STREAM_END;
}

/* A chunk that does not get shorter is stored as it is; readers tell by its size. */
static size_t pack_chunk(const writer *w, packer *p, size_t first, size_t rows, unsigned char *packed) {
    size_t size = gather_rows(w, p, first, rows, p->raw);
    split_bytes(p->raw, p->split, size);
    if (!is_noise(p->split, size) && deflate_chunk(p, size, packed)) return size - 1 - p->stream.avail_out;
    memcpy(packed, p->raw, size);
    return size;
}

/* `count` rows from row `first` of the table on. */
static void pack_group(const writer *w, packer *p, size_t first, size_t count) {
    const size_t bytes = count * w->width * sizeof(float);
    p->status = w->rows->read(w->rows->user, first, count, p->lines, &p->failure);
    for (int c = 0; c < w->shape->channel_count && !p->status; c++)
        p->sums[c] = (uint32_t)crc32_z(0, (const Bytef *)p->lines[c], bytes);
    for (size_t row = 0; row < count && !p->status; row += CHUNK_ROWS) {
        const size_t rows = count - row < CHUNK_ROWS ? count - row : CHUNK_ROWS, i = row / CHUNK_ROWS;
        p->sizes[i] = pack_chunk(w, p, row, rows, p->packed + i * p->chunk_bytes);
    }
}

static void write_group(writer *w, const packer *p, size_t first, size_t count) {
    const size_t bytes = count * w->width * sizeof(float);
    if (p->status && !w->status) {
        w->status = p->status;
        w->failure = p->failure;
    }
    for (int c = 0; c < w->shape->channel_count && !w->status; c++)
        w->sums[c] = (uint32_t)crc32_combine(w->sums[c], p->sums[c], (z_off_t)bytes);
    for (size_t row = 0; row < count && !w->status; row += CHUNK_ROWS)
        check(w, exr_write_scanline_chunk(w->context, w->part, (int)(first + row),
                                          p->packed + row / CHUNK_ROWS * p->chunk_bytes,
                                          p->sizes[row / CHUNK_ROWS]));
}

static size_t group_size(size_t chunk_bytes) {
    size_t group = GROUP_BYTES / chunk_bytes;
    return group < 1 ? 1 : group > GROUP_MAX ? GROUP_MAX : group;
}

/* Groups are compressed by any thread and written in order, so the bytes do not depend on the threads. */
static void write_chunks(writer *w) {
    size_t chunk_bytes = (w->height < CHUNK_ROWS ? w->height : CHUNK_ROWS) * w->row_bytes;
    size_t group = group_size(chunk_bytes), rows = group * CHUNK_ROWS;
#pragma omp parallel if (w->width * w->height >= LQ_EXR_PARALLEL)
    {
        packer p;
        bool ready = packer_start(&p, w, chunk_bytes, group);
#pragma omp for ordered schedule(dynamic, 1)
        for (size_t first = 0; first < w->height; first += rows) {
            size_t count = w->height - first < rows ? w->height - first : rows;
            int stopped;
#pragma omp atomic read
            stopped = w->stopped;
            if (ready && !stopped) pack_group(w, &p, first, count);
#pragma omp ordered
            {
                if (!ready && !w->status) out_of_memory(w);
                if (ready && !stopped) write_group(w, &p, first, count);
#pragma omp atomic write
                w->stopped = w->status != LQ_OK;
            }
        }
        packer_end(&p);
    }
}

/* ------------------------------------------------------------------ the whole */

/* Widths are at most 2^20 and channels 8, so a chunk of 16 rows is 2^29 bytes at most. */
static lq_status measure(writer *w, lq_error *error) {
    w->width = w->shape->axes[0].size;
    w->height = lq_table_entries(w->shape) / w->width;
    w->row_bytes = w->width * sizeof(float) * (size_t)w->shape->channel_count;
    if (w->height <= INT_MAX - CHUNK_ROWS) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT,
                   "%s: %zu rows (the product of all axes but the first); accepted in an EXR are at most %d",
                   w->path, w->height, INT_MAX - CHUNK_ROWS);
}

lq_status lq_rows_write_exr(const lq_rows *rows, const char *path, lq_error *error) {
    writer w = {.rows = rows, .shape = rows->shape, .path = path};
    lq_status status = measure(&w, error);
    if (status == LQ_OK) status = lq_output_open(&w.output, path, error);
    if (status) return status;
    w.has_header = write_header(&w);
    if (w.has_header) write_chunks(&w);
    if (w.context) check(&w, exr_finish(&w.context)); /* writes the table of chunk offsets */
    if (!w.status) write_sealed_header(&w);
    free(w.header);
    if (!w.status) return lq_output_commit(w.output, error);
    lq_output_abandon(w.output);
    return lq_fail(error, w.status, "%s", w.failure.text);
}

lq_status lq_table_write_exr(const lq_table *table, const char *path, lq_error *error) {
    const lq_rows rows = lq_table_rows(table);
    return lq_rows_write_exr(&rows, path, error);
}
