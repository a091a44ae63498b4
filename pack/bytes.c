/* bytes.c - appending to a file in the making. */
#include "pack/bytes.h"

#include "tables/half.h"

#include <stdlib.h>
#include <string.h>

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "values are written as they lie in memory, which must be little-endian"
#endif

static bool grow(lq_bytes *bytes, size_t size) {
    if (bytes->failed) return false;
    if (bytes->size + size <= bytes->room) return true;
    size_t room = 2 * bytes->room + size + 1024;
    unsigned char *data = realloc(bytes->data, room);
    if (!data) bytes->failed = true;
    else bytes->data = data, bytes->room = room;
    return !bytes->failed;
}

void lq_bytes_add(lq_bytes *bytes, const void *data, size_t size) {
    if (size == 0 || !grow(bytes, size)) return;
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

void lq_bytes_u16(lq_bytes *bytes, uint16_t value) {
    lq_bytes_add(bytes, &value, sizeof value);
}

void lq_bytes_u32(lq_bytes *bytes, uint32_t value) {
    lq_bytes_add(bytes, &value, sizeof value);
}

void lq_bytes_u64(lq_bytes *bytes, uint64_t value) {
    lq_bytes_add(bytes, &value, sizeof value);
}

void lq_bytes_text(lq_bytes *bytes, const char *text) {
    lq_bytes_add(bytes, text, strlen(text) + 1);
}

void lq_bytes_align(lq_bytes *bytes, size_t alignment) {
    while (bytes->size % alignment != 0 && !bytes->failed) lq_bytes_add(bytes, "", 1);
}

void lq_bytes_value(lq_bytes *bytes, const lq_image *image, float value) {
    if (image->single) lq_bytes_add(bytes, &value, sizeof value);
    else lq_bytes_u16(bytes, lq_half_from_float(value));
}

void lq_bytes_texels(lq_bytes *bytes, const lq_image *image) {
    const size_t count = lq_image_texels(image) * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) lq_bytes_value(bytes, image, image->data[i]);
}
