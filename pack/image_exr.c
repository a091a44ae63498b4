/* image_exr.c - OpenEXR, single part, RGBA half, uncompressed scan lines: what every importer takes. */
#include "pack/bytes.h"

#include "tables/half.h"

#include <stdlib.h>

enum { RGBA = 4, HALF = 1 };

static void add_attribute(lq_bytes *bytes, const char *name, const char *type, const void *value,
                          uint32_t size) {
    lq_bytes_text(bytes, name);
    lq_bytes_text(bytes, type);
    lq_bytes_u32(bytes, size);
    lq_bytes_add(bytes, value, size);
}

/* Channels in the order of their names, as the format asks. */
static void add_channels(lq_bytes *bytes) {
    lq_bytes list = {0};
    for (int c = 0; c < RGBA; c++) {
        const char name[2] = {"ABGR"[c], '\0'};
        lq_bytes_text(&list, name);
        lq_bytes_u32(&list, HALF);
        lq_bytes_u32(&list, 0); /* not perceptual */
        lq_bytes_u32(&list, 1);
        lq_bytes_u32(&list, 1);
    }
    lq_bytes_add(&list, "", 1);
    add_attribute(bytes, "channels", "chlist", list.data, (uint32_t)list.size);
    bytes->failed = bytes->failed || list.failed;
    free(list.data);
}

static void add_header(lq_bytes *bytes, size_t width, size_t height) {
    const int32_t window[4] = {0, 0, (int32_t)width - 1, (int32_t)height - 1};
    const float one = 1.0f, centre[2] = {0.0f, 0.0f};
    lq_bytes_u32(bytes, 20000630);
    lq_bytes_u32(bytes, 2);
    add_channels(bytes);
    add_attribute(bytes, "compression", "compression", "", 1);
    add_attribute(bytes, "dataWindow", "box2i", window, sizeof window);
    add_attribute(bytes, "displayWindow", "box2i", window, sizeof window);
    add_attribute(bytes, "lineOrder", "lineOrder", "", 1);
    add_attribute(bytes, "pixelAspectRatio", "float", &one, sizeof one);
    add_attribute(bytes, "screenWindowCenter", "v2f", centre, sizeof centre);
    add_attribute(bytes, "screenWindowWidth", "float", &one, sizeof one);
    lq_bytes_add(bytes, "", 1);
}

/* Channels an image lacks are 0, alpha 1. */
static float value_at(const lq_image *image, size_t column, size_t row, int channel) {
    const size_t x = column % image->width, z = column / image->width;
    const size_t y = row % image->height, layer = row / image->height;
    const size_t texel = ((layer * image->depth + z) * image->height + y) * image->width + x;
    if (channel < image->channels) return image->data[texel * (size_t)image->channels + (size_t)channel];
    return channel == RGBA - 1 ? 1.0f : 0.0f;
}

void lq_half_exr_encode(lq_bytes *bytes, const lq_image *image) {
    const size_t width = image->width * image->depth, height = image->height * image->layers;
    const size_t line = 8 + 2 * RGBA * width;
    add_header(bytes, width, height);
    const size_t chunks = bytes->size + 8 * height;
    for (size_t y = 0; y < height; y++) lq_bytes_u64(bytes, chunks + y * line);
    for (size_t y = 0; y < height; y++) {
        lq_bytes_u32(bytes, (uint32_t)y);
        lq_bytes_u32(bytes, (uint32_t)(2 * RGBA * width));
        for (int c = RGBA - 1; c >= 0; c--)
            for (size_t x = 0; x < width; x++)
                lq_bytes_u16(bytes, lq_half_from_float(value_at(image, x, y, c)));
    }
}
