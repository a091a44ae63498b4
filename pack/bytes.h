/* bytes.h - a file in the making: little-endian values appended to memory. */
#ifndef LACQUER_PACK_BYTES_H
#define LACQUER_PACK_BYTES_H

#include "pack/image.h"

/* Once `failed` (out of memory), what is appended is dropped. */
typedef struct lq_bytes {
    unsigned char *data;
    size_t size, room;
    bool failed;
} lq_bytes;

void lq_bytes_add(lq_bytes *bytes, const void *data, size_t size);
void lq_bytes_u16(lq_bytes *bytes, uint16_t value);
void lq_bytes_u32(lq_bytes *bytes, uint32_t value);
void lq_bytes_u64(lq_bytes *bytes, uint64_t value);
/* With its terminating zero. */
void lq_bytes_text(lq_bytes *bytes, const char *text);
/* Zeros up to a multiple of `alignment`. */
void lq_bytes_align(lq_bytes *bytes, size_t alignment);
/* One channel value as the image stores it. */
void lq_bytes_value(lq_bytes *bytes, const lq_image *image, float value);
/* All values of the image, in its order. */
void lq_bytes_texels(lq_bytes *bytes, const lq_image *image);

/* The containers; each appends the whole file. */
void lq_ktx2_encode(lq_bytes *bytes, const lq_image *image, bool compressed);
void lq_dds_encode(lq_bytes *bytes, const lq_image *image);
void lq_half_exr_encode(lq_bytes *bytes, const lq_image *image);
void lq_npy_encode(lq_bytes *bytes, const lq_image *image);
/* `name` is that of the array. */
void lq_c_encode(lq_bytes *bytes, const lq_image *image, const char *name);

#endif
