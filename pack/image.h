/* image.h - the images of a texture pack and the containers they go into. */
#ifndef LACQUER_PACK_IMAGE_H
#define LACQUER_PACK_IMAGE_H

#include "lacquer.h"

#include <stdint.h>

/* Texel (x, y, z) of layer l has its channels at data[(((l * depth + z) * height + y) * width + x) *
 * channels]. Row 0 is the first one stored: the texel at texture coordinates near 0. */
typedef struct lq_image {
    size_t width, height, depth; /* 1 where the image has no such axis */
    size_t layers;               /* > 1: an array of 2D images; depth is then 1 */
    int channels;                /* 1, 2 or 4 */
    bool array;                  /* an array also where it has one layer */
    bool single;                 /* float32; otherwise half */
    float *data;                 /* what the file holds: exact in half where `single` is not set */
} lq_image;

typedef enum lq_container {
    LQ_CONTAINER_KTX2,
    LQ_CONTAINER_KTX2_ZSTD, /* the same with its texels in one zstd frame */
    LQ_CONTAINER_DDS,       /* with the DX10 block */
    LQ_CONTAINER_EXR,       /* RGBA half; slices of a volume side by side, layers below each other */
    LQ_CONTAINER_NPY, /* float16 or float32, shape (layers, depth, height, width, channels) without ones */
    LQ_CONTAINER_C,   /* a header with an array of float */
    LQ_CONTAINERS
} lq_container;

/* "ktx2", "ktx2-zstd", ... and what its files end in. */
const char *lq_container_name(lq_container container);
const char *lq_container_ending(lq_container container);
/* What a manifest says of them. */
const char *lq_container_format(lq_container container);

/* An image of zeros. */
lq_status lq_image_create(lq_image *image, size_t width, size_t height, size_t depth, size_t layers,
                          int channels, lq_error *error);
void lq_image_free(lq_image *image);

size_t lq_image_texels(const lq_image *image);
/* Of its texels as a GPU holds them. */
size_t lq_image_bytes(const lq_image *image);

/* Round every value to half. LQ_BAD_INPUT where one has no finite half: from 65520 up. */
lq_status lq_image_to_half(lq_image *image, const char *name, lq_error *error);

/* Write it; `name` is what the C header calls the array. */
lq_status lq_image_write(const lq_image *image, lq_container container, const char *name, const char *path,
                         lq_error *error);

/* At most so many values can be in the file, by its length and what its container can do: 0 where it is not
 * there. */
size_t lq_image_capacity(lq_container container, const char *path);

/* The texels of a file into an image of half floats whose sizes are known. LQ_FORMAT where the file says it
 * has others, or does not hold them. */
lq_status lq_image_read(lq_image *image, lq_container container, const char *path, lq_error *error);

#endif
