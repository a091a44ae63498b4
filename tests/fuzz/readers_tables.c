/* readers_tables.c - tables, factors, published layouts, foreign files and their descriptions. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "pca/factors_json.h"
#include "tables/raw.h"

void fuzz_table(const uint8_t *bytes, size_t size) {
    lq_error error = {""};
    lq_table *table;
    if (lq_table_read_exr(&table, fuzz_file("table.exr", bytes, size), &error) == LQ_OK) lq_table_free(table);
}

/* What is accepted can be looked up. */
static void look_up(const lq_factored *factored) {
    double point[LQ_MAX_AXES];
    for (int end = 0; end < 2; end++) {
        for (int a = 0; a < factored->axis_count; a++)
            point[a] = end ? factored->axes[a].max : factored->axes[a].min;
        lq_factored_lookup_gpu(factored, point);
    }
}

void fuzz_factors(const uint8_t *bytes, size_t size) {
    lq_error error = {""};
    lq_factored *factored;
    if (lq_factored_read(&factored, fuzz_file("factors.exr", bytes, size), &error) != LQ_OK) return;
    look_up(factored);
    lq_factored_free(factored);
}

/* The JSON of factors, which stands in their file behind a checksum. */
void fuzz_structure(const uint8_t *bytes, size_t size) {
    lq_error error = {""};
    lq_factored *factored = calloc(1, sizeof *factored);
    char *text = fuzz_text(bytes, size);
    if (lq_factored_from_json(text, 1 << 16, factored, &error) == LQ_OK) lq_factored_bytes(factored);
    lq_factored_free(factored);
    free(text);
}

static void read_raw(const char *path, const char *const *channels, int count) {
    lq_error error = {""};
    lq_raw raw;
    lq_raw_read(&raw, path, channels, count, &error);
    lq_raw_free(&raw);
}

void fuzz_foreign_exr(const uint8_t *bytes, size_t size) {
    static const char *const names[] = {"R", "G", "B", "A"};
    const char *path = fuzz_file("foreign.exr", bytes, size);
    read_raw(path, NULL, 1);
    read_raw(path, names, 4);
}

void fuzz_npy(const uint8_t *bytes, size_t size) {
    read_raw(fuzz_file("values.npy", bytes, size), NULL, 1);
}

void fuzz_c_array(const uint8_t *bytes, size_t size) {
    read_raw(fuzz_file("values.h", bytes, size), NULL, 1);
}

static void read_published(const char *path, lq_layout layout, const char *kind) {
    lq_error error = {""};
    lq_table *table;
    if (lq_published_read(&table, path, layout, kind, &error) == LQ_OK) lq_table_free(table);
}

void fuzz_bin(const uint8_t *bytes, size_t size) {
    const char *path = fuzz_file("table.bin", bytes, size);
    read_published(path, LQ_BELCOUR, "fgd");
    read_published(path, LQ_BELCOUR, "tir-pass");
    read_published(path, LQ_TM, "tir-loss");
    read_published(path, LQ_TM, "albedo");
}

void fuzz_dat(const uint8_t *bytes, size_t size) {
    const char *path = fuzz_file("table.dat", bytes, size);
    read_published(path, LQ_MITSUBA, "transmission");
    read_published(path, LQ_MITSUBA_INSIDE, "transmission");
    read_published(path, LQ_MITSUBA_INSIDE, "diffuse-transmission");
}

/* A description, a zero byte, the numbers. */
void fuzz_axes(const uint8_t *bytes, size_t size) {
    const uint8_t *end = memchr(bytes, 0, size);
    const size_t length = end ? (size_t)(end - bytes) : size;
    const char *description = fuzz_file("axes.json", bytes, length);
    const char *values = fuzz_file("values.h", bytes + length, 0);
    lq_error error = {""};
    lq_table *table;
    if (end) values = fuzz_file("values.h", end + 1, size - length - 1);
    if (lq_table_read_described(&table, values, description, &error) == LQ_OK) lq_table_free(table);
}
