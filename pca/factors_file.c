/* factors_file.c - factored tables in the archive format of tables: the bases of all factors stacked in one
 * image (row after row, each padded to the widest), their structure as the fact "factors". Checksum, atomic
 * writing and the refusal of damaged files are those of tables. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "pca/factors_json.h"
#include "system/status.h"
#include "tables/facts.h"

#define STRUCTURE "factors"

static size_t width_of(const lq_factor *factor) {
    return factor->axes[0].texels.size;
}

static size_t rows_of(const lq_factor *factor) {
    return lq_factor_texels(factor) / width_of(factor) * factor->base_count;
}

/* What to do with one row of texels. */
typedef void row_action(float *texels, float *image_row, size_t width);

static void row_out(float *texels, float *image_row, size_t width) {
    memcpy(image_row, texels, width * sizeof *texels);
}

static void row_in(float *texels, float *image_row, size_t width) {
    memcpy(texels, image_row, width * sizeof *texels);
}

static void image_size(const lq_factored *factored, size_t *width, size_t *height) {
    *width = *height = 0;
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; f < factored->pieces[p].factor_count; f++) {
            const lq_factor *factor = &factored->pieces[p].factors[f];
            *width = width_of(factor) > *width ? width_of(factor) : *width;
            *height += rows_of(factor);
        }
}

static void each_row(const lq_factored *factored, float *image, size_t width, row_action *act) {
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; f < factored->pieces[p].factor_count; f++) {
            const lq_factor *factor = &factored->pieces[p].factors[f];
            for (size_t r = 0; r < rows_of(factor); r++, image += width)
                act(factor->data + r * width_of(factor), image, width_of(factor));
        }
}

/* ------------------------------------------------------------------ writing */

static lq_status make_image(const lq_factored *factored, lq_table **image, lq_error *error) {
    lq_axis axes[2] = {0};
    const char *channel = "texel";
    size_t width, height;
    image_size(factored, &width, &height);
    lq_status status = lq_axis_make(&axes[0], "column", 0.0, width > 1 ? (double)(width - 1) : 0.0, width,
                                    LQ_MAP_LINEAR, 1.0, error);
    if (status == LQ_OK)
        status = lq_axis_make(&axes[1], "row", 0.0, height > 1 ? (double)(height - 1) : 0.0, height,
                              LQ_MAP_LINEAR, 1.0, error);
    if (status == LQ_OK) status = lq_table_create(image, axes, 2, &channel, 1, error);
    if (status == LQ_OK) each_row(factored, (*image)->channels[0], width, row_out);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    return status;
}

lq_status lq_factored_write(const lq_factored *factored, const char *path, lq_error *error) {
    lq_table *image = NULL;
    lq_status status = lq_factored_check(factored, error);
    if (status == LQ_OK) status = make_image(factored, &image, error);
    if (status != LQ_OK) return status;
    char *text = lq_factored_to_json(factored);
    status = text ? lq_table_set_fact(image, STRUCTURE, text, error)
                  : lq_fail(error, LQ_NO_MEMORY, "no memory for the structure of the factors");
    free(text);
    for (size_t i = 0; status == LQ_OK && i < factored->fact_count; i++)
        status = lq_table_set_fact(image, factored->facts[i].key, factored->facts[i].value, error);
    if (status == LQ_OK) status = lq_table_write_exr(image, path, error);
    lq_table_free(image);
    return status;
}

/* ------------------------------------------------------------------ reading */

static lq_status take_rows(const lq_table *image, lq_factored *factored, lq_error *error) {
    size_t width, height;
    image_size(factored, &width, &height);
    if (image->axis_count != 2 || image->channel_count != 1 || image->axes[0].size != width ||
        image->axes[1].size != height)
        return lq_fail(error, LQ_FORMAT, "its image does not hold the %zu x %zu texels of its factors", width,
                       height);
    each_row(factored, image->channels[0], width, row_in);
    return LQ_OK;
}

static lq_status read_image(const lq_table *image, lq_factored *factored, const char *path, lq_error *error) {
    const char *text = lq_table_fact(image, STRUCTURE);
    if (!text)
        return lq_fail(error, LQ_FORMAT,
                       "%s: a table, not a factored one; accepted is a file made by lacquer pca", path);
    lq_error cause = {""};
    lq_status status = lq_factored_from_json(text, lq_table_entries(image), factored, &cause);
    if (status == LQ_OK) status = take_rows(image, factored, &cause);
    if (status == LQ_OK) status = lq_factored_check(factored, &cause);
    if (status != LQ_OK) return lq_fail(error, status, "%s: %s", path, cause.text);
    for (size_t i = 0; i < image->fact_count && status == LQ_OK; i++)
        if (strcmp(image->facts[i].key, STRUCTURE) != 0)
            status = lq_factored_set_fact(factored, image->facts[i].key, image->facts[i].value, error);
    return status;
}

lq_status lq_factored_read(lq_factored **factored, const char *path, lq_error *error) {
    lq_table *image = NULL;
    *factored = NULL;
    lq_status status = lq_table_read_exr(&image, path, error);
    if (status != LQ_OK) return status;
    lq_factored *made = calloc(1, sizeof *made);
    status = made ? read_image(image, made, path, error) : lq_fail(error, LQ_NO_MEMORY, "no memory");
    lq_table_free(image);
    if (status == LQ_OK) *factored = made;
    else lq_factored_free(made);
    return status;
}
