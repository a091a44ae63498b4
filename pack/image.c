/* image.c - images of a pack: making them, rounding them to half, writing them. */
#include "pack/image.h"

#include "pack/bytes.h"
#include "pack/language.h"
#include "system/output.h"
#include "system/status.h"
#include "tables/half.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name, *ending;
} containers[LQ_CONTAINERS] = {{"ktx2", ".ktx2"}, {"ktx2-zstd", ".zstd.ktx2"},
                               {"dds", ".dds"},   {"exr", ".exr"},
                               {"npy", ".npy"},   {"c", ".h"}};

const char *lq_container_name(lq_container container) {
    return containers[container].name;
}

const char *lq_container_ending(lq_container container) {
    return containers[container].ending;
}

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

/* ------------------------------------------------------------------------------ .npy */

static void encode_npy(lq_bytes *bytes, const lq_image *image) {
    enum { PREAMBLE = 10, HEADER = 128 };
    const size_t sizes[5] = {image->layers, image->depth, image->height, image->width,
                             (size_t)image->channels};
    char header[HEADER - PREAMBLE + 1];
    int used = snprintf(header, sizeof header, "{'descr': '<f%d', 'fortran_order': False, 'shape': (",
                        image->single ? 4 : 2);
    for (int i = 0; i < 5; i++)
        if (sizes[i] > 1 || i == 3)
            used += snprintf(header + used, sizeof header - (size_t)used, "%zu, ", sizes[i]);
    used += snprintf(header + used, sizeof header - (size_t)used, "), }");
    memset(header + used, ' ', sizeof header - 2 - (size_t)used);
    header[HEADER - PREAMBLE - 1] = '\n';
    lq_bytes_add(bytes, "\x93NUMPY\x01\x00", 8);
    lq_bytes_u16(bytes, HEADER - PREAMBLE);
    lq_bytes_add(bytes, header, HEADER - PREAMBLE);
    lq_bytes_texels(bytes, image);
}

/* ---------------------------------------------------------------------------- C header */

static void encode_c(lq_bytes *bytes, const lq_image *image, const char *name) {
    enum { PER_LINE = 8 };
    const size_t count = lq_image_texels(image) * (size_t)image->channels;
    char text[256];
    int used = snprintf(
        text, sizeof text,
        "/* %s: %zu x %zu x %zu texels, %zu layers, %d channels; channels fastest, then x, y, z. */\n"
        "static const float %s[%zu] = {\n",
        name, image->width, image->height, image->depth, image->layers, image->channels, name, count);
    lq_bytes_add(bytes, text, (size_t)used);
    for (size_t i = 0; i < count; i++) {
        const bool ends = i % PER_LINE == PER_LINE - 1 || i == count - 1;
        char number[LQ_LITERAL_SIZE];
        used = snprintf(text, sizeof text, "%s%s,%s", i % PER_LINE == 0 ? "    " : " ",
                        lq_literal((double)image->data[i], LQ_C, number), ends ? "\n" : "");
        lq_bytes_add(bytes, text, (size_t)used);
    }
    lq_bytes_add(bytes, "};\n", 3);
}

lq_status lq_image_write(const lq_image *image, lq_container container, const char *name, const char *path,
                         lq_error *error) {
    lq_bytes bytes = {0};
    switch (container) {
    case LQ_CONTAINER_KTX2:
    case LQ_CONTAINER_KTX2_ZSTD:
        lq_ktx2_encode(&bytes, image, container == LQ_CONTAINER_KTX2_ZSTD);
        break;
    case LQ_CONTAINER_DDS:
        lq_dds_encode(&bytes, image);
        break;
    case LQ_CONTAINER_EXR:
        lq_half_exr_encode(&bytes, image);
        break;
    case LQ_CONTAINER_NPY:
        encode_npy(&bytes, image);
        break;
    default:
        encode_c(&bytes, image, name);
    }
    lq_status status = bytes.failed ? lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path)
                                    : lq_output_save(path, bytes.data, bytes.size, error);
    free(bytes.data);
    return status;
}
