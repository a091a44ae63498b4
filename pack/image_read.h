/* image_read.h - readers of containers: texels into an image of half floats whose sizes are known. */
#ifndef LACQUER_PACK_IMAGE_READ_H
#define LACQUER_PACK_IMAGE_READ_H

#include "pack/image.h"

/* LQ_FORMAT where the file says it has others, or does not hold them. */
lq_status lq_ktx2_decode(lq_image *image, const char *path, lq_error *error); /* compressed or not */
lq_status lq_dds_decode(lq_image *image, const char *path, lq_error *error);
lq_status lq_half_exr_decode(lq_image *image, const char *path, lq_error *error);
/* .npy, or the numbers of a C array. */
lq_status lq_numbers_decode(lq_image *image, const char *path, lq_error *error);

#endif
