/* published.c - the binary layouts of published renderers: what each stores, its bytes, what is refused.
 *
 * belcour, tm   int32 sizes, float32 (min, max) of each axis, float32 data, all little-endian; no magic, no
 *               version. Nodes are even, ends included.
 * mitsuba       tables/published_mitsuba.c
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/input.h"
#include "system/output.h"
#include "system/status.h"
#include "tables/axis.h"
#include "tables/published.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "numbers are read and written as they lie in memory, which must be little-endian"
#endif

static const char *const layout_names[LQ_LAYOUTS] = {
    [LQ_BELCOUR] = "belcour",
    [LQ_TM] = "tm",
    [LQ_MITSUBA] = "mitsuba",
    [LQ_MITSUBA_INSIDE] = "mitsuba-inside",
};

const char *lq_layout_name(lq_layout layout) {
    return layout < LQ_LAYOUTS ? layout_names[layout] : NULL;
}

static const lq_stored all[] = {
    {LQ_BELCOUR, "fgd", "ggx", NULL, 4, {"mu", "alpha", "n", "kappa"}},
    {LQ_BELCOUR, "tir-pass", "ggx", NULL, 3, {"mu", "alpha", "eta"}},
    {LQ_TM, "fgd", "ggx", NULL, 4, {"mu", "alpha", "n", "kappa"}},
    {LQ_TM, "tir-loss", "ggx", NULL, 3, {"mu", "alpha", "eta"}},
    {LQ_TM, "albedo", "ggx", "separable", 2, {"mu", "alpha"}},
    {LQ_MITSUBA, "transmission", NULL, NULL, 4, {"mu", "alpha", "eta", "tau"}},
    {LQ_MITSUBA_INSIDE, "transmission", NULL, NULL, 4, {"mu", "alpha", "eta", "tau"}},
    {LQ_MITSUBA_INSIDE, "diffuse-transmission", NULL, NULL, 3, {"eta", "alpha", "tau"}},
};
enum { STORED = sizeof all / sizeof all[0] };

static const lq_stored *find(lq_layout layout, const char *kind, lq_error *error) {
    char known[128] = "";
    for (int i = 0; i < STORED; i++) {
        if (all[i].layout != layout) continue;
        if (strcmp(all[i].kind, kind) == 0) return &all[i];
        lq_list_add(known, sizeof known, all[i].kind);
    }
    lq_fail(error, LQ_BAD_INPUT, "layout %s stores no %s; it stores: %s", layout_names[layout], kind, known);
    return NULL;
}

/* ======================================================================================
 *                                      Whole files
 * ====================================================================================== */

static lq_status read_file(lq_bytes *file, const char *path, lq_error *error) {
    char *data;
    *file = (lq_bytes){.data = NULL};
    const lq_status status = lq_input_read(path, &data, &file->size, error);
    if (status == LQ_OK) file->data = (unsigned char *)data;
    return status;
}

bool lq_published_take(lq_bytes *file, void *to, size_t size) {
    if (size > file->size - file->at) return false;
    memcpy(to, file->data + file->at, size);
    file->at += size;
    return true;
}

lq_status lq_published_foreign(const char *path, const lq_stored *what, lq_error *error) {
    return lq_fail(error, LQ_FORMAT, "%s: too short for a %s table of %s", path, layout_names[what->layout],
                   what->kind);
}

/* Sizes come from a stranger: their product is formed only as far as the file could hold it. */
lq_status lq_published_check_length(const lq_bytes *file, const char *path, const lq_stored *what,
                                    const uint64_t *size, int count, uint64_t extra, lq_error *error) {
    uint64_t entries = 1;
    bool fits = true;
    for (int a = 0; a < count; a++) {
        if (size[a] < 2 || size[a] > LQ_MAX_AXIS_SIZE)
            return lq_fail(error, LQ_FORMAT, "%s: not a %s table of %s: an axis of %lld nodes", path,
                           layout_names[what->layout], what->kind, (long long)size[a]);
        fits = fits && entries <= file->size / size[a];
        entries *= fits ? size[a] : 1;
    }
    const uint64_t left = file->size - file->at;
    if (fits && left == sizeof(float) * (entries + extra)) return LQ_OK;
    return lq_fail(error, LQ_FORMAT,
                   "%s: not a %s table of %s: its sizes do not make up its length of %zu bytes", path,
                   layout_names[what->layout], what->kind, file->size);
}

lq_status lq_published_check_range(const char *path, const char *axis, float min, float max,
                                   lq_error *error) {
    if (isfinite(min) && isfinite(max) && min < max) return LQ_OK;
    return lq_fail(error, LQ_FORMAT, "%s: axis %s from %g to %g is not a range", path, axis, (double)min,
                   (double)max);
}

/* ======================================================================================
 *                                    Tables in memory
 * ====================================================================================== */

static lq_status set_facts(lq_table *table, const lq_stored *what, const lq_kind *kind, lq_error *error) {
    const char *const facts[][2] = {
        {"table", what->kind},
        {"title", kind ? kind->title : NULL},
        {"quantity", kind ? kind->quantity : NULL},
        {"source", kind ? kind->source : NULL},
        {"usage", kind ? kind->usage : NULL},
        {"ndf", what->ndf},
        {"masking", what->masking},
        {"layout", layout_names[what->layout]},
    };
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < sizeof facts / sizeof facts[0]; i++)
        if (facts[i][1]) status = lq_table_set_fact(table, facts[i][0], facts[i][1], error);
    return status;
}

/* An empty table over `axes`, if all went well so far; the axes are freed either way. */
lq_status lq_published_make_table(lq_table **table, lq_status status, const lq_stored *what, lq_axis *axes,
                                  lq_error *error) {
    lq_error ignored;
    const lq_kind *kind = lq_kind_find(what->kind, &ignored);
    const char *channel = kind ? kind->channels[0] : what->kind;
    if (status == LQ_OK) status = lq_table_create(table, axes, what->axis_count, &channel, 1, error);
    if (status == LQ_OK) status = set_facts(*table, what, kind, error);
    for (int a = 0; a < what->axis_count; a++) lq_axis_free(&axes[a]);
    return status;
}

/* Where entry `i` of a table, first axis fastest, stands in a file with the last axis fastest. */
static size_t transposed(const lq_axis *axes, int count, size_t i) {
    size_t at = 0;
    size_t index[LQ_MAX_AXES];
    for (int a = 0; a < count; a++) {
        index[a] = i % axes[a].size;
        i /= axes[a].size;
    }
    for (int a = 0; a < count; a++) at = at * axes[a].size + index[a];
    return at;
}

static size_t place(const lq_table *table, lq_layout layout, size_t i) {
    return layout == LQ_TM ? i : transposed(table->axes, table->axis_count, i);
}

/* ======================================================================================
 *                                     belcour and tm
 * ====================================================================================== */

static lq_status read_plain_axes(lq_bytes *file, const char *path, const lq_stored *what, lq_axis *axes,
                                 lq_error *error) {
    int32_t size[4];
    uint64_t wide[4] = {0};
    float range[4][2];
    const size_t count = (size_t)what->axis_count;
    if (!lq_published_take(file, size, count * sizeof size[0]) ||
        !lq_published_take(file, range, count * sizeof range[0]))
        return lq_published_foreign(path, what, error);
    for (size_t a = 0; a < count; a++) wide[a] = (uint64_t)(int64_t)size[a];
    lq_status status = lq_published_check_length(file, path, what, wide, what->axis_count, 0, error);
    for (size_t a = 0; status == LQ_OK && a < count; a++)
        status = lq_published_check_range(path, what->axes[a], range[a][0], range[a][1], error);
    for (size_t a = 0; status == LQ_OK && a < count; a++)
        status = lq_axis_make(&axes[a], what->axes[a], (double)range[a][0], (double)range[a][1], wide[a],
                              LQ_MAP_LINEAR, 0.0, error);
    return status;
}

static lq_status read_plain(lq_table **table, lq_bytes *file, const char *path, const lq_stored *what,
                            lq_error *error) {
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_status status = read_plain_axes(file, path, what, axes, error);
    status = lq_published_make_table(table, status, what, axes, error);
    if (status != LQ_OK) return status;
    const unsigned char *data = file->data + file->at;
    const size_t entries = lq_table_entries(*table);
    for (size_t i = 0; i < entries; i++)
        memcpy((*table)->channels[0] + i, data + sizeof(float) * place(*table, what->layout, i),
               sizeof(float));
    return LQ_OK;
}

/* ======================================================================================
 *                                        The calls
 * ====================================================================================== */

lq_status lq_published_read(lq_table **table, const char *path, lq_layout layout, const char *kind,
                            lq_error *error) {
    *table = NULL;
    const lq_stored *what = find(layout, kind, error);
    if (!what) return LQ_BAD_INPUT;
    lq_bytes file;
    lq_status status = read_file(&file, path, error);
    if (status != LQ_OK) return status;
    status = layout == LQ_BELCOUR || layout == LQ_TM ? read_plain(table, &file, path, what, error)
                                                     : lq_mitsuba_read(table, &file, path, what, error);
    free(file.data);
    if (status != LQ_OK) {
        lq_table_free(*table);
        *table = NULL;
    }
    return status;
}

static lq_status check_axes(const lq_stored *what, const lq_axis *axes, int axis_count, lq_error *error) {
    const char *layout = layout_names[what->layout];
    if (axis_count != what->axis_count)
        return lq_fail(error, LQ_BAD_INPUT, "layout %s stores %s over %d axes, not %d", layout, what->kind,
                       what->axis_count, axis_count);
    for (int a = 0; a < axis_count; a++) {
        if (strcmp(axes[a].name, what->axes[a]) != 0)
            return lq_fail(error, LQ_BAD_INPUT, "axis %d of %s in layout %s is %s, not %s", a + 1, what->kind,
                           layout, what->axes[a], axes[a].name);
        if (axes[a].map != LQ_MAP_LINEAR || axes[a].size < 2)
            return lq_fail(error, LQ_BAD_INPUT,
                           "layout %s stores linear axes of 2 nodes or more; %s has %zu, %s", layout,
                           axes[a].name, axes[a].size, lq_map_name(axes[a].map));
    }
    return LQ_OK;
}

lq_status lq_published_check(lq_layout layout, const char *kind, const char *masking, const lq_axis *axes,
                             int axis_count, lq_error *error) {
    const lq_stored *what = find(layout, kind, error);
    if (!what) return LQ_BAD_INPUT;
    if (layout == LQ_MITSUBA) return lq_mitsuba_check(what, axes, axis_count, error);
    if (layout == LQ_MITSUBA_INSIDE)
        return lq_fail(error, LQ_BAD_INPUT, "layout %s is a part of a file, which is written whole as %s",
                       layout_names[layout], layout_names[LQ_MITSUBA]);
    if (what->masking && (!masking || strcmp(masking, what->masking) != 0))
        return lq_fail(error, LQ_BAD_INPUT, "layout %s stores %s with %s masking, not %s",
                       layout_names[layout], kind, what->masking, masking ? masking : "none");
    return check_axes(what, axes, axis_count, error);
}

static lq_status write_header(const lq_table *table, lq_output *output, lq_error *error) {
    int32_t size[LQ_MAX_AXES];
    float range[LQ_MAX_AXES][2];
    const size_t count = (size_t)table->axis_count;
    for (size_t a = 0; a < count; a++) {
        size[a] = (int32_t)table->axes[a].size;
        range[a][0] = (float)table->axes[a].min;
        range[a][1] = (float)table->axes[a].max;
    }
    const lq_status status = lq_output_write(output, size, count * sizeof size[0], error);
    return status == LQ_OK ? lq_output_write(output, range, count * sizeof range[0], error) : status;
}

static lq_status write_data(const lq_table *table, lq_layout layout, lq_output *output, lq_error *error) {
    const size_t entries = lq_table_entries(table);
    float *data = malloc(entries * sizeof *data);
    if (!data) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu entries", entries);
    for (size_t i = 0; i < entries; i++) data[place(table, layout, i)] = table->channels[0][i];
    const lq_status status = lq_output_write(output, data, entries * sizeof *data, error);
    free(data);
    return status;
}

lq_status lq_published_write(const lq_table *table, const char *path, lq_layout layout, lq_error *error) {
    const char *kind = lq_table_fact(table, "table");
    if (!kind) return lq_fail(error, LQ_BAD_INPUT, "the table does not say of which kind it is");
    lq_status status = lq_published_check(layout, kind, lq_table_fact(table, "masking"), table->axes,
                                          table->axis_count, error);
    if (status == LQ_OK && layout == LQ_MITSUBA)
        status = lq_fail(error, LQ_BAD_INPUT, "layout %s holds three tables: lq_mitsuba_write takes them",
                         layout_names[layout]);
    if (status != LQ_OK) return status;
    lq_output *output;
    status = lq_output_open(&output, path, error);
    if (status != LQ_OK) return status;
    status = write_header(table, output, error);
    if (status == LQ_OK) status = write_data(table, layout, output, error);
    if (status == LQ_OK) return lq_output_commit(output, error);
    lq_output_abandon(output);
    return status;
}
