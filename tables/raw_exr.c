/* raw_exr.c - scan-line EXR images of anybody's, one part, half or float, as bare numbers. */
#include <openexr.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "system/input.h"
#include "system/status.h"
#include "tables/exr_chunk.h"
#include "tables/exr_stream.h"
#include "tables/raw.h"

enum { MOST_CHANNELS = 64 };
#define MOST_PIXELS ((uint64_t)1 << 32)

typedef struct image {
    lq_exr_stream stream; /* first: OpenEXR's callbacks get an image */
    const char *path;
    uint64_t row_bytes;
    exr_context_t context;
    size_t width, height;
    int left, top;
    int channels;  /* in the file */
    float *planes; /* channel by channel, in the order of the file */
    const char *names[MOST_CHANNELS];
} image;

static void hush(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static lq_status broken(const image *im, exr_result_t result, lq_error *error) {
    const lq_status status = result == EXR_ERR_OUT_OF_MEMORY ? LQ_NO_MEMORY : LQ_FORMAT;
    return lq_fail(error, status, "%s: cannot be read as EXR: %s", im->path,
                   exr_get_default_error_message(result));
}

static lq_status read_shape(image *im, lq_error *error) {
    exr_attr_box2i_t window;
    exr_storage_t storage;
    const exr_attr_chlist_t *list;
    exr_compression_t compression;
    int rows_per_chunk = 1;
    exr_result_t result = exr_get_data_window(im->context, 0, &window);
    if (result == EXR_ERR_SUCCESS) result = exr_get_storage(im->context, 0, &storage);
    if (result == EXR_ERR_SUCCESS) result = exr_get_channels(im->context, 0, &list);
    if (result == EXR_ERR_SUCCESS) result = exr_get_compression(im->context, 0, &compression);
    if (result == EXR_ERR_SUCCESS) result = exr_get_scanlines_per_chunk(im->context, 0, &rows_per_chunk);
    if (result != EXR_ERR_SUCCESS) return broken(im, result, error);
    if (storage != EXR_STORAGE_SCANLINE || list->num_channels > MOST_CHANNELS)
        return lq_fail(error, LQ_FORMAT, "%s: accepted are EXR files of scan lines and up to %d channels",
                       im->path, MOST_CHANNELS);
    im->left = window.min.x;
    im->top = window.min.y;
    im->width = (size_t)((int64_t)window.max.x - window.min.x + 1);
    im->height = (size_t)((int64_t)window.max.y - window.min.y + 1);
    im->channels = list->num_channels;
    for (int c = 0; c < list->num_channels; c++) {
        im->names[c] = list->entries[c].name.str;
        if (list->entries[c].x_sampling != 1 || list->entries[c].y_sampling != 1 ||
            list->entries[c].pixel_type == EXR_PIXEL_UINT)
            return lq_fail(error, LQ_FORMAT, "%s: channel %.40s is subsampled or of whole numbers", im->path,
                           im->names[c]);
        im->row_bytes += im->width * (list->entries[c].pixel_type == EXR_PIXEL_HALF ? 2 : 4);
    }
    const uint64_t pixels = (uint64_t)im->width * im->height;
    if (im->width < 1 || im->height < 1 || pixels * (uint64_t)im->channels > MOST_PIXELS)
        return lq_fail(error, LQ_FORMAT, "%s: %zu x %zu pixels cannot be a table", im->path, im->width,
                       im->height);
    if (!lq_exr_may_hold(im->stream.size, compression, (double)im->height, (double)im->row_bytes,
                         rows_per_chunk))
        return lq_fail(error, LQ_FORMAT, "%s: truncated or damaged: %zu bytes cannot hold %zu x %zu pixels",
                       im->path, (size_t)im->stream.size, im->width, im->height);
    im->planes = calloc(pixels * (size_t)im->channels, sizeof *im->planes);
    return im->planes ? LQ_OK
                      : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu x %zu pixels", im->width, im->height);
}

static int index_of(const image *im, const char *name) {
    for (int c = 0; c < im->channels; c++)
        if (strcmp(im->names[c], name) == 0) return c;
    return -1;
}

/* OpenEXRCore 3.1.5 crashes on some skipped channels: every one is decoded. */
static exr_result_t read_rows(const image *im, exr_decode_pipeline_t *decode, bool *started, int row) {
    exr_chunk_info_t chunk;
    exr_result_t result = exr_read_scanline_chunk_info(im->context, 0, row, &chunk);
    if (result == EXR_ERR_SUCCESS) result = lq_exr_check_chunk(&chunk, im->stream.size, im->row_bytes);
    if (result != EXR_ERR_SUCCESS) return result;
    if (*started) result = exr_decoding_update(im->context, 0, &chunk, decode);
    else result = exr_decoding_initialize(im->context, 0, &chunk, decode);
    if (result != EXR_ERR_SUCCESS) return result;
    for (int i = 0; i < decode->channel_count; i++) {
        exr_coding_channel_info_t *channel = &decode->channels[i];
        const size_t plane = (size_t)index_of(im, channel->channel_name) * im->height;
        channel->decode_to_ptr = (uint8_t *)(im->planes + (plane + (size_t)(row - im->top)) * im->width);
        channel->user_pixel_stride = sizeof(float);
        channel->user_line_stride = (int32_t)(im->width * sizeof(float));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    if (!*started) result = exr_decoding_choose_default_routines(im->context, 0, decode);
    *started = true;
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(im->context, 0, decode) : result;
}

static lq_status read_planes(image *im, lq_error *error) {
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    bool started = false;
    int rows = 1;
    exr_result_t result = exr_get_scanlines_per_chunk(im->context, 0, &rows);
    for (size_t y = 0; result == EXR_ERR_SUCCESS && y < im->height; y += (size_t)rows)
        result = read_rows(im, &decode, &started, im->top + (int)y);
    if (started) exr_decoding_destroy(im->context, &decode);
    return result == EXR_ERR_SUCCESS ? LQ_OK : broken(im, result, error);
}

/* The planes asked for, beside each other. */
static lq_status interleave(const image *im, const char *const *channels, int count, lq_raw *raw,
                            lq_error *error) {
    const size_t pixels = im->width * im->height;
    if (!channels && im->channels != 1)
        return lq_fail(error, LQ_BAD_INPUT, "%s has %d channels; say which under \"exr_channels\"", im->path,
                       im->channels);
    raw->count = pixels * (size_t)count;
    raw->values = malloc(raw->count * sizeof *raw->values);
    if (!raw->values) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", raw->count);
    for (int k = 0; k < count; k++) {
        const int c = channels ? index_of(im, channels[k]) : 0;
        if (c < 0) return lq_fail(error, LQ_BAD_INPUT, "%s has no channel %.40s", im->path, channels[k]);
        for (size_t i = 0; i < pixels; i++)
            raw->values[i * (size_t)count + (size_t)k] = im->planes[(size_t)c * pixels + i];
    }
    return LQ_OK;
}

static lq_status start(image *im, lq_error *error) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = hush;
    setup.user_data = im;
    setup.read_fn = lq_exr_stream_read;
    setup.size_fn = lq_exr_stream_size;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    const exr_result_t result = exr_start_read(&im->context, im->path, &setup);
    return result == EXR_ERR_SUCCESS ? LQ_OK : broken(im, result, error);
}

lq_status lq_raw_read_exr(lq_raw *raw, const char *path, const char *const *channels, int channel_count,
                          lq_error *error) {
    image im = {.path = path};
    FILE *in; /* a pipe or a device is refused here: OpenEXR would wait for it */
    struct stat there;
    lq_status status = lq_input_open(&in, path, SIZE_MAX / 2, error);
    if (status != LQ_OK) return status;
    im.stream.file = fileno(in);
    if (fstat(im.stream.file, &there) == 0) im.stream.size = (uint64_t)there.st_size;
    status = start(&im, error);
    if (status == LQ_OK) status = read_shape(&im, error);
    if (status == LQ_OK) status = read_planes(&im, error);
    if (status == LQ_OK) status = interleave(&im, channels, channels ? channel_count : 1, raw, error);
    free(im.planes);
    exr_finish(&im.context);
    fclose(in);
    return status;
}
