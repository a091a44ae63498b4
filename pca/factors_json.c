/* factors_json.c - the structure of a factored table as JSON text, and back. */
#include "pca/factors_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "system/json.h"
#include "system/status.h"
#include "tables/exr_layout.h"

/* More than any useful factorisation, far below where sizes overflow. */
enum { BASES_MAX = 4096, TERMS_MAX = 65536, TEXELS_MAX = 1 << 24 };

/* ------------------------------------------------------------------ to JSON */

static json_t *numbers(const double *values, int count) {
    json_t *array = json_array();
    for (int i = 0; array && i < count; i++) lq_json_append(&array, lq_json_number(values[i]));
    return array;
}

static json_t *factor_to_json(const lq_factor *factor) {
    json_t *axes = json_array();
    for (int a = 0; axes && a < factor->axis_count; a++) {
        const lq_texture_axis *axis = &factor->axes[a];
        lq_json_append(&axes, json_pack("{s:s, s:i, s:i, s:o}", "coordinate",
                                        lq_coordinate_name(axis->coordinate), "axis", axis->axis, "other",
                                        axis->other, "texels", lq_axis_to_json(&axis->texels)));
    }
    return json_pack("{s:I, s:o}", "bases", (json_int_t)factor->base_count, "axes", axes);
}

static json_t *sum_to_json(const lq_term_sum *sum) {
    json_t *factors = json_array(), *index = json_array();
    for (int g = 0; factors && g < sum->factor_count; g++)
        lq_json_append(&factors, json_integer(sum->factors[g]));
    for (size_t i = 0; index && i < sum->term_count * (size_t)sum->factor_count; i++)
        lq_json_append(&index, json_integer(sum->index[i]));
    return json_pack("{s:o, s:o}", "factors", factors, "index", index);
}

static json_t *piece_to_json(const lq_piece *piece, int axis_count) {
    json_t *factors = json_array(), *streams = json_array();
    for (int f = 0; factors && f < piece->factor_count; f++)
        lq_json_append(&factors, factor_to_json(&piece->factors[f]));
    for (int k = 0; streams && k < piece->stream_count; k++)
        lq_json_append(&streams, sum_to_json(&piece->streams[k]));
    return json_pack("{s:o, s:o, s:s, s:i, s:o, s:o}", "min", numbers(piece->min, axis_count), "max",
                     numbers(piece->max, axis_count), "value", lq_value_name(piece->value), "value_axis",
                     piece->value_axis, "factors", factors, "streams", streams);
}

char *lq_factored_to_json(const lq_factored *factored) {
    json_t *axes = json_array(), *pieces = json_array();
    for (int a = 0; axes && a < factored->axis_count; a++)
        lq_json_append(&axes, json_pack("{s:s, s:f, s:f}", "name", factored->axes[a].name, "min",
                                        factored->axes[a].min, "max", factored->axes[a].max));
    for (int p = 0; pieces && p < factored->piece_count; p++)
        lq_json_append(&pieces, piece_to_json(&factored->pieces[p], factored->axis_count));
    json_t *all = json_pack("{s:o, s:f, s:f, s:o}", "axes", axes, "value_min", factored->value_min,
                            "value_max", factored->value_max, "pieces", pieces);
    return lq_json_dump(all, JSON_COMPACT | JSON_REAL_PRECISION(17));
}

/* ------------------------------------------------------------------ from JSON */

static lq_status wrong(const char *what, const char *cause, lq_error *error) {
    return lq_fail(error, LQ_FORMAT, "%s of the factors: %s", what, cause);
}

static bool length_within(const json_t *array, size_t lowest, size_t highest) {
    return json_is_array(array) && json_array_size(array) >= lowest && json_array_size(array) <= highest;
}

/* The position of `name` among `count` names, or `count`. */
static int find_name(const char *name, int count, const char *(*name_at)(int)) {
    int i = 0;
    while (i < count && strcmp(name, name_at(i)) != 0) i++;
    return i;
}

static const char *coordinate_at(int i) {
    return lq_coordinate_name((lq_coordinate)i);
}

static const char *value_at(int i) {
    return lq_value_name((lq_value)i);
}

static lq_status read_texture_axis(json_t *json, size_t most, lq_texture_axis *axis, lq_error *error) {
    const char *coordinate;
    json_t *texels;
    json_error_t cause;
    if (json_unpack_ex(json, &cause, 0, "{s:s, s:i, s:i, s:o}", "coordinate", &coordinate, "axis",
                       &axis->axis, "other", &axis->other, "texels", &texels))
        return wrong("an axis", cause.text, error);
    const int found = find_name(coordinate, LQ_COORDINATES, coordinate_at);
    if (found == LQ_COORDINATES) return wrong("an axis", "unknown coordinate", error);
    axis->coordinate = (lq_coordinate)found;
    return lq_axis_from_json(texels, most, &axis->texels, error);
}

/* What it has comes off `most`. */
static lq_status read_factor(json_t *json, size_t *most, lq_factor *factor, lq_error *error) {
    json_int_t bases;
    json_t *array;
    json_error_t cause;
    lq_texture_axis axes[2] = {0};
    if (json_unpack_ex(json, &cause, 0, "{s:I, s:o}", "bases", &bases, "axes", &array))
        return wrong("a texture", cause.text, error);
    if (bases < 1 || bases > BASES_MAX || !length_within(array, 1, 2))
        return wrong("a texture", "bases or axes out of range", error);
    const int count = (int)json_array_size(array);
    lq_status status = LQ_OK;
    double texels = (double)bases;
    for (int a = 0; a < count && status == LQ_OK; a++) {
        status = read_texture_axis(json_array_get(array, (size_t)a), *most, &axes[a], error);
        texels *= (double)axes[a].texels.size;
    }
    if (status == LQ_OK && texels > TEXELS_MAX) status = wrong("a texture", "too many texels", error);
    if (status == LQ_OK && texels > (double)*most)
        status = wrong("a texture", "more texels than there are", error);
    if (status == LQ_OK) *most -= (size_t)texels;
    if (status == LQ_OK) status = lq_factor_create(factor, axes, count, (size_t)bases, error);
    for (int a = 0; a < count; a++) lq_axis_free(&axes[a].texels);
    return status;
}

/* Array entry i as an integer in [0, limit), or -1. */
static int small(const json_t *array, size_t i, int limit) {
    const json_t *item = json_array_get(array, i);
    const json_int_t value = json_integer_value(item);
    return json_is_integer(item) && value >= 0 && value < limit ? (int)value : -1;
}

static lq_status read_sum(const json_t *json, lq_term_sum *sum, lq_error *error) {
    const json_t *factors = json_object_get(json, "factors"), *index = json_object_get(json, "index");
    int which[LQ_MAX_FACTORS] = {0};
    if (!length_within(factors, 1, LQ_MAX_FACTORS) || !length_within(index, 0, TERMS_MAX) ||
        json_array_size(index) % json_array_size(factors) != 0)
        return wrong("a sum", "incomplete", error);
    const size_t per_term = json_array_size(factors), entries = json_array_size(index);
    for (size_t g = 0; g < per_term; g++) {
        which[g] = small(factors, g, LQ_MAX_FACTORS);
        if (which[g] < 0) return wrong("a sum", "unknown texture", error);
    }
    const lq_status status = lq_term_sum_create(sum, entries / per_term, which, (int)per_term, error);
    for (size_t i = 0; status == LQ_OK && i < entries; i++) {
        const int base = small(index, i, BASES_MAX);
        if (base < 0) return wrong("a sum", "unknown base", error);
        sum->index[i] = (unsigned short)base;
    }
    return status;
}

static bool read_numbers(const json_t *array, double *values, int count) {
    if (!length_within(array, (size_t)count, (size_t)count)) return false;
    for (int i = 0; i < count; i++) {
        values[i] = json_number_value(json_array_get(array, (size_t)i));
        if (!json_is_number(json_array_get(array, (size_t)i))) return false;
    }
    return true;
}

static lq_status read_piece(json_t *json, int axis_count, size_t *most, lq_piece *piece, lq_error *error) {
    const char *value;
    json_t *min, *max, *factors, *streams;
    json_error_t cause;
    if (json_unpack_ex(json, &cause, 0, "{s:o, s:o, s:s, s:i, s:o, s:o}", "min", &min, "max", &max, "value",
                       &value, "value_axis", &piece->value_axis, "factors", &factors, "streams", &streams))
        return wrong("a piece", cause.text, error);
    const int found = find_name(value, LQ_VALUES, value_at);
    if (found == LQ_VALUES) return wrong("a piece", "unknown value transform", error);
    piece->value = (lq_value)found;
    if (!read_numbers(min, piece->min, axis_count) || !read_numbers(max, piece->max, axis_count) ||
        !length_within(factors, 0, LQ_MAX_FACTORS) || !length_within(streams, 1, LQ_MAX_STREAMS))
        return wrong("a piece", "incomplete", error);
    lq_status status = LQ_OK;
    for (size_t f = 0; f < json_array_size(factors) && status == LQ_OK; f++) {
        status = read_factor(json_array_get(factors, f), most, &piece->factors[f], error);
        piece->factor_count += status == LQ_OK;
    }
    for (size_t k = 0; k < json_array_size(streams) && status == LQ_OK; k++) {
        piece->stream_count++;
        status = read_sum(json_array_get(streams, k), &piece->streams[k], error);
    }
    return status;
}

static lq_status read_axis(json_t *json, lq_factored *factored, lq_error *error) {
    const char *name;
    json_error_t cause;
    const int a = factored->axis_count;
    if (json_unpack_ex(json, &cause, 0, "{s:s, s:F, s:F}", "name", &name, "min", &factored->axes[a].min,
                       "max", &factored->axes[a].max))
        return wrong("an axis", cause.text, error);
    if (strlen(name) >= LQ_NAME_SIZE || !(factored->axes[a].min <= factored->axes[a].max))
        return wrong("an axis", "name or range not accepted", error);
    strcpy(factored->axes[a].name, name);
    factored->axis_count++;
    return LQ_OK;
}

static lq_status read_all(json_t *json, size_t most, lq_factored *factored, lq_error *error) {
    json_t *axes, *pieces;
    json_error_t cause;
    if (json_unpack_ex(json, &cause, 0, "{s:o, s:F, s:F, s:o}", "axes", &axes, "value_min",
                       &factored->value_min, "value_max", &factored->value_max, "pieces", &pieces))
        return wrong("the structure", cause.text, error);
    if (!length_within(axes, 1, LQ_MAX_AXES) || !length_within(pieces, 1, LQ_MAX_PIECES))
        return wrong("the structure", "too many or no axes or pieces", error);
    lq_status status = LQ_OK;
    for (size_t a = 0; a < json_array_size(axes) && status == LQ_OK; a++)
        status = read_axis(json_array_get(axes, a), factored, error);
    for (size_t p = 0; p < json_array_size(pieces) && status == LQ_OK; p++)
        status = read_piece(json_array_get(pieces, p), factored->axis_count, &most,
                            &factored->pieces[factored->piece_count++], error);
    return status;
}

lq_status lq_factored_from_json(const char *text, size_t most, lq_factored *factored, lq_error *error) {
    json_t *json;
    lq_status status = lq_json_parse(&json, "the structure of the factors", text, strlen(text), error);
    if (status == LQ_OK) status = read_all(json, most, factored, error);
    json_decref(json);
    return status;
}
