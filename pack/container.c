/* container.c - the containers of images: one row each, which says all that the rest of the pack asks. */
#include "pack/bytes.h"
#include "pack/image_read.h"
#include "system/output.h"
#include "system/status.h"

#include <assert.h>
#include <stdlib.h>
#include <sys/stat.h>

/* zstd has at its densest 128 KiB in four bytes, deflate 1032 in one. */
enum { ZSTD_DENSEST = (128 << 10) / 4, DEFLATE_DENSEST = 1032 };

typedef struct row {
    const char *name;   /* in a recipe */
    const char *ending; /* of its files */
    const char *format; /* in a manifest */
    size_t densest;     /* bytes of texels that one byte of the file may stand for */
    void (*encode)(lq_bytes *bytes, const lq_image *image, const char *name);
    lq_status (*decode)(lq_image *image, const char *path, lq_error *error);
} row;

static void encode_ktx2(lq_bytes *bytes, const lq_image *image, const char *name) {
    (void)name;
    lq_ktx2_encode(bytes, image, false);
}

static void encode_zstd(lq_bytes *bytes, const lq_image *image, const char *name) {
    (void)name;
    lq_ktx2_encode(bytes, image, true);
}

static void encode_dds(lq_bytes *bytes, const lq_image *image, const char *name) {
    (void)name;
    lq_dds_encode(bytes, image);
}

static void encode_exr(lq_bytes *bytes, const lq_image *image, const char *name) {
    (void)name;
    lq_half_exr_encode(bytes, image);
}

static void encode_npy(lq_bytes *bytes, const lq_image *image, const char *name) {
    (void)name;
    lq_npy_encode(bytes, image);
}

static const row containers[] = {
    [LQ_CONTAINER_KTX2] = {"ktx2", ".ktx2", "KTX 2.0", ZSTD_DENSEST, encode_ktx2, lq_ktx2_decode},
    [LQ_CONTAINER_KTX2_ZSTD] = {"ktx2-zstd", ".zstd.ktx2", "KTX 2.0, zstd", ZSTD_DENSEST, encode_zstd,
                                lq_ktx2_decode},
    [LQ_CONTAINER_DDS] = {"dds", ".dds", "DDS, DX10 block", 1, encode_dds, lq_dds_decode},
    [LQ_CONTAINER_EXR] = {"exr", ".exr", "OpenEXR RGBA half, slices side by side, layers below each other",
                          DEFLATE_DENSEST, encode_exr, lq_half_exr_decode},
    [LQ_CONTAINER_NPY] = {"npy", ".npy", "NumPy, first axis fastest (last index before the channels)", 1,
                          encode_npy, lq_numbers_decode},
    [LQ_CONTAINER_C] = {"c", ".h", "C array", 1, lq_c_encode, lq_numbers_decode},
};
static_assert(sizeof containers / sizeof *containers == LQ_CONTAINERS, "a row for every container");

const char *lq_container_name(lq_container container) {
    return containers[container].name;
}

const char *lq_container_ending(lq_container container) {
    return containers[container].ending;
}

const char *lq_container_format(lq_container container) {
    return containers[container].format;
}

lq_status lq_image_write(const lq_image *image, lq_container container, const char *name, const char *path,
                         lq_error *error) {
    lq_bytes bytes = {0};
    containers[container].encode(&bytes, image, name);
    const lq_status status = bytes.failed ? lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", path)
                                          : lq_output_save(path, bytes.data, bytes.size, error);
    free(bytes.data);
    return status;
}

/* Halves take two bytes, numbers of a text a digit and a comma. */
size_t lq_image_capacity(lq_container container, const char *path) {
    enum { VALUE = 2 };
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) return 0;
    return ((size_t)info.st_size / VALUE + 1) * containers[container].densest;
}

lq_status lq_image_read(lq_image *image, lq_container container, const char *path, lq_error *error) {
    return containers[container].decode(image, path, error);
}
