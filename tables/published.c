/* published.c - the binary layouts of published renderers: what each stores, its bytes, what is refused.
 *
 * belcour, tm   int32 sizes, float32 (min, max) of each axis, float32 data, all little-endian; no magic, no
 *               version. Nodes are even, ends included.
 * mitsuba       17 bytes of magic, u64 n_eta, n_alpha, n_mu, float32 eta and alpha ranges, then two blocks,
 *               outside and inside, each [eta][alpha][mu..., cosine-weighted mean]; axes are warped by t^4.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "tables/axis.h"
#include "tables/output.h"
#include "tables/status.h"

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

/* What a layout stores. */
typedef struct stored {
    lq_layout layout;
    const char *kind;
    const char *masking; /* the only one it is meant for; NULL: any */
    int axis_count;
    const char *axes[4]; /* in the order of the file's header */
} stored;

static const stored all[] = {
    {LQ_BELCOUR, "fgd", NULL, 4, {"mu", "alpha", "n", "kappa"}},
    {LQ_BELCOUR, "tir-pass", NULL, 3, {"mu", "alpha", "eta"}},
    {LQ_TM, "fgd", NULL, 4, {"mu", "alpha", "n", "kappa"}},
    {LQ_TM, "tir-loss", NULL, 3, {"mu", "alpha", "eta"}},
    {LQ_TM, "albedo", "separable", 2, {"mu", "alpha"}},
    {LQ_MITSUBA, "transmission", NULL, 4, {"mu", "alpha", "eta", "tau"}},
    {LQ_MITSUBA_INSIDE, "transmission", NULL, 4, {"mu", "alpha", "eta", "tau"}},
    {LQ_MITSUBA_INSIDE, "diffuse-transmission", NULL, 3, {"eta", "alpha", "tau"}},
};
enum { STORED = sizeof all / sizeof all[0] };

static const stored *find(lq_layout layout, const char *kind, lq_error *error) {
    char known[128] = "";
    for (int i = 0; i < STORED; i++) {
        if (all[i].layout != layout) continue;
        if (strcmp(all[i].kind, kind) == 0) return &all[i];
        const size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", all[i].kind);
    }
    lq_fail(error, LQ_BAD_INPUT, "layout %s stores no %s; it stores: %s", layout_names[layout], kind, known);
    return NULL;
}

/* ======================================================================================
 *                                      Whole files
 * ====================================================================================== */

typedef struct bytes {
    unsigned char *data;
    size_t size, at;
} bytes;

static lq_status read_file(bytes *file, const char *path, lq_error *error) {
    struct stat there;
    *file = (bytes){.data = NULL};
    FILE *in = fopen(path, "rb");
    if (!in) return lq_fail(error, LQ_IO, "cannot read %s: %m", path);
    lq_status status = LQ_OK;
    if (fstat(fileno(in), &there) != 0 || !S_ISREG(there.st_mode))
        status = lq_fail(error, LQ_IO, "cannot read %s: not a regular file", path);
    if (status == LQ_OK) {
        file->size = (size_t)there.st_size;
        file->data = malloc(file->size + 1);
        if (!file->data) status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu bytes", file->size);
    }
    if (status == LQ_OK && fread(file->data, 1, file->size, in) != file->size)
        status = lq_fail(error, LQ_IO, "cannot read %s: it ends early", path);
    fclose(in);
    if (status != LQ_OK) free(file->data);
    return status;
}

static bool take(bytes *file, void *to, size_t size) {
    if (size > file->size - file->at) return false;
    memcpy(to, file->data + file->at, size);
    file->at += size;
    return true;
}

static lq_status foreign(const char *path, const stored *what, lq_error *error) {
    return lq_fail(error, LQ_FORMAT, "%s: too short for a %s table of %s", path, layout_names[what->layout],
                   what->kind);
}

/* Sizes come from a stranger: their product is formed only as far as the file could hold it. */
static lq_status check_length(const bytes *file, const char *path, const stored *what, const uint64_t *size,
                              int count, uint64_t extra, lq_error *error) {
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

static lq_status check_range(const char *path, const char *axis, float min, float max, lq_error *error) {
    if (isfinite(min) && isfinite(max) && min < max) return LQ_OK;
    return lq_fail(error, LQ_FORMAT, "%s: axis %s from %g to %g is not a range", path, axis, (double)min,
                   (double)max);
}

/* ======================================================================================
 *                                    Tables in memory
 * ====================================================================================== */

static lq_status set_facts(lq_table *table, const stored *what, const lq_kind *kind, lq_error *error) {
    const char *const facts[][2] = {
        {"table", what->kind},
        {"title", kind ? kind->title : NULL},
        {"quantity", kind ? kind->quantity : NULL},
        {"source", kind ? kind->source : NULL},
        {"usage", kind ? kind->usage : NULL},
        {"ndf", "ggx"},
        {"masking", what->masking},
        {"layout", layout_names[what->layout]},
    };
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < sizeof facts / sizeof facts[0]; i++)
        if (facts[i][1]) status = lq_table_set_fact(table, facts[i][0], facts[i][1], error);
    return status;
}

/* An empty table over `axes`, if all went well so far; the axes are freed either way. */
static lq_status make_table(lq_table **table, lq_status status, const stored *what, lq_axis *axes,
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

static lq_status read_plain_axes(bytes *file, const char *path, const stored *what, lq_axis *axes,
                                 lq_error *error) {
    int32_t size[4];
    uint64_t wide[4];
    float range[4][2];
    const size_t count = (size_t)what->axis_count;
    if (!take(file, size, count * sizeof size[0]) || !take(file, range, count * sizeof range[0]))
        return foreign(path, what, error);
    for (size_t a = 0; a < count; a++) wide[a] = (uint64_t)(int64_t)size[a];
    lq_status status = check_length(file, path, what, wide, what->axis_count, 0, error);
    for (size_t a = 0; status == LQ_OK && a < count; a++)
        status = check_range(path, what->axes[a], range[a][0], range[a][1], error);
    for (size_t a = 0; status == LQ_OK && a < count; a++)
        status = lq_axis_make(&axes[a], what->axes[a], (double)range[a][0], (double)range[a][1], wide[a],
                              LQ_MAP_LINEAR, 0.0, error);
    return status;
}

static lq_status read_plain(lq_table **table, bytes *file, const char *path, const stored *what,
                            lq_error *error) {
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_status status = read_plain_axes(file, path, what, axes, error);
    status = make_table(table, status, what, axes, error);
    if (status != LQ_OK) return status;
    const unsigned char *data = file->data + file->at;
    const size_t entries = lq_table_entries(*table);
    for (size_t i = 0; i < entries; i++)
        memcpy((*table)->channels[0] + i, data + sizeof(float) * place(*table, what->layout, i),
               sizeof(float));
    return LQ_OK;
}

/* ======================================================================================
 *                                        Mitsuba
 * ====================================================================================== */

static const char magic[] = "MTS_TRANSMITTANCE"; /* 17 bytes without the NUL */
static const double warp = 4.0;

typedef struct mitsuba_header {
    uint64_t eta_count, alpha_count, mu_count;
    float eta_min, eta_max, alpha_min, alpha_max;
} mitsuba_header;

static lq_status read_mitsuba_header(bytes *file, const char *path, const stored *what, mitsuba_header *h,
                                     lq_error *error) {
    char start[sizeof magic - 1];
    uint64_t size[3];
    float range[4];
    if (!take(file, start, sizeof start) || memcmp(start, magic, sizeof start) != 0)
        return lq_fail(error, LQ_FORMAT, "%s: not a Mitsuba transmittance file: no '%s' at its start", path,
                       magic);
    if (!take(file, size, sizeof size) || !take(file, range, sizeof range)) return foreign(path, what, error);
    *h = (mitsuba_header){size[0], size[1], size[2], range[0], range[1], range[2], range[3]};
    /* Two blocks of n_eta n_alpha (n_mu + 1). */
    const bool small = size[0] <= LQ_MAX_AXIS_SIZE && size[1] <= LQ_MAX_AXIS_SIZE;
    const uint64_t rows = small ? size[0] * size[1] : 0, block = size[2] <= LQ_MAX_AXIS_SIZE ? size[2] : 0;
    lq_status status = check_length(file, path, what, size, 3, rows * (block + 2), error);
    if (status == LQ_OK) status = check_range(path, "eta", h->eta_min, h->eta_max, error);
    if (status == LQ_OK) status = check_range(path, "alpha", h->alpha_min, h->alpha_max, error);
    if (status == LQ_OK && !(h->eta_min > 0.0f))
        status = lq_fail(error, LQ_FORMAT, "%s: an index of %g is not positive", path, (double)h->eta_min);
    return status;
}

/* eta of the inside block is 1/eta of the outside one: a custom axis, and the rows in reverse order. */
static lq_status make_inside_eta(lq_axis *axis, const mitsuba_header *h, lq_error *error) {
    lq_axis outside;
    lq_status status = lq_axis_make(&outside, "eta", (double)h->eta_min, (double)h->eta_max, h->eta_count,
                                    LQ_MAP_POWER, warp, error);
    if (status != LQ_OK) return status;
    double *nodes = malloc(h->eta_count * sizeof *nodes);
    if (!nodes) status = lq_fail(error, LQ_NO_MEMORY, "no memory for an axis");
    for (size_t i = 0; nodes && i < h->eta_count; i++) nodes[i] = 1.0 / outside.nodes[h->eta_count - 1 - i];
    if (nodes) status = lq_axis_make_custom(axis, "eta", nodes, h->eta_count, error);
    free(nodes);
    lq_axis_free(&outside);
    return status;
}

static lq_status make_mitsuba_axis(lq_axis *axis, const char *name, const mitsuba_header *h, bool invert,
                                   lq_error *error) {
    if (strcmp(name, "mu") == 0)
        return lq_axis_make(axis, name, 0.0, 1.0, h->mu_count, LQ_MAP_POWER, warp, error);
    if (strcmp(name, "alpha") == 0)
        return lq_axis_make(axis, name, (double)h->alpha_min, (double)h->alpha_max, h->alpha_count,
                            LQ_MAP_POWER, warp, error);
    if (strcmp(name, "tau") == 0) return lq_axis_make(axis, name, 1.0, 1.0, 1, LQ_MAP_LINEAR, 0.0, error);
    if (invert) return make_inside_eta(axis, h, error);
    return lq_axis_make(axis, name, (double)h->eta_min, (double)h->eta_max, h->eta_count, LQ_MAP_POWER, warp,
                        error);
}

/* The file runs [eta][alpha][mu..., mean]. Its first mu is not 0 but a ten-thousandth of the second one. */
static void fill_mitsuba(lq_table *table, const float *block, const mitsuba_header *h, bool invert) {
    const bool diffuse = table->axis_count == 3;
    const size_t row = h->mu_count + 1;
    for (size_t e = 0; e < h->eta_count; e++)
        for (size_t a = 0; a < h->alpha_count; a++) {
            const float *from = block + (e * h->alpha_count + a) * row;
            const size_t to = invert ? h->eta_count - 1 - e : e;
            if (diffuse) table->channels[0][to + h->eta_count * a] = from[h->mu_count];
            else
                memcpy(table->channels[0] + h->mu_count * (a + h->alpha_count * to), from,
                       h->mu_count * sizeof *from);
        }
}

static lq_status read_mitsuba(lq_table **table, bytes *file, const char *path, const stored *what,
                              lq_error *error) {
    mitsuba_header h = {0};
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_status status = read_mitsuba_header(file, path, what, &h, error);
    if (status != LQ_OK) return status;
    const bool inside = what->layout == LQ_MITSUBA_INSIDE, diffuse = what->axis_count == 3;
    const bool invert = inside && !diffuse; /* diffuse-transmission has the index from above on its axis */
    for (int a = 0; status == LQ_OK && a < what->axis_count; a++)
        status = make_mitsuba_axis(&axes[a], what->axes[a], &h, invert, error);
    status = make_table(table, status, what, axes, error);
    if (status != LQ_OK) return status;
    const size_t entries = h.eta_count * h.alpha_count * (h.mu_count + 1);
    float *block = malloc(entries * sizeof *block);
    if (!block) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu entries", entries);
    memcpy(block, file->data + file->at + (inside ? entries * sizeof *block : 0), entries * sizeof *block);
    fill_mitsuba(*table, block, &h, invert);
    free(block);
    return LQ_OK;
}

/* ======================================================================================
 *                                        The calls
 * ====================================================================================== */

lq_status lq_published_read(lq_table **table, const char *path, lq_layout layout, const char *kind,
                            lq_error *error) {
    *table = NULL;
    const stored *what = find(layout, kind, error);
    if (!what) return LQ_BAD_INPUT;
    bytes file;
    lq_status status = read_file(&file, path, error);
    if (status != LQ_OK) return status;
    status = layout == LQ_BELCOUR || layout == LQ_TM ? read_plain(table, &file, path, what, error)
                                                     : read_mitsuba(table, &file, path, what, error);
    free(file.data);
    if (status != LQ_OK) {
        lq_table_free(*table);
        *table = NULL;
    }
    return status;
}

static lq_status check_axes(const stored *what, const lq_axis *axes, int axis_count, lq_error *error) {
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
    const stored *what = find(layout, kind, error);
    if (!what) return LQ_BAD_INPUT;
    if (layout != LQ_BELCOUR && layout != LQ_TM)
        return lq_fail(error, LQ_BAD_INPUT, "layout %s is read only; accepted: belcour, tm",
                       layout_names[layout]);
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
