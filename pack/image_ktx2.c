/* image_ktx2.c - KTX 2.0 (Khronos KTX File Format Specification 2.0), one mip level. */
#include "pack/bytes.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

enum { DFD_OFFSET = 104, SCHEME_ZSTD = 2, ZSTD_LEVEL = 19, ALPHA = 15 };

/* VkFormat of 1, 2, (3,) 4 channels. */
static uint32_t vulkan_format(const lq_image *image) {
    static const uint32_t half[5] = {0, 76, 83, 0, 97}, single[5] = {0, 100, 103, 0, 109};
    return image->single ? single[image->channels] : half[image->channels];
}

/* The basic data format descriptor: signed floats, linear, BT.709 primaries. */
static void add_descriptor(lq_bytes *bytes, const lq_image *image) {
    const uint32_t n = (uint32_t)image->channels, bits = image->single ? 32 : 16;
    lq_bytes_u32(bytes, 28 + 16 * n);
    lq_bytes_u32(bytes, 0);
    lq_bytes_u32(bytes, 2 | (24 + 16 * n) << 16);
    lq_bytes_u32(bytes, 1 | 1 << 8 | 1 << 16);
    lq_bytes_u32(bytes, 0);
    lq_bytes_u32(bytes, n * bits / 8);
    lq_bytes_u32(bytes, 0);
    for (uint32_t c = 0; c < n; c++) {
        lq_bytes_u32(bytes, c * bits | (bits - 1) << 16 | ((c == 3 ? ALPHA : c) | 0xC0) << 24);
        lq_bytes_u32(bytes, 0);
        lq_bytes_u32(bytes, 0xBF800000); /* -1 and 1 as floats: the range that stands for [-1, 1] */
        lq_bytes_u32(bytes, 0x3F800000);
    }
}

static void add_key(lq_bytes *bytes, const char *key, const char *value) {
    lq_bytes_u32(bytes, (uint32_t)(strlen(key) + strlen(value) + 2));
    lq_bytes_text(bytes, key);
    lq_bytes_text(bytes, value);
    lq_bytes_align(bytes, 4);
}

static void compress(lq_bytes *texels) {
    lq_bytes packed = {.room = ZSTD_compressBound(texels->size)};
    packed.data = malloc(packed.room);
    packed.failed = texels->failed || !packed.data;
    if (!packed.failed)
        packed.size = ZSTD_compress(packed.data, packed.room, texels->data, texels->size, ZSTD_LEVEL);
    if (!packed.failed && ZSTD_isError(packed.size)) packed.failed = true;
    if (packed.failed) packed.size = 0; /* an error code is no size */
    free(texels->data);
    *texels = packed;
}

void lq_ktx2_encode(lq_bytes *bytes, const lq_image *image, bool compressed) {
    const uint32_t dfd = 28 + 16 * (uint32_t)image->channels;
    const size_t plain = lq_image_bytes(image);
    lq_bytes keys = {0}, texels = {0};
    add_key(&keys, "KTXorientation", image->depth > 1 ? "rdi" : image->height > 1 ? "rd" : "r");
    add_key(&keys, "KTXwriter", "lacquer " LQ_VERSION);
    lq_bytes_texels(&texels, image);
    if (compressed) compress(&texels);
    lq_bytes_add(bytes, "\xABKTX 20\xBB\r\n\x1A\n", 12);
    lq_bytes_u32(bytes, vulkan_format(image));
    lq_bytes_u32(bytes, image->single ? 4 : 2);
    lq_bytes_u32(bytes, (uint32_t)image->width);
    lq_bytes_u32(bytes, (uint32_t)image->height); /* 1D is W x 1: more readers take it */
    lq_bytes_u32(bytes, image->depth > 1 ? (uint32_t)image->depth : 0);
    lq_bytes_u32(bytes, image->array ? (uint32_t)image->layers : 0);
    lq_bytes_u32(bytes, 1);
    lq_bytes_u32(bytes, 1);
    lq_bytes_u32(bytes, compressed ? SCHEME_ZSTD : 0);
    lq_bytes_u32(bytes, DFD_OFFSET);
    lq_bytes_u32(bytes, dfd);
    lq_bytes_u32(bytes, DFD_OFFSET + dfd);
    lq_bytes_u32(bytes, (uint32_t)keys.size);
    lq_bytes_u64(bytes, 0);
    lq_bytes_u64(bytes, 0);
    /* A level starts at a multiple of its texel size (and of 4) unless it is compressed. */
    size_t start = DFD_OFFSET + dfd + keys.size, alignment = compressed ? 1 : 16;
    start = (start + alignment - 1) / alignment * alignment;
    lq_bytes_u64(bytes, start);
    lq_bytes_u64(bytes, texels.size);
    lq_bytes_u64(bytes, plain);
    add_descriptor(bytes, image);
    lq_bytes_add(bytes, keys.data, keys.size);
    lq_bytes_align(bytes, alignment);
    lq_bytes_add(bytes, texels.data, texels.size);
    bytes->failed = bytes->failed || keys.failed || texels.failed;
    free(keys.data);
    free(texels.data);
}
