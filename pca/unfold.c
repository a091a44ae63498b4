/* unfold.c - samples of a table as a matrix. */
#include "pca/unfold.h"

#include <math.h>
#include <stdlib.h>

#include "system/status.h"

enum { TAPS = 4 };

static size_t product(const lq_texture_axis *axes, int count) {
    size_t size = 1;
    for (int a = 0; a < count; a++) size *= axes[a].texels.size;
    return size;
}

size_t lq_grid_rows(const lq_grid *grid) {
    return product(grid->plane, grid->plane_count);
}

size_t lq_grid_columns(const lq_grid *grid) {
    return product(grid->rest, grid->rest_count);
}

void lq_grid_free(lq_grid *grid) {
    for (int a = 0; a < grid->plane_count; a++) lq_axis_free(&grid->plane[a].texels);
    for (int a = 0; a < grid->rest_count; a++) lq_axis_free(&grid->rest[a].texels);
    grid->plane_count = grid->rest_count = 0;
}

/* ------------------------------------------------------------------ points */

/* x[axis] where the coordinate is u; what it reads besides must be set. */
static double invert(const lq_texture_axis *axis, double u, const double *x) {
    if (axis->coordinate == LQ_COORDINATE_AXIS) return u;
    if (axis->coordinate == LQ_COORDINATE_COSINE) return sqrt(fmax((1.0 - u) * (1.0 + u), 0.0));
    const double eta = x[axis->other], c = eta < 1.0 ? sqrt((1.0 - eta) * (1.0 + eta)) : 0.0;
    return u < 0.0 ? c * (1.0 - u * u) : c + u * u * (1.0 - c);
}

/* Those axes that read no other, or those that do. */
static void set_axes(const lq_texture_axis *axes, int count, size_t index, bool reading, double *x) {
    for (int a = 0; a < count; a++) {
        const size_t i = index % axes[a].texels.size;
        index /= axes[a].texels.size;
        if ((axes[a].coordinate == LQ_COORDINATE_CRITICAL) == reading)
            x[axes[a].axis] = invert(&axes[a], axes[a].texels.nodes[i], x);
    }
}

void lq_grid_point(const lq_grid *grid, size_t row, size_t column, double *x) {
    for (int a = 0; a < LQ_MAX_AXES; a++) x[a] = grid->fixed[a];
    set_axes(grid->rest, grid->rest_count, column, false, x);
    set_axes(grid->plane, grid->plane_count, row, false, x);
    set_axes(grid->plane, grid->plane_count, row, true, x);
}

/* ------------------------------------------------------------------ interpolation between nodes */

typedef struct taps {
    int count;
    size_t node[TAPS];
    double weight[TAPS];
} taps;

/* Lagrange's polynomial through the four nodes around x, fewer where the axis has fewer. */
static taps taps_at(const lq_axis *axis, double x) {
    const double index = lq_axis_locate(axis, x);
    const size_t below = (size_t)index;
    const double near = index - (double)below;
    if (near < 1e-9 || near > 1.0 - 1e-9) return (taps){1, {near < 0.5 ? below : below + 1}, {1.0}};
    taps t = {.count = axis->size < TAPS ? (int)axis->size : TAPS};
    size_t first = below > 0 ? below - 1 : 0;
    if (first + (size_t)t.count > axis->size) first = axis->size - (size_t)t.count;
    for (int i = 0; i < t.count; i++) {
        t.node[i] = first + (size_t)i;
        t.weight[i] = 1.0;
        for (int j = 0; j < t.count; j++)
            if (j != i)
                t.weight[i] *= (x - axis->nodes[first + (size_t)j]) /
                               (axis->nodes[t.node[i]] - axis->nodes[first + (size_t)j]);
    }
    return t;
}

static double interpolate(const lq_table *table, const float *data, const taps *t) {
    int corner[LQ_MAX_AXES] = {0};
    double sum = 0.0;
    for (;;) {
        size_t offset = 0, stride = 1;
        double weight = 1.0;
        for (int a = 0; a < table->axis_count; a++) {
            offset += t[a].node[corner[a]] * stride;
            weight *= t[a].weight[corner[a]];
            stride *= table->axes[a].size;
        }
        sum += weight * (double)data[offset];
        int a = 0;
        while (a < table->axis_count && ++corner[a] == t[a].count) corner[a++] = 0;
        if (a == table->axis_count) return sum;
    }
}

/* The taps of the rest are the same in every row. */
static lq_status make_rest_taps(const lq_table *table, const lq_grid *grid, taps **rest, lq_error *error) {
    const size_t columns = lq_grid_columns(grid), axes = (size_t)table->axis_count;
    *rest = malloc(columns * axes * sizeof **rest);
    if (!*rest) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu columns", columns);
    for (size_t c = 0; c < columns; c++) {
        double x[LQ_MAX_AXES];
        lq_grid_point(grid, 0, c, x);
        for (size_t a = 0; a < axes; a++) (*rest)[c * axes + a] = taps_at(&table->axes[a], x[a]);
    }
    return LQ_OK;
}

lq_status lq_unfold(const lq_table *table, int channel, const lq_grid *grid, float **values,
                    lq_error *error) {
    const size_t rows = lq_grid_rows(grid), columns = lq_grid_columns(grid), axes = (size_t)table->axis_count;
    taps *rest = NULL;
    *values = malloc(rows * columns * sizeof **values);
    if (!*values)
        return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu x %zu samples of the table", rows, columns);
    const lq_status status = make_rest_taps(table, grid, &rest, error);
    if (status != LQ_OK) {
        free(*values);
        *values = NULL;
        return status;
    }
#pragma omp parallel for schedule(static)
    for (size_t row = 0; row < rows; row++) {
        double x[LQ_MAX_AXES];
        taps t[LQ_MAX_AXES];
        lq_grid_point(grid, row, 0, x);
        for (int a = 0; a < grid->plane_count; a++) {
            const int axis = grid->plane[a].axis;
            t[axis] = taps_at(&table->axes[axis], x[axis]);
        }
        for (size_t c = 0; c < columns; c++) {
            for (int a = 0; a < grid->rest_count; a++)
                t[grid->rest[a].axis] = rest[c * axes + (size_t)grid->rest[a].axis];
            for (int a = 0; a < table->axis_count; a++)
                if (table->axes[a].size == 1) t[a] = (taps){1, {0}, {1.0}};
            (*values)[row * columns + c] = (float)interpolate(table, table->channels[channel], t);
        }
    }
    free(rest);
    return LQ_OK;
}
