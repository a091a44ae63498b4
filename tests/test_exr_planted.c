/* EXR files whose header, chunk leaders and length contradict each other are refused, and at once. */
#include "expect.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "scratch.h"
#include "system/input.h"
#include "tables/exr_chunk.h"
#include "tables/raw.h"

enum { WIDTH = 4, HEIGHT = 2 };

typedef struct file {
    unsigned char bytes[4096];
    size_t size;
} file;

static void put(file *f, const void *bytes, size_t size) {
    memcpy(f->bytes + f->size, bytes, size);
    f->size += size;
}

static void put32(file *f, uint32_t value) {
    put(f, &value, 4);
}

static void attribute(file *f, const char *name, const char *type, const void *value, uint32_t size) {
    put(f, name, strlen(name) + 1);
    put(f, type, strlen(type) + 1);
    put32(f, size);
    put(f, value, size);
}

/* One float channel of width x height, not compressed, a row a chunk; of each row `stored` bytes are said to
 * be there, and are. Rows beyond HEIGHT are not written. */
static file make(int32_t width, int32_t height, unsigned char compression, uint32_t stored) {
    file f = {.size = 0};
    const int32_t window[4] = {0, 0, width - 1, height - 1};
    const float one = 1.0f, centre[2] = {0.0f, 0.0f};
    static const char channel[] = "Y\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0";
    put32(&f, 20000630);
    put32(&f, 2);
    attribute(&f, "channels", "chlist", channel, sizeof channel);
    attribute(&f, "compression", "compression", &compression, 1);
    attribute(&f, "dataWindow", "box2i", window, sizeof window);
    attribute(&f, "displayWindow", "box2i", window, sizeof window);
    attribute(&f, "lineOrder", "lineOrder", "\0", 1);
    attribute(&f, "pixelAspectRatio", "float", &one, 4);
    attribute(&f, "screenWindowCenter", "v2f", centre, sizeof centre);
    attribute(&f, "screenWindowWidth", "float", &one, 4);
    put(&f, "", 1);
    for (uint64_t y = 0; y < HEIGHT; y++) {
        const uint64_t offset = f.size + 8 * (HEIGHT - y) + y * (8 + (uint64_t)stored);
        put(&f, &offset, 8);
    }
    for (uint32_t y = 0; y < HEIGHT; y++) {
        put32(&f, y);
        put32(&f, stored);
        for (uint32_t i = 0; i < stored / 4; i++) put(&f, &one, 4);
    }
    return f;
}

static lq_status read_back(const file *f, lq_raw *raw) {
    char path[4096];
    snprintf(path, sizeof path, "%s", at("planted.exr"));
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(f->bytes, 1, f->size, out), f->size);
    assert_int_equal(fclose(out), 0);
    lq_error error = {""};
    *raw = (lq_raw){.count = 0};
    const lq_status status = lq_raw_read_exr(raw, path, NULL, 0, &error);
    remove(path);
    return status;
}

static void test_the_honest_file_is_read(void **state) {
    (void)state;
    lq_raw raw;
    const file f = make(WIDTH, HEIGHT, 0, WIDTH * 4);
    assert_int_equal(read_back(&f, &raw), LQ_OK);
    assert_int_equal(raw.count, WIDTH * HEIGHT);
    for (size_t i = 0; i < raw.count; i++) assert_true(raw.values[i] == 1.0);
    free(raw.values);
}

/* Rows that are shorter or longer than the header says, in a file long enough for whole ones:
 * OpenEXRCore 3.1.5 hands out memory that it did not fill, with EXR_ERR_SUCCESS, where lq_exr_check_chunk
 * does not look at the exact size. */
static void test_short_rows_are_refused(void **state) {
    (void)state;
    for (uint32_t stored = 0; stored <= 2 * WIDTH * 4; stored += 4) {
        lq_raw raw;
        file f = make(WIDTH, HEIGHT, 0, stored);
        f.size += 1024; /* zeros, behind the rows */
        const lq_status status = read_back(&f, &raw);
        assert_int_equal(status, stored == WIDTH * 4 ? LQ_OK : LQ_FORMAT);
        free(raw.values);
    }
}

/* The check by itself: each way a leader can contradict the file. */
static void test_leaders(void **state) {
    (void)state;
    const exr_chunk_info_t honest = {.height = 1,
                                     .compression = EXR_COMPRESSION_NONE,
                                     .data_offset = 100,
                                     .packed_size = 16,
                                     .unpacked_size = 16};
    assert_int_equal(lq_exr_check_chunk(&honest, 116, 16), EXR_ERR_SUCCESS);
    assert_int_equal(lq_exr_check_chunk(&honest, 115, 16), EXR_ERR_BAD_CHUNK_LEADER); /* beyond the end */
    assert_int_equal(lq_exr_check_chunk(&honest, 116, 32), EXR_ERR_BAD_CHUNK_LEADER); /* not the rows' size */
    exr_chunk_info_t chunk = honest;
    chunk.packed_size = 12; /* short */
    assert_int_equal(lq_exr_check_chunk(&chunk, 116, 16), EXR_ERR_BAD_CHUNK_LEADER);
    chunk.compression = EXR_COMPRESSION_ZIP;
    assert_int_equal(lq_exr_check_chunk(&chunk, 116, 16), EXR_ERR_SUCCESS);
    chunk.packed_size = 20; /* larger packed than not */
    assert_int_equal(lq_exr_check_chunk(&chunk, 1160, 16), EXR_ERR_BAD_CHUNK_LEADER);
}

/* Claims of gigabytes: refused within the memory that this program has. */
static void test_claims_are_not_believed(void **state) {
    (void)state;
    static const int32_t sizes[][2] = {{1 << 16, 1 << 15}, {1 << 30, 2}, {2, 1 << 30}, {60000, 60000}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (unsigned char compression = 0; compression <= 4; compression++) {
            lq_raw raw;
            const file f = make(sizes[i][0], sizes[i][1], compression, WIDTH * 4);
            assert_int_equal(read_back(&f, &raw), LQ_FORMAT);
        }
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    assert_true(used.ru_maxrss < 512 * 1024); /* KiB; ASan takes some 100 MB for itself */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_honest_file_is_read),
        cmocka_unit_test(test_short_rows_are_refused),
        cmocka_unit_test(test_leaders),
        cmocka_unit_test(test_claims_are_not_believed),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
