/* test_exr.c - tables through EXR and back, and every file that must be refused. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <omp.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lacquer.h"
#include "tests/scratch.h"

static void assert_contains(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("'%s' does not contain '%s'", text, part);
}

static unsigned char *slurp(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static void spill(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void expect_refused(const char *path, lq_status status, const char *part) {
    lq_table *table = (lq_table *)1;
    lq_error error = {""};
    assert_int_equal(lq_table_read_exr(&table, path, &error), status);
    assert_null(table);
    assert_contains(error.text, path);
    assert_contains(error.text, part);
    assert_contains(error.text, "accepted");
    assert_int_equal(lq_table_read_exr(&table, path, NULL), status);
}

/* ------------------------------------------------------------------ tables */

static lq_table *make_table(const char *const *forms, int axis_count, const char *const *channels,
                            int channel_count) {
    const char *names[] = {"mu", "alpha", "n", "kappa"};
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_table *table;
    lq_error error;
    for (int i = 0; i < axis_count; i++)
        if (lq_axis_parse(&axes[i], names[i], forms[i], &error)) fail_msg("%s", error.text);
    if (lq_table_create(&table, axes, axis_count, channels, channel_count, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < axis_count; i++) lq_axis_free(&axes[i]);
    size_t entries = lq_table_entries(table);
    for (int c = 0; c < channel_count; c++)
        for (size_t k = 0; k < entries; k++) table->channels[c][k] = (float)cos(0.37 * (double)k + c);
    return table;
}

static void set(lq_table *table, const char *key, const char *value) {
    lq_error error;
    if (lq_table_set_fact(table, key, value, &error)) fail_msg("%s", error.text);
}

static lq_table *small_table(void) {
    const char *forms[] = {"0:1:5", "0:1:9:sqrt"}, *channels[] = {"fgd"};
    lq_table *table = make_table(forms, 2, channels, 1);
    set(table, "table", "fgd");
    set(table, "ndf", "ggx");
    return table;
}

static void write_table(const lq_table *table, const char *path) {
    lq_error error;
    if (lq_table_write_exr(table, path, &error)) fail_msg("%s", error.text);
}

static void assert_same_axis(const lq_axis *a, const lq_axis *b) {
    assert_string_equal(a->name, b->name);
    assert_int_equal(a->size, b->size);
    assert_int_equal(a->map, b->map);
    assert_memory_equal(&a->min, &b->min, sizeof(double));
    assert_memory_equal(&a->max, &b->max, sizeof(double));
    assert_memory_equal(&a->exponent, &b->exponent, sizeof(double));
    assert_memory_equal(a->nodes, b->nodes, a->size * sizeof(double));
}

static void assert_same_table(const lq_table *a, const lq_table *b) {
    assert_int_equal(a->axis_count, b->axis_count);
    for (int i = 0; i < a->axis_count; i++) assert_same_axis(&a->axes[i], &b->axes[i]);
    assert_int_equal(a->channel_count, b->channel_count);
    for (int c = 0; c < a->channel_count; c++) {
        assert_string_equal(a->channel_names[c], b->channel_names[c]);
        assert_memory_equal(a->channels[c], b->channels[c], lq_table_entries(a) * sizeof(float));
    }
    assert_int_equal(a->fact_count, b->fact_count);
    for (size_t i = 0; i < a->fact_count; i++) {
        assert_string_equal(a->facts[i].key, b->facts[i].key);
        assert_string_equal(a->facts[i].value, b->facts[i].value);
    }
}

static void check_round_trip(lq_table *table) {
    lq_table *back;
    lq_error error;
    write_table(table, at("table.exr"));
    if (lq_table_read_exr(&back, at("table.exr"), &error)) fail_msg("%s", error.text);
    assert_same_table(table, back);
    lq_table_free(back);
    lq_table_free(table);
}

/* ------------------------------------------------------------------ round trips */

static void test_every_map_and_axis_count(void **state) {
    (void)state;
    const char *forms[] = {"0:1:17:sqrt", "0.1:0.7:6:power2.718281828459045", "-1,0,1e-300,0.3,7e77",
                           "0.001:4.321:5"};
    const char *channels[] = {"value"};
    for (int count = 1; count <= 4; count++) check_round_trip(make_table(forms, count, channels, 1));
}

static void test_single_nodes(void **state) {
    (void)state;
    const char *ones[] = {"0.1", "1", "-3.3e-7", "0"}, *channels[] = {"value"};
    const char *first[] = {"1", "0:1:40"}, *last[] = {"0:1:40", "0.25"};
    check_round_trip(make_table(ones, 4, channels, 1));
    check_round_trip(make_table(ones, 1, channels, 1));
    check_round_trip(make_table(first, 2, channels, 1));
    check_round_trip(make_table(last, 2, channels, 1));
}

/* Table order, which is not the order of the names. */
static void test_channel_order(void **state) {
    (void)state;
    const char *forms[] = {"0:1:33", "0:1:50"};
    const char *channels[] = {"z", "A", "b10", "b9", "a.x", "_", "B", "m"};
    for (int count = 1; count <= 8; count++) check_round_trip(make_table(forms, 2, channels, count));
}

static void test_facts(void **state) {
    (void)state;
    lq_table *table = small_table();
    set(table, "empty", "");
    set(table, "unicode",
        "FGD\xE2\x88\x9E = \xE2\x88\xAB F D dm, \xC2\xB1 1e-5 \"quoted\" \\ \n second line");
    set(table, "latin1", "caf\xE9");
    set(table, "a-fact-key-as-long-as-they-come", "31 characters");
    set(table, "axes", "not the attribute of that name");
    char *text = malloc(100001);
    memset(text, 'x', 100000);
    text[100000] = '\0';
    set(table, "command", text);
    free(text);
    check_round_trip(table);
}

static void test_odd_values(void **state) {
    (void)state;
    lq_table *table = small_table();
    const float odd[] = {-0.0f, INFINITY, -INFINITY, 1e-45f, 3.4e38f, NAN};
    memcpy(table->channels[0], odd, sizeof odd);
    check_round_trip(table);
}

/* Constant data compresses, data of one repeated row does, noise does not: all three ways of a chunk. */
static void test_chunk_kinds(void **state) {
    (void)state;
    const char *forms[] = {"0:1:100", "0:1:100"}, *channels[] = {"value"};
    const off_t limits[] = {2200, 6500, 43000};
    for (int kind = 0; kind < 3; kind++) {
        lq_table *table = make_table(forms, 2, channels, 1);
        for (size_t k = 0; k < 10000; k++)
            if (kind < 2) table->channels[0][k] = kind == 0 ? 1 : (float)cos((double)(k % 100));
        check_round_trip(table);
        struct stat info;
        assert_int_equal(stat(at("table.exr"), &info), 0);
        if (info.st_size > limits[kind]) fail_msg("kind %d takes %ld bytes", kind, (long)info.st_size);
    }
}

static void test_large_custom_axis(void **state) {
    (void)state;
    enum { SIZE = 20000 };
    double *nodes = malloc(SIZE * sizeof *nodes);
    for (int i = 0; i < SIZE; i++) nodes[i] = exp(0.001 * i) / 3;
    lq_axis axis;
    const char *channels[] = {"value"};
    lq_table *table;
    assert_int_equal(lq_axis_make_custom(&axis, "x", nodes, SIZE, NULL), LQ_OK);
    assert_int_equal(lq_table_create(&table, &axis, 1, channels, 1, NULL), LQ_OK);
    lq_axis_free(&axis);
    free(nodes);
    check_round_trip(table);
}

static void test_bytes_do_not_depend_on_threads(void **state) {
    (void)state;
    const char *forms[] = {"0:1:64", "0:1:64", "0:1:150"}, *channels[] = {"b", "a"};
    lq_table *table = make_table(forms, 3, channels, 2);
    for (size_t k = 0; k < lq_table_entries(table); k += 3) table->channels[0][k] = 1;
    int threads = omp_get_max_threads();
    size_t sizes[3];
    unsigned char *bytes[3];
    for (int n = 1; n <= 3; n++) {
        omp_set_num_threads(n);
        write_table(table, at("threads.exr"));
        bytes[n - 1] = slurp(at("threads.exr"), &sizes[n - 1]);
    }
    omp_set_num_threads(threads);
    for (int n = 1; n < 3; n++) {
        assert_int_equal(sizes[n], sizes[0]);
        assert_memory_equal(bytes[n], bytes[0], sizes[0]);
    }
    for (int n = 0; n < 3; n++) free(bytes[n]);
    unlink(at("threads.exr"));
    lq_table_free(table);
}

/* ------------------------------------------------------------------ damage */

static void test_every_truncation_is_refused(void **state) {
    (void)state;
    lq_table *table = small_table();
    write_table(table, at("whole.exr"));
    lq_table_free(table);
    size_t size;
    unsigned char *bytes = slurp(at("whole.exr"), &size);
    for (size_t length = 0; length < size; length++) {
        lq_error error = {""};
        spill(at("cut.exr"), bytes, length);
        lq_status status = lq_table_read_exr(&table, at("cut.exr"), &error);
        if (status != LQ_FORMAT) fail_msg("%zu of %zu bytes: status %d", length, size, (int)status);
        assert_contains(error.text, "accepted");
    }
    free(bytes);
    unlink(at("cut.exr"));
}

/* A flip may leave a valid file (an attribute no one reads), but never a wrong table. */
static void test_flipped_bytes(void **state) {
    (void)state;
    lq_table *table = small_table(), *back;
    size_t size;
    uint64_t seed = 11;
    int refused = 0;
    write_table(table, at("whole.exr"));
    unsigned char *bytes = slurp(at("whole.exr"), &size);
    for (int k = 0; k < 900; k++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        size_t place = (size_t)(seed >> 33) % size;
        unsigned char bits = (unsigned char)(1u << (seed >> 20 & 7)), old = bytes[place];
        bytes[place] = k % 3 ? (unsigned char)(old ^ bits) : (unsigned char)(seed >> 12);
        spill(at("flip.exr"), bytes, size);
        bytes[place] = old;
        if (lq_table_read_exr(&back, at("flip.exr"), NULL)) {
            refused++;
            continue;
        }
        assert_same_table(table, back);
        lq_table_free(back);
    }
    assert_true(refused > 600);
    free(bytes);
    lq_table_free(table);
    unlink(at("flip.exr"));
}

/* Replace the first `from` in the file by `to`, which is as long. */
static void expect_edit_refused(const char *from, const char *to, const char *part) {
    size_t size;
    lq_table *table = small_table();
    write_table(table, at("edit.exr"));
    lq_table_free(table);
    unsigned char *bytes = slurp(at("edit.exr"), &size);
    unsigned char *found = memmem(bytes, size, from, strlen(from));
    assert_non_null(found);
    assert_int_equal(strlen(from), strlen(to));
    memcpy(found, to, strlen(to));
    spill(at("edit.exr"), bytes, size);
    free(bytes);
    expect_refused(at("edit.exr"), LQ_FORMAT, part);
}

static void test_edited_headers(void **state) {
    (void)state;
    expect_edit_refused("lacquer:format", "lacquer:formaT", "no attribute 'lacquer:format'");
    expect_edit_refused("lacquer:axes", "lacquer:axeS", "no attribute 'lacquer:axes'");
    expect_edit_refused("lacquer:facts", "lacquer:factS", "no attribute 'lacquer:facts'");
    expect_edit_refused("lacquer:crc32", "lacquer:crc33", "no attribute 'lacquer:crc32'");
    expect_edit_refused("lacquer:fact-ndf", "lacquer:fact-nfd", "no attribute 'lacquer:fact-ndf'");
    expect_edit_refused("lacquer:channels", "lacquer:channelS", "no attribute 'lacquer:channels'");
    expect_edit_refused("ggx", "gGx", "checksum");
    expect_edit_refused("[\"fgd\"]", "[\"fgf\"]", "not the float channels");
    expect_edit_refused("[\"fgd\"]", "[\"f d\"]", "not plain");
    expect_edit_refused("[\"fgd\"]", "[\"fgd\"!", "not JSON");
    expect_edit_refused("[\"fgd\"]", "{\"f\":1}", "not a JSON array");
    expect_edit_refused("\"size\":9", "\"size\":8", "do not match the axes, 5 x 8");
    expect_edit_refused("\"size\":5", "\"size\":4", "do not match the axes, 4 x 9");
    expect_edit_refused("\"size\":5", "\"size\":0", "of 0 nodes");
    expect_edit_refused("\"size\":5", "\"siZe\":5", "incomplete");
    expect_edit_refused("\"name\":\"mu\"", "\"name\":\"m \"", "not plain");
    expect_edit_refused("\"max\":1.0", "\"max\":0.0", "minimum below");
    expect_edit_refused("\"max\":1.0", "\"max\":2.0", "checksum");
    expect_edit_refused("sqrt", "cube", "unknown map 'cube'");
    expect_edit_refused("linear", "custom", "does not list its 5 nodes");
}

static void test_unknown_version(void **state) {
    (void)state;
    size_t size;
    lq_table *table = small_table();
    write_table(table, at("version.exr"));
    lq_table_free(table);
    unsigned char *bytes = slurp(at("version.exr"), &size);
    unsigned char *found = memmem(bytes, size, "lacquer:format\0string\0\1\0\0\0001", 27);
    assert_non_null(found);
    found[26] = '2';
    spill(at("version.exr"), bytes, size);
    free(bytes);
    expect_refused(at("version.exr"), LQ_FORMAT, "layout version '2' is not known; accepted is version 1");
}

/* ------------------------------------------------------------------ foreign files */

static void silent(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

/* An EXR of W x H values as lacquer would never write it. */
typedef struct foreign {
    exr_storage_t storage;
    exr_pixel_type_t type;
    exr_compression_t compression;
    int parts;
    bool version; /* has lacquer:format */
    const char *axes, *channels;
    int width, height;
} foreign;

/* Without a writer of its own, OpenEXR deletes a file whose rows are not all there. */
static int64_t put_bytes(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                         uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    return pwrite(*(int *)user, bytes, size, (off_t)offset);
}

static void put_chunk(exr_context_t context, int part, const foreign *f, int y) {
    exr_chunk_info_t info;
    unsigned char zeros[4096] = {0};
    size_t size = (size_t)f->width * (f->type == EXR_PIXEL_HALF ? 2 : 4);
    if (f->storage == EXR_STORAGE_TILED) {
        assert_int_equal(exr_write_tile_chunk_info(context, part, 0, 0, 0, 0, &info), 0);
        assert_int_equal(exr_write_tile_chunk(context, part, 0, 0, 0, 0, zeros, 8 * 8 * 4), 0);
    } else {
        assert_int_equal(exr_write_scanline_chunk_info(context, part, y, &info), 0);
        assert_int_equal(exr_write_scanline_chunk(context, part, y, zeros, size), 0);
    }
}

static void add_part(exr_context_t context, const char *name, const foreign *f) {
    int part;
    assert_int_equal(exr_add_part(context, name, f->storage, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(context, part, f->width, f->height, f->compression),
                     0);
    if (f->storage == EXR_STORAGE_TILED)
        assert_int_equal(
            exr_set_tile_descriptor(context, part, 8, 8, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN), 0);
    assert_int_equal(exr_add_channel(context, part, "fgd", f->type, EXR_PERCEPTUALLY_LINEAR, 1, 1), 0);
    if (f->version) assert_int_equal(exr_attr_set_string(context, part, "lacquer:format", "1"), 0);
    if (f->axes) assert_int_equal(exr_attr_set_string(context, part, "lacquer:axes", f->axes), 0);
    if (f->channels) assert_int_equal(exr_attr_set_string(context, part, "lacquer:channels", f->channels), 0);
    assert_int_equal(exr_attr_set_string(context, part, "lacquer:facts", "[]"), 0);
    assert_int_equal(exr_attr_set_string(context, part, "lacquer:crc32", "00000000"), 0);
}

static void expect_foreign_refused(foreign f, const char *cause) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    const char *names[] = {"first", "second"};
    int file = open(at("foreign.exr"), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    assert_true(file >= 0);
    setup.error_handler_fn = silent;
    setup.write_fn = put_bytes;
    setup.user_data = &file;
    assert_int_equal(exr_start_write(&context, at("foreign.exr"), EXR_WRITE_FILE_DIRECTLY, &setup), 0);
    for (int part = 0; part < f.parts; part++) add_part(context, f.parts > 1 ? names[part] : NULL, &f);
    assert_int_equal(exr_write_header(context), 0);
    int rows = f.storage == EXR_STORAGE_TILED ? 1 : f.height > 64 ? 0 : f.height;
    if (f.compression != EXR_COMPRESSION_NONE) rows = 0;
    for (int part = 0; part < f.parts; part++)
        for (int y = 0; y < rows; y++) put_chunk(context, part, &f, y);
    exr_finish(&context);
    close(file);
    expect_refused(at("foreign.exr"), LQ_FORMAT, cause);
}

static void test_foreign_exr(void **state) {
    (void)state;
    const char *axes = "[{\"name\":\"x\",\"size\":8,\"min\":0,\"max\":1,\"map\":\"linear\",\"exponent\":1},"
                       "{\"name\":\"y\",\"size\":8,\"min\":0,\"max\":1,\"map\":\"linear\",\"exponent\":1}]";
    const foreign base = {
        EXR_STORAGE_SCANLINE, EXR_PIXEL_FLOAT, EXR_COMPRESSION_NONE, 1, true, axes, "[\"fgd\"]", 8, 8};
    foreign f = base;
    expect_foreign_refused(f, "checksum"); /* all but that is right */
    f.version = false;
    expect_foreign_refused(f, "no attribute 'lacquer:format'");
    f = base, f.type = EXR_PIXEL_HALF;
    expect_foreign_refused(f, "not the float channels");
    f = base, f.type = EXR_PIXEL_UINT;
    expect_foreign_refused(f, "not the float channels");
    f = base, f.channels = "[\"fgd\",\"other\"]";
    expect_foreign_refused(f, "not the float channels");
    f = base, f.storage = EXR_STORAGE_TILED;
    expect_foreign_refused(f, "tiled");
    f = base, f.parts = 2;
    expect_foreign_refused(f, "multi-part");
    f = base, f.axes = "[]";
    expect_foreign_refused(f, "no axis");
    f = base, f.height = 7;
    expect_foreign_refused(f, "8 x 7 values do not match the axes, 8 x 8");
    f = base, f.compression = EXR_COMPRESSION_PIZ;
    expect_foreign_refused(f, "compression 4; accepted are none, RLE, ZIPS and ZIP");
}

/* 2^40 values claimed by a file of a few hundred bytes: refused before memory is asked for. */
static void test_inflated_size(void **state) {
    (void)state;
    const char *axes =
        "[{\"name\":\"x\",\"size\":1048576,\"min\":0,\"max\":1,\"map\":\"linear\",\"exponent\":1},"
        "{\"name\":\"y\",\"size\":1048576,\"min\":0,\"max\":1,\"map\":\"linear\",\"exponent\":1}]";
    const foreign f = {EXR_STORAGE_SCANLINE,
                       EXR_PIXEL_FLOAT,
                       EXR_COMPRESSION_ZIP,
                       1,
                       true,
                       axes,
                       "[\"fgd\"]",
                       1 << 20,
                       1 << 20};
    expect_foreign_refused(f, "truncated");
}

static void test_not_exr(void **state) {
    (void)state;
    spill(at("text.exr"), "mu,alpha\n0.1,0.2\n", 17);
    expect_refused(at("text.exr"), LQ_FORMAT, "is not an OpenEXR file");
    spill(at("empty.exr"), "", 0);
    expect_refused(at("empty.exr"), LQ_FORMAT, "is not an OpenEXR file");
    spill(at("old.exr"), "\x76\x2f\x31\x01\x01\0\0\0", 8);
    expect_refused(at("old.exr"), LQ_FORMAT, "version 2");
    spill(at("deep.exr"), "\x76\x2f\x31\x01\x02\x08\0\0", 8);
    expect_refused(at("deep.exr"), LQ_FORMAT, "deep");
    spill(at("flags.exr"), "\x76\x2f\x31\x01\x02\x80\0\0", 8);
    expect_refused(at("flags.exr"), LQ_FORMAT, "unknown flags");
    spill(at("head.exr"), "\x76\x2f\x31\x01\x02\0\0\0", 8);
    expect_refused(at("head.exr"), LQ_FORMAT, "truncated or damaged");
    expect_refused(at("missing.exr"), LQ_IO, "No such file");
    expect_refused(folder, LQ_IO, "not a regular file");
    expect_refused("/dev/null", LQ_IO, "not a regular file");
}

/* ------------------------------------------------------------------ failing writes */

static void test_failed_writes_leave_nothing(void **state) {
    (void)state;
    lq_table *table = small_table();
    lq_error error;
    write_table(table, at("kept.exr"));
    int before = files_in_folder();
    assert_int_equal(lq_table_write_exr(table, at("none/x.exr"), &error), LQ_IO);
    assert_contains(error.text, "none' does not exist; accepted");
    assert_int_equal(lq_table_write_exr(table, folder, &error), LQ_IO);
    assert_contains(error.text, "is a folder; accepted");
    assert_int_equal(lq_table_write_exr(table, "/dev/full", &error), LQ_IO);
    assert_contains(error.text, "/dev/full: cannot write: No space left on device; accepted");
    assert_int_equal(lq_table_write_exr(table, "/dev/null", &error), LQ_OK);
    assert_int_equal(files_in_folder(), before);
    lq_table_free(table);
}

/* Damaged files of the tests are left to this. */
static int clear_folder(void **state) {
    DIR *list = opendir(folder);
    if (!list) return -1;
    for (struct dirent *entry; (entry = readdir(list));) unlink(at(entry->d_name));
    closedir(list);
    return remove_folder(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_map_and_axis_count),
        cmocka_unit_test(test_single_nodes),
        cmocka_unit_test(test_channel_order),
        cmocka_unit_test(test_facts),
        cmocka_unit_test(test_odd_values),
        cmocka_unit_test(test_chunk_kinds),
        cmocka_unit_test(test_large_custom_axis),
        cmocka_unit_test(test_bytes_do_not_depend_on_threads),
        cmocka_unit_test(test_every_truncation_is_refused),
        cmocka_unit_test(test_flipped_bytes),
        cmocka_unit_test(test_edited_headers),
        cmocka_unit_test(test_unknown_version),
        cmocka_unit_test(test_foreign_exr),
        cmocka_unit_test(test_inflated_size),
        cmocka_unit_test(test_not_exr),
        cmocka_unit_test(test_failed_writes_leave_nothing),
    };
    return cmocka_run_group_tests(tests, make_folder, clear_folder);
}
