/* test_npy.c - the bytes of .npy files. */
#define _DEFAULT_SOURCE /* mkdtemp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "lacquer.h"

static char folder[] = "/tmp/lacquer-test-npy-XXXXXX";

static const char *target(void) {
    static char path[64];
    snprintf(path, sizeof path, "%s/t.npy", folder);
    return path;
}

static lq_table *make_table(const size_t *sizes, int axis_count, int channel_count) {
    const char *names[] = {"p", "q", "r", "s"}, *channels[] = {"a", "b", "c"};
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_table *table;
    for (int i = 0; i < axis_count; i++)
        assert_int_equal(lq_axis_make(&axes[i], names[i], 0, sizes[i] > 1, sizes[i], LQ_MAP_LINEAR, 0, NULL),
                         LQ_OK);
    assert_int_equal(lq_table_create(&table, axes, axis_count, channels, channel_count, NULL), LQ_OK);
    for (int i = 0; i < axis_count; i++) lq_axis_free(&axes[i]);
    for (int c = 0; c < channel_count; c++)
        for (size_t k = 0; k < lq_table_entries(table); k++)
            table->channels[c][k] = (float)k + 0.25f * (float)c;
    return table;
}

static void check_file(const size_t *sizes, int axis_count, int channel_count, const char *shape) {
    lq_table *table = make_table(sizes, axis_count, channel_count);
    size_t entries = lq_table_entries(table), channels = (size_t)channel_count;
    lq_error error;
    if (lq_table_write_npy(table, target(), &error)) fail_msg("%s", error.text);
    lq_table_free(table);

    unsigned char head[256];
    FILE *file = fopen(target(), "rb");
    assert_non_null(file);
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    assert_memory_equal(head, "\x93NUMPY\x01\x00", 8);
    assert_int_equal(10 + head[8] + 256 * head[9], 256); /* a multiple of 64 */
    char expected[247];
    int used =
        snprintf(expected, sizeof expected, "{'descr': '<f4', 'fortran_order': False, 'shape': %s, }", shape);
    assert_memory_equal(head + 10, expected, (size_t)used);
    for (size_t i = 10 + (size_t)used; i < 255; i++) assert_int_equal(head[i], ' ');
    assert_int_equal(head[255], '\n');

    for (size_t k = 0; k < entries * channels; k++) {
        float value;
        assert_int_equal(fread(&value, sizeof value, 1, file), 1);
        assert_true(value == (float)(k / channels) + 0.25f * (float)(k % channels));
    }
    assert_int_equal(fgetc(file), EOF);
    fclose(file);
}

static void test_shapes(void **state) {
    (void)state;
    const size_t sizes[] = {5, 3, 2, 7}, one[] = {1}, large[] = {100, 91};
    check_file(sizes, 1, 1, "(5, )");
    check_file(sizes, 2, 1, "(3, 5, )");
    check_file(sizes, 4, 1, "(7, 2, 3, 5, )");
    check_file(sizes, 4, 2, "(7, 2, 3, 5, 2, )");
    check_file(one, 1, 3, "(1, 3, )");
    check_file(large, 2, 3, "(91, 100, 3, )"); /* more than one batch */
}

/* NumPy reads it, where there is one. */
static void test_numpy_agrees(void **state) {
    (void)state;
    const size_t sizes[] = {5, 3, 2};
    char command[512];
    if (system("python3 -c 'import numpy' 2>/dev/null") != 0) skip();
    lq_table *table = make_table(sizes, 3, 2);
    assert_int_equal(lq_table_write_npy(table, target(), NULL), LQ_OK);
    snprintf(command, sizeof command,
             "python3 -c \"import numpy; a = numpy.load('%s'); assert a.shape == (2, 3, 5, 2); "
             "assert a[1, 2, 4, 1] == %g\"",
             target(), (double)table->channels[1][4 + 5 * (2 + 3 * 1)]);
    lq_table_free(table);
    assert_int_equal(system(command), 0);
}

static void test_failures(void **state) {
    (void)state;
    const size_t sizes[] = {50, 50};
    lq_error error;
    for (int channels = 1; channels <= 2; channels++) {
        lq_table *table = make_table(sizes, 2, channels);
        assert_int_equal(lq_table_write_npy(table, "/dev/full", &error), LQ_IO);
        assert_non_null(strstr(error.text, "/dev/full: cannot write: No space left"));
        assert_int_equal(lq_table_write_npy(table, "/nowhere/t.npy", &error), LQ_IO);
        assert_non_null(strstr(error.text, "'/nowhere' does not exist"));
        assert_int_equal(lq_table_write_npy(table, folder, NULL), LQ_IO);
        lq_table_free(table);
    }
}

static int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
    (void)state;
    unlink(target());
    return rmdir(folder); /* fails where anything else was left */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_numpy_agrees),
        cmocka_unit_test(test_failures),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
