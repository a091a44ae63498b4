/* texture.c - a table as one texture: layout, and look-up as a sampler does it. */
#include "pack/texture.h"

#include "pack/names.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

lq_status lq_texture_check(const char *name, const lq_axis *axes, int axis_count, int channel_count,
                           lq_error *error) {
    int wide = 0;
    for (int a = 0; a < axis_count; a++) {
        if (axes[a].size > 1 && axes[a].map == LQ_MAP_CUSTOM)
            return lq_fail(error, LQ_BAD_INPUT,
                           "%s: axis %s is a list of nodes; a texture takes min:max:n with the map linear, "
                           "sqrt or powerN",
                           name, axes[a].name);
        if (axes[a].size > 1) wide++;
    }
    if (wide < 1 || wide > LQ_TEXTURE_AXES)
        return lq_fail(
            error, LQ_BAD_INPUT,
            "%s: %d axes have several nodes; a texture takes 1 to %d: fix others, \"eta\": \"1.5\"", name,
            wide, LQ_TEXTURE_AXES);
    if (channel_count > 4)
        return lq_fail(error, LQ_BAD_INPUT, "%s: %d channels; a texture takes at most 4", name,
                       channel_count);
    return LQ_OK;
}

static lq_status copy_axes(lq_texture *texture, const lq_table *table, lq_error *error) {
    for (int a = 0; a < table->axis_count; a++) {
        if (table->axes[a].size == 1) continue;
        lq_status status = lq_axis_copy(&texture->axes[texture->axis_count], &table->axes[a], error);
        if (status != LQ_OK) return status;
        texture->from[texture->axis_count++] = a;
    }
    return LQ_OK;
}

static lq_status fill(lq_texture *texture, const lq_table *table, lq_error *error) {
    size_t size[LQ_TEXTURE_AXES] = {1, 1, 1};
    const int count = table->channel_count, stored = count == 3 ? 4 : count;
    for (int a = 0; a < texture->axis_count; a++) size[a] = texture->axes[a].size;
    lq_status status = lq_image_create(&texture->image, size[0], size[1], size[2], 1, stored, error);
    if (status != LQ_OK) return status;
    texture->channel_count = count;
    for (int c = 0; c < count; c++) {
        snprintf(texture->channels[c], LQ_NAME_SIZE, "%s", table->channel_names[c]);
        for (size_t i = 0; i < lq_image_texels(&texture->image); i++)
            texture->image.data[i * (size_t)stored + (size_t)c] = table->channels[c][i];
    }
    return lq_image_to_half(&texture->image, texture->name, error);
}

lq_status lq_texture_make(lq_texture *texture, const lq_table *table, const char *name, lq_error *error) {
    *texture = (lq_texture){0};
    lq_make_identifier(texture->name, name);
    lq_status status = lq_texture_check(name, table->axes, table->axis_count, table->channel_count, error);
    if (status == LQ_OK) status = copy_axes(texture, table, error);
    if (status == LQ_OK) status = fill(texture, table, error);
    if (status != LQ_OK) lq_texture_free(texture);
    return status;
}

void lq_texture_free(lq_texture *texture) {
    for (int a = 0; a < texture->axis_count; a++) lq_axis_free(&texture->axes[a]);
    lq_image_free(&texture->image);
    *texture = (lq_texture){0};
}

size_t lq_texel_below(const lq_axis *axis, double x, int fraction_bits, double *above) {
    *above = 0.0;
    if (axis->size < 2) return 0;
    const double t = fmin(fmax((x - axis->min) / (axis->max - axis->min), 0.0), 1.0);
    double position = pow(t, 1.0 / axis->exponent) * (double)(axis->size - 1);
    if (fraction_bits > 0) position = ldexp(nearbyint(ldexp(position, fraction_bits)), -fraction_bits);
    const size_t last = axis->size - 2;
    const size_t below = (size_t)position < last ? (size_t)position : last;
    *above = position - (double)below;
    return below;
}

void lq_texture_sample(const lq_texture *texture, const double *point, int fraction_bits, double *values) {
    const lq_image *image = &texture->image;
    const size_t stride[LQ_TEXTURE_AXES] = {1, image->width, image->width * image->height};
    size_t first = 0;
    float weight[LQ_TEXTURE_AXES], sum[4] = {0.0f};
    for (int a = 0; a < texture->axis_count; a++) {
        double above;
        first +=
            stride[a] * lq_texel_below(&texture->axes[a], point[texture->from[a]], fraction_bits, &above);
        weight[a] = (float)above;
    }
    for (int corner = 0; corner < 1 << texture->axis_count; corner++) {
        size_t texel = first;
        float w = 1.0f;
        for (int a = 0; a < texture->axis_count; a++) {
            const bool above = (corner >> a & 1) != 0;
            w *= above ? weight[a] : 1.0f - weight[a];
            if (above) texel += stride[a];
        }
        for (int c = 0; c < texture->channel_count; c++)
            sum[c] += w * image->data[texel * (size_t)image->channels + (size_t)c];
    }
    for (int c = 0; c < texture->channel_count; c++) values[c] = (double)sum[c];
}

/* The largest second difference along an axis, of the four texels about a cell, of any channel. */
static double bend(const lq_texture *t, const size_t *below, int axis) {
    const size_t stride[LQ_TEXTURE_AXES] = {1, t->image.width, t->image.width * t->image.height};
    const size_t channels = (size_t)t->image.channels, step = stride[axis] * channels,
                 size = t->axes[axis].size;
    size_t at = 0;
    double most = 0.0;
    if (size < 3) return 0.0;
    for (int a = 0; a < t->axis_count; a++)
        if (a != axis) at += stride[a] * below[a];
    for (size_t middle = below[axis]; middle <= below[axis] + 1; middle++)
        for (size_t c = 0; c < channels && middle > 0 && middle + 1 < size; c++) {
            const float *x = &t->image.data[at * channels + middle * step + c];
            most = fmax(most, fabs((double)x[step] - 2.0 * (double)x[0] + (double)*(x - step)));
        }
    return most;
}

const char *lq_texture_bends(const lq_texture *texture, const double *point) {
    size_t below[LQ_TEXTURE_AXES] = {0};
    double above;
    const char *found = NULL;
    double most = 0.0;
    for (int a = 0; a < texture->axis_count; a++)
        below[a] = lq_texel_below(&texture->axes[a], point[texture->from[a]], 0, &above);
    for (int a = 0; a < texture->axis_count; a++) {
        const double b = bend(texture, below, a);
        if (b > most) found = texture->axes[a].name;
        most = fmax(most, b);
    }
    return found;
}
