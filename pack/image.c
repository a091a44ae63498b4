/* image.c - images of a pack: making them, rounding them to half. */
#include "pack/image.h"

#include "system/status.h"
#include "tables/half.h"

#include <math.h>
#include <stdlib.h>

lq_status lq_image_create(lq_image *image, size_t width, size_t height, size_t depth, size_t layers,
                          int channels, lq_error *error) {
    *image = (lq_image){width, height, depth, layers, channels, layers > 1, false, NULL};
    image->data = calloc(lq_image_texels(image) * (size_t)channels, sizeof *image->data);
    return image->data ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "out of memory");
}

void lq_image_free(lq_image *image) {
    free(image->data);
    *image = (lq_image){0};
}

size_t lq_image_texels(const lq_image *image) {
    return image->width * image->height * image->depth * image->layers;
}

size_t lq_image_bytes(const lq_image *image) {
    return lq_image_texels(image) * (size_t)image->channels * (image->single ? 4 : 2);
}

lq_status lq_image_to_half(lq_image *image, const char *name, lq_error *error) {
    const size_t count = lq_image_texels(image) * (size_t)image->channels;
    for (size_t i = 0; i < count; i++) {
        const float value = image->data[i], rounded = lq_half_round(value);
        if (!isfinite(rounded))
            return lq_fail(error, LQ_BAD_INPUT, "%s: %g has no half; accepted are values below 65520", name,
                           (double)value);
        image->data[i] = rounded;
    }
    image->single = false;
    return LQ_OK;
}
