/* options_text.c - "tau:2,alpha:4", "mu=64:sqrt" and their like into lq_pca_options. */
#include "pca/options_text.h"

#include "system/number.h"
#include "system/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The axis called by the first `length` characters of `name`. */
static lq_status find_axis(const char *name, size_t length, const lq_axis *axes, int axis_count, int *found,
                           lq_error *error) {
    char list[LQ_MESSAGE_SIZE] = "";
    for (*found = 0; *found < axis_count; ++*found) {
        const char *axis = axes[*found].name;
        if (strlen(axis) == length && strncmp(axis, name, length) == 0) return LQ_OK;
        lq_list_add(list, sizeof list, axis);
    }
    return lq_fail(error, LQ_BAD_INPUT, "unknown axis '%.*s'; the table has: %s", (int)length, name, list);
}

static lq_status read_count(const char *text, size_t length, size_t lowest, size_t highest, size_t *count,
                            lq_error *error) {
    const bool digits = length > 0 && length < 10 && strspn(text, "0123456789") >= length;
    *count = digits ? strtoul(text, NULL, 10) : 0;
    if (digits && *count >= lowest && *count <= highest) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT, "'%.*s' is not a whole number from %zu to %zu", (int)length, text,
                   lowest, highest);
}

/* The number that `text` begins with, up to a comma or its end. */
static lq_status read_number(const char *text, size_t length, double lowest, double highest, double *value,
                             lq_error *error) {
    char *end;
    *value = lq_strtod(text, &end);
    if (length > 0 && end == text + length && *value >= lowest && *value <= highest) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT, "'%.*s' is not a number from %g to %g", (int)length, text, lowest,
                   highest);
}

/* "tau:2" or "n+kappa:8", so long. */
static lq_status read_separation(lq_separation *out, const char *text, size_t length, const lq_axis *axes,
                                 int axis_count, lq_error *error) {
    const char *colon = memchr(text, ':', length), *end = text + length;
    const char *names_end = colon ? colon : end;
    *out = (lq_separation){.bases = 4};
    for (const char *name = text;; name++) {
        const char *plus = memchr(name, '+', (size_t)(names_end - name));
        const char *stop = plus ? plus : names_end;
        if (out->axis_count == 2)
            return lq_fail(error, LQ_BAD_INPUT,
                           "'%.*s' takes more than two axes out together; accepted are A:N and A+B:N",
                           (int)length, text);
        const lq_status status =
            find_axis(name, (size_t)(stop - name), axes, axis_count, &out->axes[out->axis_count], error);
        if (status != LQ_OK) return status;
        out->axis_count++;
        if (!plus) break;
        name = plus;
    }
    return colon ? read_count(colon + 1, (size_t)(end - colon - 1), 1, 64, &out->bases, error) : LQ_OK;
}

lq_status lq_pca_read_separations(lq_pca_options *options, const char *text, const lq_axis *axes,
                                  int axis_count, lq_error *error) {
    lq_status status = LQ_OK;
    while (*text && status == LQ_OK) {
        const size_t length = strcspn(text, ",");
        if (options->separation_count == LQ_MAX_AXES)
            return lq_fail(error, LQ_BAD_INPUT, "more than %d entries", (int)LQ_MAX_AXES);
        status = read_separation(&options->separations[options->separation_count++], text, length, axes,
                                 axis_count, error);
        text += length + (text[length] == ',');
    }
    return status;
}

lq_status lq_pca_read_split(lq_pca_options *options, const char *text, const lq_axis *axes, int axis_count,
                            lq_error *error) {
    const char *equals = strchr(text, '=');
    if (!equals) return lq_fail(error, LQ_BAD_INPUT, "'%s' names no value; write eta=1", text);
    lq_status status =
        find_axis(text, (size_t)(equals - text), axes, axis_count, &options->split_axis, error);
    for (text = equals + 1; *text && status == LQ_OK;) {
        const size_t length = strcspn(text, ",");
        if (options->split_count == LQ_MAX_PIECES - 1)
            return lq_fail(error, LQ_BAD_INPUT, "more than %d values", LQ_MAX_PIECES - 1);
        status = read_number(text, length, -1e9, 1e9, &options->splits[options->split_count++], error);
        text += length + (text[length] == ',');
    }
    return status;
}

static lq_status read_map(const char *text, size_t length, double *exponent, lq_error *error) {
    const bool power = length > 5 && strncmp(text, "power", 5) == 0;
    *exponent = length == 6 && strncmp(text, "linear", 6) == 0 ? 1.0
                : length == 4 && strncmp(text, "sqrt", 4) == 0 ? 2.0
                                                               : 0.0;
    if (*exponent > 0.0) return LQ_OK;
    if (power) return read_number(text + 5, length - 5, 0.1, 10.0, exponent, error);
    return lq_fail(error, LQ_BAD_INPUT, "'%.*s' is not a map; accepted are linear, sqrt and powerP",
                   (int)length, text);
}

lq_status lq_pca_read_texels(lq_pca_options *options, const char *text, const lq_axis *axes, int axis_count,
                             lq_error *error) {
    lq_status status = LQ_OK;
    while (*text && status == LQ_OK) {
        const size_t length = strcspn(text, ",");
        const char *end = text + length, *equals = memchr(text, '=', length);
        const char *colon = memchr(text, ':', length), *stop = colon ? colon : end;
        int a;
        if (!equals || stop < equals)
            return lq_fail(error, LQ_BAD_INPUT, "'%s' names no size; write mu=64", text);
        status = find_axis(text, (size_t)(equals - text), axes, axis_count, &a, error);
        if (status == LQ_OK)
            status = read_count(equals + 1, (size_t)(stop - equals - 1), 2, 4096, &options->texels[a], error);
        if (status == LQ_OK && colon)
            status = read_map(colon + 1, (size_t)(end - colon - 1), &options->exponents[a], error);
        text = end + (*end == ',');
    }
    return status;
}

lq_status lq_pca_read_bases(lq_pca_options *options, const char *text, lq_error *error) {
    const size_t length = strcspn(text, ",");
    const lq_status status = read_count(text, length, 1, 64, &options->bases[0], error);
    if (status != LQ_OK || text[length] == '\0') return status;
    return read_count(text + length + 1, strlen(text + length + 1), 1, 64, &options->bases[1], error);
}
