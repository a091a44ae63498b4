/* exr_read.c - EXR archives back into tables, believing nothing that the file says before it is checked. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/status.h"
#include "tables/exr_chunk.h"
#include "tables/exr_layout.h"
#include "tables/exr_stream.h"

#define ACCEPTED "accepted is a table written by lacquer"

typedef struct reader {
    lq_exr_stream stream; /* first: OpenEXR's callbacks get a reader */
    const char *path;
    exr_context_t context;
    char message[LQ_MESSAGE_SIZE]; /* the first one OpenEXR gave */
    lq_table *table;
    int rows_per_chunk;
    size_t width, height;
} reader;

/* ------------------------------------------------------------------ OpenEXR's side */

static void keep_message(exr_const_context_t context, exr_result_t code, const char *message) {
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    reader *r = user;
#pragma omp critical(lq_exr_message)
    if (!*r->message) snprintf(r->message, sizeof r->message, "%s", message);
}

static lq_status damaged(const reader *r, exr_result_t result, lq_error *error) {
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return lq_fail(error, LQ_NO_MEMORY, "%s: no memory to read it", r->path);
    const char *cause = exr_get_default_error_message(result);
    return lq_fail(error, LQ_FORMAT, "%s: truncated or damaged (%s); " ACCEPTED, r->path,
                   *r->message ? r->message : cause);
}

/* Refuse for a `cause` that is in error->text already or is a literal. */
static lq_status refuse(const reader *r, lq_status status, const char *cause, lq_error *error) {
    return lq_fail(error, status, "%s: %s; " ACCEPTED, r->path, cause);
}

/* ------------------------------------------------------------------ opening */

static lq_status open_file(reader *r, lq_error *error) {
    struct stat info;
    r->stream.file =
        open(r->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a pipe without a writer must not hang */
    if (r->stream.file < 0 || fstat(r->stream.file, &info) != 0)
        return lq_fail(error, LQ_IO, "%s: cannot open it: %s; accepted is a file that can be read", r->path,
                       strerror(errno));
    if (!S_ISREG(info.st_mode)) return lq_fail(error, LQ_IO, "%s: is not a regular file; " ACCEPTED, r->path);
    r->stream.size = (uint64_t)info.st_size;
    return LQ_OK;
}

/* Magic 76 2f 31 01, then version 2 and flags. Settled here so that OpenEXR's parsers of tiles, deep data
 * and parts never see a file that cannot be a table. */
static lq_status check_kind(const reader *r, lq_error *error) {
    unsigned char head[8];
    if (lq_exr_stream_read(NULL, (void *)(uintptr_t)r, head, sizeof head, 0, NULL) != sizeof head ||
        memcmp(head, "\x76\x2f\x31\x01", 4) != 0)
        return refuse(r, LQ_FORMAT, "is not an OpenEXR file", error);
    if (head[4] != 2) return refuse(r, LQ_FORMAT, "is not version 2 of OpenEXR", error);
    if (head[5] & 0x02) return refuse(r, LQ_FORMAT, "is a tiled EXR", error);
    if (head[5] & 0x08) return refuse(r, LQ_FORMAT, "is a deep EXR", error);
    if (head[5] & 0x10) return refuse(r, LQ_FORMAT, "is a multi-part EXR", error);
    if ((head[5] & ~0x04) || head[6] || head[7]) return refuse(r, LQ_FORMAT, "has unknown flags", error);
    return LQ_OK;
}

static lq_status start(reader *r, lq_error *error) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = keep_message;
    setup.user_data = r;
    setup.read_fn = lq_exr_stream_read;
    setup.size_fn = lq_exr_stream_size;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t result = exr_start_read(&r->context, r->path, &setup);
    return result == EXR_ERR_SUCCESS ? LQ_OK : damaged(r, result, error);
}

/* ------------------------------------------------------------------ header */

/* The text of an attribute, or NULL and a message. */
static const char *get_text(const reader *r, const char *name, lq_error *error) {
    const exr_attribute_t *attribute;
    if (exr_get_attribute_by_name(r->context, 0, name, &attribute) != EXR_ERR_SUCCESS) {
        lq_fail(error, LQ_FORMAT, "%s: has no attribute '%s'; " ACCEPTED, r->path, name);
        return NULL;
    }
    const exr_attr_string_t *text = attribute->type == EXR_ATTR_STRING ? attribute->string : NULL;
    if (!text || !text->str || text->length < 0 || memchr(text->str, '\0', (size_t)text->length)) {
        lq_fail(error, LQ_FORMAT, "%s: attribute '%s' is not text; " ACCEPTED, r->path, name);
        return NULL;
    }
    return text->str;
}

static lq_status check_version(const reader *r, lq_error *error) {
    const char *version = get_text(r, LQ_EXR_FORMAT, error);
    if (!version) return LQ_FORMAT;
    if (strcmp(version, LQ_EXR_FORMAT_VERSION) == 0) return LQ_OK;
    return lq_fail(error, LQ_FORMAT, "%s: layout version '%.20s' is not known; accepted is version %s",
                   r->path, version, LQ_EXR_FORMAT_VERSION);
}

/* Only what lacquer writes, and what lossless tools turn it into. */
static lq_status check_storage(const reader *r, lq_error *error) {
    exr_storage_t storage;
    exr_compression_t compression;
    exr_result_t result = exr_get_storage(r->context, 0, &storage);
    if (result == EXR_ERR_SUCCESS) result = exr_get_compression(r->context, 0, &compression);
    if (result != EXR_ERR_SUCCESS) return damaged(r, result, error);
    if (storage != EXR_STORAGE_SCANLINE) return refuse(r, LQ_FORMAT, "is not made of scan lines", error);
    if (compression == EXR_COMPRESSION_NONE || compression == EXR_COMPRESSION_RLE ||
        compression == EXR_COMPRESSION_ZIPS || compression == EXR_COMPRESSION_ZIP)
        return LQ_OK;
    return lq_fail(error, LQ_FORMAT, "%s: compression %d; accepted are none, RLE, ZIPS and ZIP", r->path,
                   (int)compression);
}

static bool is_listed(const exr_attr_chlist_t *list, const char *name) {
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        if (strcmp(entry->name.str, name) == 0)
            return entry->pixel_type == EXR_PIXEL_FLOAT && entry->x_sampling == 1 && entry->y_sampling == 1;
    }
    return false;
}

/* The channels of the file must be those that its attribute lists. */
static lq_status check_channels(const reader *r, char **names, size_t count, lq_error *error) {
    const exr_attr_chlist_t *list;
    exr_result_t result = exr_get_channels(r->context, 0, &list);
    if (result != EXR_ERR_SUCCESS) return damaged(r, result, error);
    bool same = (size_t)list->num_channels == count;
    for (size_t i = 0; i < count && same; i++) same = is_listed(list, names[i]);
    if (same) return LQ_OK;
    return refuse(r, LQ_FORMAT, "its channels are not the float channels its header lists", error);
}

static lq_status read_window(reader *r, lq_error *error) {
    exr_attr_box2i_t window;
    exr_result_t result = exr_get_data_window(r->context, 0, &window);
    if (result == EXR_ERR_SUCCESS) result = exr_get_scanlines_per_chunk(r->context, 0, &r->rows_per_chunk);
    if (result != EXR_ERR_SUCCESS) return damaged(r, result, error);
    const int64_t width = (int64_t)window.max.x + 1, rows = (int64_t)window.max.y + 1;
    if (window.min.x != 0 || window.min.y != 0 || width < 1 || rows < 1 || r->rows_per_chunk < 1)
        return lq_fail(error, LQ_FORMAT, "%s: %" PRId64 " x %" PRId64 " values are no table; " ACCEPTED,
                       r->path, width, rows);
    r->width = (size_t)width;
    r->height = (size_t)rows;
    return LQ_OK;
}

static lq_status check_shape(const reader *r, const lq_axis *axes, int axis_count, lq_error *error) {
    double height = 1; /* may be 2^60 */
    for (int i = 1; i < axis_count; i++) height *= (double)axes[i].size;
    if (r->width == axes[0].size && (double)r->height == height) return LQ_OK;
    return lq_fail(error, LQ_FORMAT, "%s: %zu x %zu values do not match the axes, %zu x %.0f; " ACCEPTED,
                   r->path, r->width, r->height, axes[0].size, height);
}

/* Before memory is asked for: could so few bytes hold that many values? */
static lq_status check_capacity(const reader *r, size_t channels, lq_error *error) {
    const double row_bytes = (double)r->width * (double)channels * sizeof(float);
    exr_compression_t compression;
    const exr_result_t result = exr_get_compression(r->context, 0, &compression);
    if (result != EXR_ERR_SUCCESS) return damaged(r, result, error);
    if (lq_exr_may_hold(r->stream.size, compression, (double)r->height, row_bytes, r->rows_per_chunk))
        return LQ_OK;
    return lq_fail(error, LQ_FORMAT,
                   "%s: truncated: %" PRIu64 " bytes cannot hold its %zu x %zu values; " ACCEPTED, r->path,
                   r->stream.size, r->width, r->height);
}

static lq_status make_table(reader *r, const lq_axis *axes, int axis_count, lq_error *error) {
    const char *text = get_text(r, LQ_EXR_CHANNELS, error);
    if (!text) return LQ_FORMAT;
    char **names;
    size_t count;
    lq_status status = lq_exr_parse_names(text, LQ_MAX_CHANNELS, &names, &count, error);
    if (status) return refuse(r, status, error ? error->text : "", error);
    status = check_channels(r, names, count, error);
    if (status == LQ_OK) status = check_shape(r, axes, axis_count, error);
    if (status == LQ_OK) status = check_capacity(r, count, error);
    if (status == LQ_OK) {
        status = lq_table_create(&r->table, axes, axis_count, (const char *const *)names, (int)count, error);
        if (status == LQ_BAD_INPUT) status = LQ_FORMAT;
        if (status) refuse(r, status, error ? error->text : "", error);
    }
    lq_exr_free_names(names, count);
    return status;
}

static lq_status read_axes(reader *r, lq_error *error) {
    const char *text = get_text(r, LQ_EXR_AXES, error);
    if (!text) return LQ_FORMAT;
    lq_axis axes[LQ_MAX_AXES];
    int count;
    lq_status status = read_window(r, error);
    if (status == LQ_OK) status = check_capacity(r, 1, error);
    if (status != LQ_OK) return status;
    enum { FEW = 4096 }; /* so many are refused by their product, which says more */
    const size_t entries = r->width * r->height;
    status = lq_exr_parse_axes(text, entries > FEW ? entries : FEW, axes, &count, error);
    if (status) return refuse(r, status, error ? error->text : "", error);
    if (count == 0) return refuse(r, LQ_FORMAT, "it lists no axis", error);
    status = make_table(r, axes, count, error);
    for (int i = 0; i < count; i++) lq_axis_free(&axes[i]);
    return status;
}

static lq_status read_fact(reader *r, const char *key, lq_error *error) {
    char name[LQ_EXR_FACT_SIZE];
    snprintf(name, sizeof name, "%s%s", LQ_EXR_FACT, key);
    const char *value = get_text(r, name, error);
    return value ? lq_table_set_fact(r->table, key, value, error) : LQ_FORMAT;
}

static lq_status read_facts(reader *r, lq_error *error) {
    const char *text = get_text(r, LQ_EXR_FACTS, error);
    if (!text) return LQ_FORMAT;
    char **keys;
    size_t count;
    lq_status status = lq_exr_parse_names(text, LQ_MAX_FACTS, &keys, &count, error);
    if (status) return refuse(r, status, error ? error->text : "", error);
    for (size_t i = 0; i < count && status == LQ_OK; i++) status = read_fact(r, keys[i], error);
    lq_exr_free_names(keys, count);
    return status;
}

/* ------------------------------------------------------------------ data */

static int channel_index(const lq_table *table, const char *name) {
    for (int c = 0; c < table->channel_count; c++)
        if (strcmp(table->channel_names[c], name) == 0) return c;
    return -1;
}

/* Every channel gets a place: OpenEXRCore 3.1.5 crashes on some skipped ones. */
static void aim(const reader *r, exr_decode_pipeline_t *decode, size_t row) {
    for (int i = 0; i < decode->channel_count; i++) {
        exr_coding_channel_info_t *channel = &decode->channels[i];
        float *data = r->table->channels[channel_index(r->table, channel->channel_name)];
        channel->decode_to_ptr = (uint8_t *)(data + row * r->width);
        channel->user_pixel_stride = sizeof(float);
        channel->user_line_stride = (int32_t)(r->width * sizeof(float));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
}

/* One chunk through a pipeline that its thread uses again and again. */
static exr_result_t read_chunk(const reader *r, exr_decode_pipeline_t *decode, bool *started, size_t row) {
    exr_chunk_info_t chunk;
    exr_result_t result = exr_read_scanline_chunk_info(r->context, 0, (int)row, &chunk);
    if (result == EXR_ERR_SUCCESS)
        result = lq_exr_check_chunk(&chunk, r->stream.size,
                                    r->width * (size_t)r->table->channel_count * sizeof(float));
    if (result != EXR_ERR_SUCCESS) return result;
    if (*started) result = exr_decoding_update(r->context, 0, &chunk, decode);
    else result = exr_decoding_initialize(r->context, 0, &chunk, decode);
    if (result != EXR_ERR_SUCCESS) return result;
    aim(r, decode, row);
    if (!*started) result = exr_decoding_choose_default_routines(r->context, 0, decode);
    *started = true;
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(r->context, 0, decode) : result;
}

static lq_status read_data(reader *r, lq_error *error) {
    size_t rows = (size_t)r->rows_per_chunk;
    int failed = EXR_ERR_SUCCESS;
#pragma omp parallel if (r->width * r->height >= LQ_EXR_PARALLEL)
    {
        exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
        bool started = false;
#pragma omp for schedule(static)
        for (size_t row = 0; row < r->height; row += rows) {
            int stop;
#pragma omp atomic read
            stop = failed;
            if (stop != EXR_ERR_SUCCESS) continue;
            exr_result_t result = read_chunk(r, &decode, &started, row);
            if (result != EXR_ERR_SUCCESS) {
#pragma omp atomic write
                failed = result;
            }
        }
        if (started) exr_decoding_destroy(r->context, &decode);
    }
    return failed == EXR_ERR_SUCCESS ? LQ_OK : damaged(r, failed, error);
}

/* Chunks that did not compress are stored without a check of their own. */
static lq_status check_sum(const reader *r, lq_error *error) {
    const char *stored = get_text(r, LQ_EXR_CHECKSUM, error);
    if (!stored) return LQ_FORMAT;
    uint32_t sum;
    char digits[16];
    lq_status status = lq_exr_checksum(r->table, &sum, error);
    if (status) return refuse(r, status, error ? error->text : "", error);
    snprintf(digits, sizeof digits, "%08x", (unsigned)sum);
    if (strcmp(stored, digits) == 0) return LQ_OK;
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    return LQ_OK; /* what reads a table is to be reached by changed ones, too */
#endif
    return refuse(r, LQ_FORMAT, "damaged or edited: the checksum does not match", error);
}

/* ------------------------------------------------------------------ the whole */

static lq_status read_all(reader *r, lq_error *error) {
    lq_status status = open_file(r, error);
    if (status == LQ_OK) status = check_kind(r, error);
    if (status == LQ_OK) status = start(r, error);
    if (status == LQ_OK) status = check_version(r, error);
    if (status == LQ_OK) status = check_storage(r, error);
    if (status == LQ_OK) status = read_axes(r, error);
    if (status == LQ_OK) status = read_facts(r, error);
    if (status == LQ_OK) status = read_data(r, error);
    if (status == LQ_OK) status = check_sum(r, error);
    return status;
}

lq_status lq_table_read_exr(lq_table **table, const char *path, lq_error *error) {
    reader r = {.path = path, .stream = {.file = -1}};
    lq_status status = read_all(&r, error);
    if (r.context) exr_finish(&r.context);
    if (r.stream.file >= 0) close(r.stream.file);
    if (status) lq_table_free(r.table);
    *table = status ? NULL : r.table;
    return status;
}
