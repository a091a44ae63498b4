/* image_dds.c - DDS with the DX10 block (Microsoft, "Programming Guide for DDS"). */
#include "pack/bytes.h"

static uint32_t dxgi_format(const lq_image *image) {
    static const uint32_t half[5] = {0, 54, 34, 0, 10}, single[5] = {0, 41, 16, 0, 2};
    return image->single ? single[image->channels] : half[image->channels];
}

static void add_zeros(lq_bytes *bytes, int count) {
    for (int i = 0; i < count; i++) lq_bytes_u32(bytes, 0);
}

void lq_dds_encode(lq_bytes *bytes, const lq_image *image) {
    enum { CAPS, HEIGHT, WIDTH, PITCH, FORMAT = 12, VOLUME = 23, FOURCC = 4, TEXTURE = 0x1000, COMPLEX = 8 };
    const uint32_t flags = 1u << CAPS | 1u << HEIGHT | 1u << WIDTH | 1u << PITCH | 1u << FORMAT;
    const bool volume = image->depth > 1;
    const size_t texel = (size_t)image->channels * (image->single ? 4 : 2);
    lq_bytes_add(bytes, "DDS ", 4);
    lq_bytes_u32(bytes, 124);
    lq_bytes_u32(bytes, flags | (volume ? 1u << VOLUME : 0));
    lq_bytes_u32(bytes, (uint32_t)image->height);
    lq_bytes_u32(bytes, (uint32_t)image->width);
    lq_bytes_u32(bytes, (uint32_t)(image->width * texel));
    lq_bytes_u32(bytes, volume ? (uint32_t)image->depth : 0);
    lq_bytes_u32(bytes, 1); /* mip levels */
    add_zeros(bytes, 11);
    lq_bytes_u32(bytes, 32); /* the pixel format: see the DX10 block */
    lq_bytes_u32(bytes, FOURCC);
    lq_bytes_add(bytes, "DX10", 4);
    add_zeros(bytes, 5);
    lq_bytes_u32(bytes, TEXTURE | (volume || image->layers > 1 ? COMPLEX : 0));
    lq_bytes_u32(bytes, volume ? 0x200000 : 0);
    add_zeros(bytes, 3);
    lq_bytes_u32(bytes, dxgi_format(image));
    lq_bytes_u32(bytes, volume ? 4 : 3); /* 1D is W x 1 here as well */
    lq_bytes_u32(bytes, 0);
    lq_bytes_u32(bytes, (uint32_t)image->layers);
    lq_bytes_u32(bytes, 0);
    lq_bytes_texels(bytes, image);
}
