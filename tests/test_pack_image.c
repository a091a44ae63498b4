/* Containers of a pack, byte by byte where formats have fixed bytes, and rounding to half. */
#include "tests/expect.h"
#include "tests/scratch.h"

#include "pack/image.h"

#include <string.h>

static unsigned char bytes[4096];
static size_t size;

static void save(const lq_image *image, lq_container container) {
    lq_error error = {""};
    assert_int_equal(lq_image_write(image, container, "t", at("image"), &error), LQ_OK);
    FILE *in = fopen(at("image"), "rb");
    assert_non_null(in);
    size = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    remove(at("image"));
}

static uint32_t word(size_t offset) {
    uint32_t value;
    memcpy(&value, bytes + offset, sizeof value);
    return value;
}

/* 2 x 1 texels of two channels: 1, -2, 0.5, 65504. */
static lq_image small(void) {
    lq_image image;
    lq_error error;
    assert_int_equal(lq_image_create(&image, 2, 1, 1, 1, 2, &error), LQ_OK);
    memcpy(image.data, (float[]){1.0f, -2.0f, 0.5f, 65504.0f}, 16);
    assert_int_equal(lq_image_to_half(&image, "t", &error), LQ_OK);
    return image;
}

static const unsigned char texels[8] = {0x00, 0x3C, 0x00, 0xC0, 0x00, 0x38, 0xFF, 0x7B};

static void test_ktx2(void **state) {
    (void)state;
    lq_image image = small();
    save(&image, LQ_CONTAINER_KTX2);
    assert_memory_equal(bytes, "\xABKTX 20\xBB\r\n\x1A\n", 12);
    /* format, type size, width, height, depth, layers, faces, levels, scheme, DFD, its length */
    const uint32_t head[11] = {83, 2, 2, 1, 0, 0, 1, 1, 0, 104, 60};
    for (size_t i = 0; i < 11; i++) assert_int_equal(word(12 + 4 * i), head[i]);
    /* the level */
    assert_int_equal(word(80) % 16, 0);
    assert_int_equal(word(80) + 8, size);
    assert_int_equal(word(88), 8);
    assert_int_equal(word(96), 8);
    const uint32_t dfd[15] = {60, 0,          2 | 56u << 16, 0x10101,    0, 4,          0,         0xC00F0000,
                              0,  0xBF800000, 0x3F800000,    0xC10F0010, 0, 0xBF800000, 0x3F800000};
    for (size_t i = 0; i < 15; i++) assert_int_equal(word(104 + 4 * i), dfd[i]);
    assert_memory_equal(bytes + 164 + 4, "KTXorientation\0r", 17);
    assert_memory_equal(bytes + size - 8, texels, 8);
    save(&image, LQ_CONTAINER_KTX2_ZSTD);
    assert_int_equal(word(44), 2);
    assert_int_equal(word(word(80)), 0xFD2FB528); /* a zstd frame */
    assert_int_equal(word(96), 8);
    lq_image_free(&image);
}

static void test_dds(void **state) {
    (void)state;
    lq_image image = small();
    save(&image, LQ_CONTAINER_DDS);
    assert_memory_equal(bytes, "DDS ", 4);
    const uint32_t head[7] = {124, 0x100F, 1, 2, 8, 0, 1};
    for (size_t i = 0; i < 7; i++) assert_int_equal(word(4 + 4 * i), head[i]);
    assert_int_equal(word(76), 32);
    assert_int_equal(word(80), 4);
    assert_memory_equal(bytes + 84, "DX10", 4);
    assert_int_equal(word(108), 0x1000);
    const uint32_t dx10[5] = {34, 3, 0, 1, 0};
    for (size_t i = 0; i < 5; i++) assert_int_equal(word(128 + 4 * i), dx10[i]);
    assert_int_equal(size, 148 + 8);
    assert_memory_equal(bytes + 148, texels, 8);
    lq_image_free(&image);
    assert_int_equal(lq_image_create(&image, 2, 3, 4, 1, 1, NULL), LQ_OK);
    save(&image, LQ_CONTAINER_DDS);
    assert_int_equal(word(8), 0x80100F);
    assert_int_equal(word(24), 4);
    assert_int_equal(word(108), 0x1008);
    assert_int_equal(word(112), 0x200000);
    assert_int_equal(word(128), 54);
    assert_int_equal(word(132), 4);
    assert_int_equal(size, 148 + 48);
    lq_image_free(&image);
}

static void test_npy(void **state) {
    (void)state;
    lq_image image = small();
    save(&image, LQ_CONTAINER_NPY);
    assert_int_equal(size, 128 + 8);
    assert_memory_equal(
        bytes, "\x93NUMPY\x01\x00\x76\x00{'descr': '<f2', 'fortran_order': False, 'shape': (2, 2, ), }",
        10 + 57);
    assert_memory_equal(bytes + 128, texels, 8);
    lq_image_free(&image);
}

/* Ties go to the even half; what would be infinite is refused, what rounds down to 65504 is not. */
static void test_half(void **state) {
    (void)state;
    lq_image image;
    lq_error error = {""};
    assert_int_equal(lq_image_create(&image, 4, 1, 1, 1, 1, &error), LQ_OK);
    memcpy(image.data, (float[]){1.0f + 0x1p-11f, 1.0f + 0x3p-11f, 65519.0f, 0x1p-25f}, 16);
    assert_int_equal(lq_image_to_half(&image, "t", &error), LQ_OK);
    assert_near((double)image.data[0], 1.0, 0.0);
    assert_near((double)image.data[1], 1.0 + 0x1p-9, 0.0);
    assert_near((double)image.data[2], 65504.0, 0.0);
    assert_near((double)image.data[3], 0.0, 0.0);
    image.data[0] = 65520.0f;
    assert_int_equal(lq_image_to_half(&image, "t", &error), LQ_BAD_INPUT);
    assert_string_equal(error.text, "t: 65520 has no half; accepted are values below 65520");
    lq_image_free(&image);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ktx2), cmocka_unit_test(test_dds),
                                       cmocka_unit_test(test_npy), cmocka_unit_test(test_half)};
    return cmocka_run_group_tests_name("pack-image", tests, make_folder, remove_folder);
}
