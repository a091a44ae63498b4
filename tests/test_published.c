/* Published binary layouts: where bytes go, round trips, and files that are not what they should be. */
#include "tests/expect.h"

#include "lacquer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char file[] = "test_published.bin";

static void write_bytes(const void *bytes, size_t size) {
    FILE *out = fopen(file, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    fclose(out);
}

static size_t read_bytes(void *bytes, size_t size) {
    FILE *in = fopen(file, "rb");
    assert_non_null(in);
    size = fread(bytes, 1, size, in);
    fclose(in);
    return size;
}

/* A 2 x 3 x 4 table whose value at (i, j, k) is 100 i + 10 j + k. */
static lq_table *make(const char *kind, lq_map map) {
    static const char *const names[] = {"mu", "alpha", "eta"};
    const char *channel = "value";
    lq_axis axes[3];
    lq_error error;
    lq_table *table;
    for (size_t a = 0; a < 3; a++)
        assert_int_equal(lq_axis_make(&axes[a], names[a], 0.0, a == 2 ? 4.0 : 1.0, 2 + a,
                                      a == 1 ? map : LQ_MAP_LINEAR, 0.0, &error),
                         LQ_OK);
    assert_int_equal(lq_table_create(&table, axes, 3, &channel, 1, &error), LQ_OK);
    for (size_t i = 0; i < 24; i++) table->channels[0][i] = (float)(100 * (i % 2) + 10 * (i / 2 % 3) + i / 6);
    lq_table_set_fact(table, "table", kind, &error);
    for (size_t a = 0; a < 3; a++) lq_axis_free(&axes[a]);
    return table;
}

static void round_trip(lq_layout layout, const char *kind, float second) {
    lq_table *table = make(kind, LQ_MAP_LINEAR), *back;
    lq_error error;
    unsigned char bytes[256];
    int32_t size[3];
    float range[6], data[24];
    assert_int_equal(lq_published_write(table, file, layout, &error), LQ_OK);
    assert_int_equal(read_bytes(bytes, sizeof bytes), 12 + 24 + 96);
    memcpy(size, bytes, 12);
    memcpy(range, bytes + 12, 24);
    memcpy(data, bytes + 36, 96);
    assert_true(size[0] == 2 && size[1] == 3 && size[2] == 4);
    assert_true(range[0] == 0.0f && range[1] == 1.0f && range[4] == 0.0f && range[5] == 4.0f);
    assert_true(data[0] == 0.0f && data[1] == second && data[23] == 123.0f);
    assert_int_equal(lq_published_read(&back, file, layout, kind, &error), LQ_OK);
    assert_memory_equal(back->channels[0], table->channels[0], 96);
    assert_string_equal(lq_table_fact(back, "table"), kind);
    assert_string_equal(lq_table_fact(back, "layout"), lq_layout_name(layout));
    assert_null(lq_table_fact(back, "tolerance"));
    for (int a = 0; a < 3; a++) assert_string_equal(back->axes[a].name, table->axes[a].name);
    assert_near(back->axes[2].nodes[1], 4.0 / 3.0, 1e-7);
    lq_table_free(back);
    lq_table_free(table);
}

static void what_is_written_is_read(void **state) {
    (void)state;
    round_trip(LQ_BELCOUR, "tir-pass", 1.0f); /* last axis fastest */
    round_trip(LQ_TM, "tir-loss", 100.0f);    /* first axis fastest */
}

static void refuse_write(lq_layout layout, const char *kind, lq_map map, const char *says) {
    lq_table *table = make(kind, map);
    lq_error error = {""};
    remove(file);
    assert_int_equal(lq_published_write(table, file, layout, &error), LQ_BAD_INPUT);
    if (!strstr(error.text, says)) fail_msg("'%s' does not say '%s'", error.text, says);
    assert_int_not_equal(access(file, F_OK), 0);
    lq_table_free(table);
}

static void what_a_layout_cannot_hold_is_refused(void **state) {
    (void)state;
    refuse_write(LQ_BELCOUR, "tir-loss", LQ_MAP_LINEAR, "stores no tir-loss; it stores: fgd, tir-pass");
    refuse_write(LQ_TM, "tir-pass", LQ_MAP_LINEAR, "stores no tir-pass");
    refuse_write(LQ_BELCOUR, "tir-pass", LQ_MAP_SQRT, "alpha has 3, sqrt");
    refuse_write(LQ_BELCOUR, "fgd", LQ_MAP_LINEAR, "over 4 axes, not 3");
    refuse_write(LQ_TM, "albedo", LQ_MAP_LINEAR, "separable masking");
    refuse_write(LQ_MITSUBA, "transmission", LQ_MAP_LINEAR, "over 4 axes, not 3");
    refuse_write(LQ_MITSUBA_INSIDE, "transmission", LQ_MAP_LINEAR, "written whole as mitsuba");
}

static void refuse_read(const char *kind, const void *bytes, size_t size, const char *says) {
    lq_table *table = NULL;
    lq_error error = {""};
    write_bytes(bytes, size);
    assert_int_equal(lq_published_read(&table, file, LQ_BELCOUR, kind, &error), LQ_FORMAT);
    if (!strstr(error.text, says)) fail_msg("'%s' does not say '%s'", error.text, says);
    assert_null(table);
}

static void damaged_files_are_refused(void **state) {
    (void)state;
    lq_table *table = make("tir-pass", LQ_MAP_LINEAR);
    lq_error error;
    unsigned char good[256], bad[256];
    assert_int_equal(lq_published_write(table, file, LQ_BELCOUR, &error), LQ_OK);
    const size_t size = read_bytes(good, sizeof good);
    lq_table_free(table);
    for (size_t cut = 0; cut < size; cut++) refuse_read("tir-pass", good, cut, file);
    refuse_read("tir-pass", good, size + 1, "do not make up its length");
    refuse_read("tir-pass", good, 20, "too short");
    refuse_read("fgd", good, size, "not a belcour table of fgd");
    static const int32_t sizes[] = {0, 1, -3, INT32_MIN, INT32_MAX, 1 << 20, 5};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (size_t a = 0; a < 3; a++) {
            memcpy(bad, good, size);
            memcpy(bad + 4 * a, &sizes[i], 4);
            refuse_read("tir-pass", bad, size, "not a belcour table of tir-pass");
        }
    const int32_t huge[] = {1 << 20, 1 << 20, 1 << 20}; /* their product is 2^60 */
    memcpy(bad, good, size);
    memcpy(bad, huge, sizeof huge);
    refuse_read("tir-pass", bad, size, "do not make up");
    static const float ends[] = {NAN, INFINITY, -INFINITY, 0.0f, -1.0f};
    for (size_t i = 0; i < 5; i++) {
        memcpy(bad, good, size);
        memcpy(bad + 24, &ends[i], 4); /* the far end of alpha, whose other end is 0 */
        refuse_read("tir-pass", bad, size, "axis alpha");
    }
    lq_table *none;
    assert_int_equal(lq_published_read(&none, "no/such.bin", LQ_TM, "fgd", &error), LQ_IO);
    assert_int_equal(lq_published_read(&none, "/", LQ_TM, "fgd", &error), LQ_IO);
    assert_int_equal(lq_published_read(&none, file, LQ_TM, "nonsense", &error), LQ_BAD_INPUT);
}

/* ------------------------------------------------------------------------------------ Mitsuba */

enum {
    ETAS = 2,
    ALPHAS = 3,
    COSINES = 4,
    HEAD = 17 + 24 + 16,
    ROW = COSINES + 1,
    CELLS = 2 * ETAS * ALPHAS * ROW
};

/* Entry e of the outside block, then the inside one, is its own number. */
static size_t make_mitsuba(unsigned char *bytes) {
    const uint64_t size[] = {ETAS, ALPHAS, COSINES};
    const float range[] = {1.25f, 4.0f, 0.0f, 0.5f};
    memcpy(bytes, "MTS_TRANSMITTANCE", 17);
    memcpy(bytes + 17, size, 24);
    memcpy(bytes + 41, range, 16);
    for (int i = 0; i < CELLS; i++) {
        const float value = (float)i;
        memcpy(bytes + HEAD + 4 * i, &value, 4);
    }
    return HEAD + 4 * CELLS;
}

static lq_table *read_mitsuba(lq_layout layout, const char *kind) {
    lq_table *table;
    lq_error error = {""};
    if (lq_published_read(&table, file, layout, kind, &error) != LQ_OK) fail_msg("%s", error.text);
    return table;
}

static void mitsuba_blocks_become_tables(void **state) {
    (void)state;
    unsigned char bytes[HEAD + 4 * CELLS];
    write_bytes(bytes, make_mitsuba(bytes));
    lq_table *table = read_mitsuba(LQ_MITSUBA, "transmission");
    assert_int_equal(table->axis_count, 4);
    assert_near(table->axes[0].nodes[1], 1.0 / 81.0, 1e-12);
    assert_near(table->axes[1].nodes[1], 0.5 / 16.0, 1e-9);
    assert_near(table->axes[2].nodes[0], 1.25, 0.0);
    /* mu 1, alpha 2, eta 1 */
    assert_near((double)table->channels[0][1 + 4 * (2 + 3 * 1)], (1 * ALPHAS + 2) * ROW + 1, 0.0);
    lq_table_free(table);
    table = read_mitsuba(LQ_MITSUBA_INSIDE, "transmission");
    assert_near(table->axes[2].nodes[0], 0.25, 0.0); /* 1/4, the last row of the file */
    assert_near(table->axes[2].nodes[1], 0.8, 0.0);
    assert_near((double)table->channels[0][1 + 4 * (2 + 3 * 0)],
                ETAS * ALPHAS * ROW + (1 * ALPHAS + 2) * ROW + 1, 0.0);
    lq_table_free(table);
    table = read_mitsuba(LQ_MITSUBA_INSIDE, "diffuse-transmission");
    assert_string_equal(table->axes[0].name, "eta");
    assert_near((double)table->channels[0][1 + 2 * 2], ETAS * ALPHAS * ROW + (1 * ALPHAS + 2) * ROW + COSINES,
                0.0);
    lq_table_free(table);
}

static void damaged_mitsuba_files_are_refused(void **state) {
    (void)state;
    unsigned char bytes[HEAD + 4 * CELLS + 1] = {0};
    lq_table *table = NULL;
    lq_error error;
    const size_t size = make_mitsuba(bytes);
    for (size_t cut = 0; cut <= size + 1; cut += 3) {
        if (cut == size) continue;
        write_bytes(bytes, cut);
        assert_int_equal(lq_published_read(&table, file, LQ_MITSUBA, "transmission", &error), LQ_FORMAT);
    }
    const uint64_t absurd[] = {0, 1, UINT64_MAX, UINT64_MAX / 4, 1u << 20, 3};
    for (size_t i = 0; i < 6; i++)
        for (size_t a = 0; a < 3; a++) {
            make_mitsuba(bytes);
            if (absurd[i] == (uint64_t[]){ETAS, ALPHAS, COSINES}[a]) continue;
            memcpy(bytes + 17 + 8 * a, &absurd[i], 8);
            write_bytes(bytes, size);
            assert_int_equal(lq_published_read(&table, file, LQ_MITSUBA, "transmission", &error), LQ_FORMAT);
            assert_null(table);
        }
}

/* Where the outside mean is eta^2 times the inside one, the file comes back as it was. */
static void a_mitsuba_file_is_written_as_it_was_read(void **state) {
    (void)state;
    unsigned char bytes[HEAD + 4 * CELLS], again[HEAD + 4 * CELLS + 1];
    const size_t size = make_mitsuba(bytes);
    for (int row = 0; row < ETAS * ALPHAS; row++) {
        const float eta = row < ALPHAS ? 1.25f : 4.0f;
        const float inside = 0.03125f * (float)(row % ALPHAS), outside = eta * eta * inside;
        memcpy(bytes + HEAD + 4 * (row * ROW + COSINES), &outside, 4);
        memcpy(bytes + HEAD + 4 * ((ETAS * ALPHAS + row) * ROW + COSINES), &inside, 4);
    }
    write_bytes(bytes, size);
    lq_table *outside = read_mitsuba(LQ_MITSUBA, "transmission");
    lq_table *inside = read_mitsuba(LQ_MITSUBA_INSIDE, "transmission");
    lq_table *diffuse = read_mitsuba(LQ_MITSUBA_INSIDE, "diffuse-transmission");
    lq_error error = {""};
    assert_null(lq_table_fact(outside, "ndf"));
    remove(file);
    assert_int_equal(lq_mitsuba_write(outside, inside, diffuse, file, &error), LQ_OK);
    assert_int_equal(read_bytes(again, sizeof again), size);
    assert_memory_equal(again, bytes, size);
    remove(file);
    assert_int_equal(lq_mitsuba_write(inside, outside, diffuse, file, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "map power4; eta has 2, custom"));
    assert_int_equal(lq_mitsuba_write(outside, outside, diffuse, file, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "inside table"));
    assert_int_equal(lq_mitsuba_write(outside, inside, inside, file, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "diffuse table"));
    assert_int_equal(lq_published_write(outside, file, LQ_MITSUBA, &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "three tables"));
    assert_int_not_equal(access(file, F_OK), 0);
    lq_table_free(outside);
    lq_table_free(inside);
    lq_table_free(diffuse);
}

static int clean(void **state) {
    (void)state;
    remove(file);
    return 0;
}

static char folder[] = "/tmp/lacquer-published-XXXXXX";

static int remove_scratch(void **state) {
    (void)state;
    return chdir("/") == 0 ? rmdir(folder) : -1;
}

static int move_to_scratch(void **state) {
    (void)state;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(what_is_written_is_read, clean),
        cmocka_unit_test_teardown(what_a_layout_cannot_hold_is_refused, clean),
        cmocka_unit_test_teardown(damaged_files_are_refused, clean),
        cmocka_unit_test_teardown(mitsuba_blocks_become_tables, clean),
        cmocka_unit_test_teardown(a_mitsuba_file_is_written_as_it_was_read, clean),
        cmocka_unit_test_teardown(damaged_mitsuba_files_are_refused, clean),
    };
    return cmocka_run_group_tests(tests, move_to_scratch, remove_scratch);
}
