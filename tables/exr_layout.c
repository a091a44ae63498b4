/* exr_layout.c - the attributes of an EXR table as text, and the checksum over the whole of it. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "tables/exr_layout.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "system/json.h"
#include "system/status.h"
#include "tables/axis.h"

/* ------------------------------------------------------------------ to JSON */

/* 17 significant digits bring every double back bit for bit. */
enum { EXACT = JSON_COMPACT | JSON_REAL_PRECISION(17) };

static json_t *nodes_to_json(const lq_axis *axis) {
    json_t *array = json_array();
    for (size_t i = 0; array && i < axis->size; i++) lq_json_append(&array, lq_json_number(axis->nodes[i]));
    return array;
}

json_t *lq_axis_to_json(const lq_axis *axis) {
    json_t *json =
        json_pack("{s:s, s:I, s:f, s:f, s:s, s:f}", "name", axis->name, "size", (json_int_t)axis->size, "min",
                  axis->min, "max", axis->max, "map", lq_map_name(axis->map), "exponent", axis->exponent);
    if (axis->map == LQ_MAP_CUSTOM) lq_json_set(&json, "nodes", nodes_to_json(axis));
    return json;
}

/* The array of `count` texts made by `item`. */
static char *array_text(const lq_table *table, size_t count, json_t *(*item)(const lq_table *, size_t)) {
    json_t *array = json_array();
    for (size_t i = 0; array && i < count; i++) lq_json_append(&array, item(table, i));
    return lq_json_dump(array, EXACT);
}

static json_t *axis_item(const lq_table *table, size_t i) {
    return lq_axis_to_json(&table->axes[i]);
}

static json_t *channel_item(const lq_table *table, size_t i) {
    return json_string(table->channel_names[i]);
}

static json_t *fact_item(const lq_table *table, size_t i) {
    return json_string(table->facts[i].key);
}

char *lq_exr_axes_text(const lq_table *table) {
    return array_text(table, (size_t)table->axis_count, axis_item);
}

char *lq_exr_channels_text(const lq_table *table) {
    return array_text(table, (size_t)table->channel_count, channel_item);
}

char *lq_exr_facts_text(const lq_table *table) {
    return array_text(table, table->fact_count, fact_item);
}

/* ------------------------------------------------------------------ from JSON */

static lq_status parse_array(json_t **array, const char *text, const char *what, size_t limit,
                             lq_error *error) {
    const lq_status status = lq_json_parse(array, what, text, strlen(text), error);
    if (status || (json_is_array(*array) && json_array_size(*array) <= limit)) return status;
    json_decref(*array);
    *array = NULL;
    return lq_fail(error, LQ_FORMAT, "%s: not a JSON array of at most %zu", what, limit);
}

static lq_status parse_nodes(lq_axis *axis, const char *name, json_int_t size, const json_t *array,
                             lq_error *error) {
    size_t count = json_array_size(array); /* 0 where it is no array */
    if (count < 1 || count > LQ_MAX_AXIS_SIZE || (json_int_t)count != size)
        return lq_fail(error, LQ_FORMAT, "axis '%.40s' is custom but does not list its %lld nodes", name,
                       (long long)size);
    double *nodes = malloc(count * sizeof *nodes);
    if (!nodes) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu nodes", count);
    lq_status status = LQ_OK;
    for (size_t i = 0; i < count && status == LQ_OK; i++) {
        const json_t *node = json_array_get(array, i);
        nodes[i] = json_number_value(node);
        if (!json_is_number(node))
            status = lq_fail(error, LQ_FORMAT, "axis '%.40s': node %zu is not a number", name, i);
    }
    if (status == LQ_OK) status = lq_axis_make_custom(axis, name, nodes, count, error);
    free(nodes);
    return status;
}

lq_status lq_axis_from_json(json_t *json, size_t most, lq_axis *axis, lq_error *error) {
    const char *name, *map_name;
    json_int_t size;
    double min, max, exponent;
    json_t *nodes = NULL;
    lq_map map;
    json_error_t cause;
    if (json_unpack_ex(json, &cause, 0, "{s:s, s:I, s:F, s:F, s:s, s:F, s?o}", "name", &name, "size", &size,
                       "min", &min, "max", &max, "map", &map_name, "exponent", &exponent, "nodes", &nodes))
        return lq_fail(error, LQ_FORMAT, "an axis is incomplete (%s)", cause.text);
    if (!lq_map_find(map_name, &map))
        return lq_fail(error, LQ_FORMAT, "axis '%.40s' has the unknown map '%.40s'", name, map_name);
    if (size < 1 || size > LQ_MAX_AXIS_SIZE)
        return lq_fail(error, LQ_FORMAT, "axis '%.40s' of %lld nodes", name, (long long)size);
    if ((size_t)size > most)
        return lq_fail(error, LQ_FORMAT, "axis '%.40s' of %lld nodes; there is room for %zu at most", name,
                       (long long)size, most);
    if (map == LQ_MAP_CUSTOM) return parse_nodes(axis, name, size, nodes, error);
    return lq_axis_make(axis, name, min, max, (size_t)size, map, exponent, error);
}

lq_status lq_exr_parse_axes(const char *text, size_t most, lq_axis *axes, int *count, lq_error *error) {
    *count = 0;
    json_t *array;
    lq_status status = parse_array(&array, text, "axes", LQ_MAX_AXES, error);
    if (status) return status;
    size_t size = json_array_size(array);
    while ((size_t)*count < size && status == LQ_OK) {
        lq_axis *axis = &axes[*count];
        status = lq_axis_from_json(json_array_get(array, (size_t)*count), most, axis, error);
        if (status != LQ_OK) break;
        most /= axis->size; /* at least 1 node fits */
        most = most > 0 ? most : 1;
        ++*count;
    }
    json_decref(array);
    if (status == LQ_OK) return LQ_OK;
    while (*count > 0) lq_axis_free(&axes[--*count]);
    return status == LQ_NO_MEMORY ? status : LQ_FORMAT; /* what an axis refuses is damage in a file */
}

lq_status lq_exr_parse_names(const char *text, size_t limit, char ***names, size_t *count, lq_error *error) {
    *count = 0;
    *names = NULL;
    json_t *array;
    lq_status status = parse_array(&array, text, "names", limit, error);
    if (status) return status;
    size_t size = json_array_size(array);
    *names = calloc(size + 1, sizeof **names);
    if (!*names) status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu names", size);
    while (*count < size && status == LQ_OK) {
        const char *name = json_string_value(json_array_get(array, *count));
        if (lq_name_check("stored", name, error)) status = LQ_FORMAT;
        else if (!((*names)[(*count)++] = strdup(name)))
            status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu names", size);
    }
    json_decref(array);
    if (status) lq_exr_free_names(*names, *count);
    if (status) *names = NULL;
    return status;
}

void lq_exr_free_names(char **names, size_t count) {
    for (size_t i = 0; names && i < count; i++) free(names[i]);
    free(names);
}

/* ------------------------------------------------------------------ checksum */

/* Bytes summed by one thread at a time: some 0.5 ms, so that the cores share the work evenly. */
enum { BLOCK = 1 << 20 };

static uint32_t sum_text(uint32_t sum, const char *text) {
    return (uint32_t)crc32_z(sum, (const Bytef *)text, strlen(text) + 1);
}

/* Blocks are summed by any thread and joined in order. */
static lq_status sum_channel(const float *data, size_t bytes, uint32_t *sum, lq_error *error) {
    size_t blocks = (bytes + BLOCK - 1) / BLOCK;
    uint32_t *sums = malloc(blocks * sizeof *sums);
    if (!sums) return lq_fail(error, LQ_NO_MEMORY, "no memory for a checksum");
    const Bytef *start = (const Bytef *)data;
#pragma omp parallel for schedule(static) if (bytes >= LQ_EXR_PARALLEL * sizeof(float))
    for (size_t i = 0; i < blocks; i++) {
        size_t length = i + 1 < blocks ? BLOCK : bytes - i * BLOCK;
        sums[i] = (uint32_t)crc32_z(0, start + i * BLOCK, length);
    }
    *sum = 0;
    for (size_t i = 0; i < blocks; i++) {
        size_t length = i + 1 < blocks ? BLOCK : bytes - i * BLOCK;
        *sum = (uint32_t)crc32_combine(*sum, sums[i], (z_off_t)length);
    }
    free(sums);
    return LQ_OK;
}

lq_status lq_exr_checksum_join(const lq_table *shape, const uint32_t *of_channels, uint32_t *sum,
                               lq_error *error) {
    char *axes = lq_exr_axes_text(shape);
    if (!axes) return lq_fail(error, LQ_NO_MEMORY, "no memory for the axes");
    *sum = sum_text(0, axes);
    free(axes);
    for (size_t i = 0; i < shape->fact_count; i++) {
        *sum = sum_text(*sum, shape->facts[i].key);
        *sum = sum_text(*sum, shape->facts[i].value);
    }
    for (int c = 0; c < shape->channel_count; c++) {
        *sum = sum_text(*sum, shape->channel_names[c]);
        *sum =
            (uint32_t)crc32_combine(*sum, of_channels[c], (z_off_t)(lq_table_entries(shape) * sizeof(float)));
    }
    return LQ_OK;
}

lq_status lq_exr_checksum(const lq_table *table, uint32_t *sum, lq_error *error) {
    uint32_t of_channels[LQ_MAX_CHANNELS];
    lq_status status = LQ_OK;
    for (int c = 0; c < table->channel_count && status == LQ_OK; c++)
        status =
            sum_channel(table->channels[c], lq_table_entries(table) * sizeof(float), &of_channels[c], error);
    return status == LQ_OK ? lq_exr_checksum_join(table, of_channels, sum, error) : status;
}
