/* image_read.c - the texels of an image back from any of its containers. */
#include "pack/image_read.h"

#include "system/input.h"
#include "system/status.h"
#include "tables/half.h"
#include "tables/raw.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

enum { RGBA = 4 };

static lq_status other(const char *path, const char *what, lq_error *error) {
    return lq_fail(error, LQ_FORMAT, "%s: %s", path, what);
}

static uint32_t u32(const char *bytes) {
    uint32_t value;
    memcpy(&value, bytes, sizeof value);
    return value;
}

static size_t values_of(const lq_image *image) {
    return lq_image_texels(image) * (size_t)image->channels;
}

static void take_halves(lq_image *image, const char *bytes) {
    for (size_t i = 0; i < values_of(image); i++) {
        uint16_t half;
        memcpy(&half, bytes + 2 * i, sizeof half);
        image->data[i] = lq_half_to_float(half);
    }
}

/* ---------------------------------------------------------------------------- KTX2 and DDS */

static lq_status inflate(lq_image *image, const char *bytes, size_t size, const char *path, lq_error *error) {
    const size_t expected = lq_image_bytes(image);
    char *plain = malloc(expected);
    if (!plain) return lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path);
    const size_t got = ZSTD_decompress(plain, expected, bytes, size);
    const bool fine = !ZSTD_isError(got) && got == expected;
    if (fine) take_halves(image, plain);
    free(plain);
    return fine ? LQ_OK : other(path, "its zstd frame does not hold the texels of its sizes", error);
}

/* Fields of the header: format at 12, width, height, depth, layers from 20, scheme at 44; of the level: where
 * and how long, at 80. */
static lq_status read_ktx2(lq_image *image, const char *bytes, size_t size, const char *path,
                           lq_error *error) {
    static const uint32_t formats[5] = {0, 76, 83, 0, 97};
    enum { HEADER = 104, SCHEME_ZSTD = 2 };
    if (size < HEADER || memcmp(bytes, "\xABKTX 20\xBB\r\n\x1A\n", 12) != 0)
        return other(path, "not a KTX 2.0 file", error);
    const uint32_t depth = image->depth > 1 ? (uint32_t)image->depth : 0;
    const uint32_t layers = image->array ? (uint32_t)image->layers : 0;
    if (u32(bytes + 12) != formats[image->channels] || u32(bytes + 20) != image->width ||
        u32(bytes + 24) != image->height || u32(bytes + 28) != depth || u32(bytes + 32) != layers)
        return other(path, "format or sizes are not those of the manifest", error);
    uint64_t level[2];
    memcpy(level, bytes + 80, sizeof level);
    if (level[0] > size || level[1] > size - level[0]) return other(path, "cut short", error);
    if (u32(bytes + 44) == SCHEME_ZSTD)
        return inflate(image, bytes + level[0], (size_t)level[1], path, error);
    if (u32(bytes + 44) != 0 || level[1] != lq_image_bytes(image))
        return other(path, "its level does not hold the texels of its sizes", error);
    take_halves(image, bytes + level[0]);
    return LQ_OK;
}

static lq_status read_dds(lq_image *image, const char *bytes, size_t size, const char *path,
                          lq_error *error) {
    static const uint32_t formats[5] = {0, 54, 34, 0, 10};
    enum { HEADER = 148, HEIGHT = 12, WIDTH = 16, DEPTH = 24, FORMAT = 128, ARRAY = 140 };
    if (size < HEADER || memcmp(bytes, "DDS ", 4) != 0 || memcmp(bytes + 84, "DX10", 4) != 0)
        return other(path, "not a DDS file with a DX10 block", error);
    const uint32_t depth = image->depth > 1 ? (uint32_t)image->depth : 0;
    if (u32(bytes + FORMAT) != formats[image->channels] || u32(bytes + WIDTH) != image->width ||
        u32(bytes + HEIGHT) != image->height || u32(bytes + DEPTH) != depth ||
        u32(bytes + ARRAY) != image->layers)
        return other(path, "format or sizes are not those of the manifest", error);
    if (size - HEADER != lq_image_bytes(image))
        return other(path, "its length is not that of its texels", error);
    take_halves(image, bytes + HEADER);
    return LQ_OK;
}

static lq_status read_binary(lq_image *image, bool dds, const char *path, lq_error *error) {
    char *bytes;
    size_t size;
    lq_status status = lq_input_read(path, &bytes, &size, error);
    if (status != LQ_OK) return status;
    status = dds ? read_dds(image, bytes, size, path, error) : read_ktx2(image, bytes, size, path, error);
    free(bytes);
    return status;
}

/* --------------------------------------------------------------------- EXR, .npy and C arrays */

/* In an EXR the slices of a volume lie side by side and layers below each other. */
static void take_strip(lq_image *image, const float *values) {
    const size_t width = image->width * image->depth, channels = (size_t)image->channels;
    for (size_t i = 0; i < lq_image_texels(image); i++) {
        const size_t x = i % image->width, y = i / image->width % image->height;
        const size_t z = i / (image->width * image->height) % image->depth;
        const size_t layer = i / (image->width * image->height * image->depth);
        const size_t row = layer * image->height + y, column = z * image->width + x;
        memcpy(image->data + i * channels, values + (row * width + column) * channels,
               channels * sizeof *values);
    }
}

static lq_status read_numbers(lq_image *image, bool exr, const char *path, lq_error *error) {
    static const char *const names[RGBA] = {"R", "G", "B", "A"};
    lq_raw raw;
    lq_status status = lq_raw_read(&raw, path, exr ? names : NULL, image->channels, error);
    if (status != LQ_OK) return status;
    if (raw.count != values_of(image))
        status = other(path, "it does not hold the texels of its sizes", error);
    else if (exr) take_strip(image, raw.values);
    else memcpy(image->data, raw.values, raw.count * sizeof *raw.values);
    lq_raw_free(&raw);
    return status;
}

lq_status lq_ktx2_decode(lq_image *image, const char *path, lq_error *error) {
    return read_binary(image, false, path, error);
}

lq_status lq_dds_decode(lq_image *image, const char *path, lq_error *error) {
    return read_binary(image, true, path, error);
}

lq_status lq_half_exr_decode(lq_image *image, const char *path, lq_error *error) {
    return read_numbers(image, true, path, error);
}

lq_status lq_numbers_decode(lq_image *image, const char *path, lq_error *error) {
    return read_numbers(image, false, path, error);
}
