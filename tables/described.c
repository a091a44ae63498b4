/* described.c - tables of anybody's: bare numbers and a JSON text that says what they are (docs/foreign.md).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/json.h"
#include "system/number.h"
#include "system/status.h"
#include "tables/axis.h"
#include "tables/raw.h"

typedef struct description {
    const char *path; /* of the JSON text */
    json_t *root;
    const lq_kind *kind;
    int axis_count;
    lq_axis axes[LQ_MAX_AXES]; /* in the order of the kind */
    int in_file[LQ_MAX_AXES];  /* for each axis of the file, slowest first: which one of the kind */
    int file_axes;
    int components;                 /* values an entry */
    int component[LQ_MAX_CHANNELS]; /* of each channel of the kind */
    const char *exr_channels[LQ_MAX_CHANNELS];
    bool has_exr_channels;
} description;

static lq_status load(description *d, lq_error *error) {
    const lq_status status = lq_json_read(&d->root, d->path, error);
    if (status) return status;
    const char *id = json_string_value(json_object_get(d->root, "table"));
    if (!id) return lq_fail(error, LQ_BAD_INPUT, "%s: \"table\" is missing: an id of lacquer list", d->path);
    lq_error unknown = {""};
    d->kind = lq_kind_find(id, &unknown);
    return d->kind ? LQ_OK : lq_fail(error, LQ_BAD_INPUT, "%s: %s", d->path, unknown.text);
}

/* ======================================================================================
 *                                         Axes
 * ====================================================================================== */

static int find_axis(const lq_kind *kind, const char *name) {
    for (int a = 0; name && a < kind->axis_count; a++)
        if (strcmp(kind->axes[a].name, name) == 0) return a;
    return -1;
}

/* Where along [0,1] node i of n was sampled. */
static bool sampled_at(const char *sampling, size_t i, size_t n, double *u) {
    const double at = (double)i, all = (double)n;
    if (!sampling || strcmp(sampling, "ends") == 0) *u = n > 1 ? at / (all - 1.0) : 0.0;
    else if (strcmp(sampling, "centres") == 0) *u = (at + 0.5) / all;
    else if (strcmp(sampling, "starts") == 0) *u = at / all;
    else return false;
    return true;
}

/* "min:max:n:map" with a sampling other than the ends: the nodes one by one. */
static lq_status resample(lq_axis *axis, const char *sampling, lq_error *error) {
    double *nodes = malloc(axis->size * sizeof *nodes);
    if (!nodes) return lq_fail(error, LQ_NO_MEMORY, "no memory for an axis");
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < axis->size; i++) {
        double u;
        if (sampled_at(sampling, i, axis->size, &u))
            nodes[i] = axis->min + (axis->max - axis->min) * pow(u, axis->exponent);
        else
            status =
                lq_fail(error, LQ_BAD_INPUT, "sampling '%.40s'; accepted: ends, centres, starts", sampling);
    }
    lq_axis there = {.size = 0};
    if (status == LQ_OK) status = lq_axis_make_custom(&there, axis->name, nodes, axis->size, error);
    free(nodes);
    if (status != LQ_OK) return status;
    lq_axis_free(axis);
    *axis = there;
    return LQ_OK;
}

static lq_status make_axis(lq_axis *axis, const char *name, const json_t *json, size_t most,
                           lq_error *error) {
    const json_t *value = json_object_get(json, "value");
    const char *nodes = json_string_value(json_object_get(json, "nodes"));
    const json_t *sampling = json_object_get(json, "sampling");
    if (json_is_number(value)) {
        const double at = json_number_value(value);
        return lq_axis_make(axis, name, at, at, 1, LQ_MAP_LINEAR, 0.0, error);
    }
    if (!nodes)
        return lq_fail(error, LQ_BAD_INPUT,
                       "axis %s has neither \"value\" (a number) nor \"nodes\" (\"0:1:64\")", name);
    if (sampling && !json_is_string(sampling))
        return lq_fail(error, LQ_BAD_INPUT, "axis %s: \"sampling\" is not ends, centres or starts", name);
    lq_status status = lq_axis_parse_within(axis, name, nodes, most, error);
    if (status == LQ_OK && sampling && axis->map != LQ_MAP_CUSTOM && axis->size > 1)
        status = resample(axis, json_string_value(sampling), error);
    return status;
}

static lq_status take_axis(description *d, const json_t *json, size_t most, lq_error *error) {
    const char *name = json_string_value(json_object_get(json, "name"));
    const int a = find_axis(d->kind, name);
    if (a < 0)
        return lq_fail(error, LQ_BAD_INPUT, "%s: an axis '%.40s', which %s has not", d->path,
                       name ? name : "?", d->kind->id);
    if (d->axes[a].nodes) return lq_fail(error, LQ_BAD_INPUT, "%s: axis %s is there twice", d->path, name);
    lq_error cause = {""};
    const lq_status status = make_axis(&d->axes[a], name, json, most, &cause);
    if (status != LQ_OK) return lq_fail(error, LQ_BAD_INPUT, "%s: %s", d->path, cause.text);
    if (!json_object_get(json, "value")) d->in_file[d->file_axes++] = a;
    return LQ_OK;
}

/* No axis has more nodes than the file has entries. */
static lq_status take_axes(description *d, size_t entries, lq_error *error) {
    const json_t *list = json_object_get(d->root, "axes");
    if (!json_is_array(list))
        return lq_fail(error, LQ_BAD_INPUT, "%s: \"axes\" is missing: a list, slowest axis first", d->path);
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < json_array_size(list); i++)
        status = take_axis(d, json_array_get(list, i), entries, error);
    for (int a = 0; status == LQ_OK && a < d->kind->axis_count; a++)
        if (!d->axes[a].nodes)
            status = lq_fail(error, LQ_BAD_INPUT, "%s: axis %s is missing; give it nodes or a value", d->path,
                             d->kind->axes[a].name);
    return status;
}

/* ======================================================================================
 *                                    Components, facts
 * ====================================================================================== */

/* "components": what each value of an entry is: channel names of the kind, "" for one to be left out. */
static lq_status take_components(description *d, lq_error *error) {
    const json_t *list = json_object_get(d->root, "components"),
                 *exr = json_object_get(d->root, "exr_channels");
    d->components = json_is_array(list) ? (int)json_array_size(list) : d->kind->channel_count;
    for (int c = 0; c < d->kind->channel_count; c++) {
        d->component[c] = json_is_array(list) ? -1 : c;
        for (int k = 0; json_is_array(list) && k < d->components; k++) {
            const char *name = json_string_value(json_array_get(list, (size_t)k));
            if (name && strcmp(name, d->kind->channels[c]) == 0) d->component[c] = k;
        }
        if (d->component[c] < 0)
            return lq_fail(error, LQ_BAD_INPUT, "%s: no component is %s", d->path, d->kind->channels[c]);
    }
    if (!exr) return LQ_OK;
    if (!json_is_array(exr) || (int)json_array_size(exr) != d->components || d->components > LQ_MAX_CHANNELS)
        return lq_fail(error, LQ_BAD_INPUT, "%s: \"exr_channels\" does not name %d channels", d->path,
                       d->components);
    d->has_exr_channels = true;
    for (int k = 0; k < d->components; k++) {
        d->exr_channels[k] = json_string_value(json_array_get(exr, (size_t)k));
        if (!d->exr_channels[k])
            return lq_fail(error, LQ_BAD_INPUT, "%s: \"exr_channels\" holds something else than names",
                           d->path);
    }
    return LQ_OK;
}

static lq_status set_facts(const description *d, lq_table *table, lq_error *error) {
    static const char *const keys[][2] = {
        {"ndf", "ggx"}, {"scattering", "multiple"}, {"masking", "correlated"}, {"tolerance", NULL}};
    char tolerance[32];
    const json_t *stated = json_object_get(d->root, "tolerance");
    lq_print(tolerance, sizeof tolerance, "%g",
             json_is_number(stated) ? json_number_value(stated) : d->kind->tolerance);
    lq_status status = lq_table_set_fact(table, "table", d->kind->id, error);
    for (size_t i = 0; status == LQ_OK && i < sizeof keys / sizeof keys[0]; i++) {
        const char *value = json_string_value(json_object_get(d->root, keys[i][0]));
        if (!value) value = keys[i][1] ? keys[i][1] : tolerance;
        if (i == 1 && !(d->kind->takes & LQ_TAKES_SCATTERING)) continue;
        if (i == 2 && !(d->kind->takes & LQ_TAKES_MASKING)) continue;
        status = lq_table_set_fact(table, keys[i][0], value, error);
    }
    return status;
}

/* A key that is not understood may be what makes all the difference. */
static lq_status check_keys(const description *d, lq_error *error) {
    static const char known[] = " table ndf scattering masking tolerance axes components exr_channels ";
    const char *key;
    json_t *value;
    json_object_foreach(d->root, key, value) {
        char word[64];
        snprintf(word, sizeof word, " %.60s ", key);
        if (!strstr(known, word))
            return lq_fail(error, LQ_BAD_INPUT, "%s: unknown key '%.40s'; accepted:%s", d->path, key, known);
    }
    return LQ_OK;
}

/* ======================================================================================
 *                                         Data
 * ====================================================================================== */

/* Entry by entry in the order of the file, to where the table has it. */
static void fill(const description *d, const lq_raw *raw, lq_table *table) {
    const size_t entries = lq_table_entries(table), components = (size_t)d->components;
    for (size_t i = 0; i < entries; i++) {
        size_t rest = i, at = 0;
        for (int f = d->file_axes - 1; f >= 0; f--) {
            const int a = d->in_file[f];
            size_t stride = 1;
            for (int k = 0; k < a; k++) stride *= d->axes[k].size;
            at += stride * (rest % d->axes[a].size);
            rest /= d->axes[a].size;
        }
        for (int c = 0; c < table->channel_count; c++)
            table->channels[c][at] = raw->values[i * components + (size_t)d->component[c]];
    }
}

/* Before there is memory for the entries that the description makes up. */
static lq_status check_count(const description *d, const lq_raw *raw, const char *path, lq_error *error) {
    double entries = 1.0; /* may be 2^120 */
    for (int a = 0; a < d->kind->axis_count; a++) entries *= (double)d->axes[a].size;
    if ((double)raw->count == entries * d->components) return LQ_OK;
    return lq_fail(error, LQ_FORMAT, "%s holds %zu values; its description makes up %.0f x %d", path,
                   raw->count, entries, d->components);
}

static lq_status assemble(description *d, const char *path, lq_table **table, lq_error *error) {
    lq_raw raw;
    lq_status status =
        lq_raw_read(&raw, path, d->has_exr_channels ? d->exr_channels : NULL, d->components, error);
    if (status != LQ_OK) return status;
    enum { FEW = 4096 }; /* so many are refused by their product, which says more */
    status = take_axes(d, raw.count > FEW ? raw.count : FEW, error);
    if (status == LQ_OK) status = check_count(d, &raw, path, error);
    if (status == LQ_OK)
        status = lq_table_create(table, d->axes, d->kind->axis_count, d->kind->channels,
                                 d->kind->channel_count, error);
    if (status == LQ_OK) fill(d, &raw, *table);
    if (status == LQ_OK) status = set_facts(d, *table, error);
    lq_raw_free(&raw);
    return status;
}

lq_status lq_table_read_described(lq_table **table, const char *path, const char *description_path,
                                  lq_error *error) {
    description d = {.path = description_path};
    *table = NULL;
    lq_status status = load(&d, error);
    if (status == LQ_OK) status = check_keys(&d, error);
    if (status == LQ_OK) status = take_components(&d, error);
    if (status == LQ_OK) status = assemble(&d, path, table, error);
    if (status != LQ_OK) {
        lq_table_free(*table);
        *table = NULL;
    }
    for (int a = 0; a < LQ_MAX_AXES; a++) lq_axis_free(&d.axes[a]);
    json_decref(d.root);
    return status;
}
