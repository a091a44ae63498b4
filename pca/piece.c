/* piece.c - one box of a table: its texels, its samples, its factors. */
#include "pca/piece.h"

#include <math.h>
#include <stdlib.h>

#include "pca/assemble.h"
#include "pca/factors.h"
#include "pca/sequential.h"
#include "tables/status.h"

/* ------------------------------------------------------------------ texels */

/* Nodes of an axis within a range. */
static size_t nodes_within(const lq_axis *axis, double min, double max) {
    size_t count = 0;
    for (size_t i = 0; i < axis->size; i++) count += axis->nodes[i] >= min && axis->nodes[i] <= max;
    return count;
}

/* Texels along a table axis: its nodes where these are regular and all in the piece, otherwise as many,
 * linear. */
static lq_status axis_texels(const lq_table *table, const lq_pca_options *options, const lq_piece *piece,
                             int a, lq_texture_axis *out, lq_error *error) {
    const lq_axis *axis = &table->axes[a];
    const size_t inside = nodes_within(axis, piece->min[a], piece->max[a]);
    const size_t count = options->texels[a] > 0 ? options->texels[a] : inside;
    const bool whole = inside == axis->size && axis->map != LQ_MAP_CUSTOM;
    *out = (lq_texture_axis){.coordinate = LQ_COORDINATE_AXIS, .axis = a};
    return lq_axis_make(&out->texels, axis->name, piece->min[a], piece->max[a], count,
                        whole ? axis->map : LQ_MAP_LINEAR, axis->exponent, error);
}

/* mu from the critical cosine: from as far below as the smallest eta needs, to grazing's opposite. */
static lq_status critical_texels(const lq_piece *piece, int mu, int eta, size_t count, lq_texture_axis *out,
                                 lq_error *error) {
    *out = (lq_texture_axis){.coordinate = LQ_COORDINATE_CRITICAL, .axis = mu, .other = eta};
    double x[LQ_MAX_AXES] = {0.0};
    x[mu] = piece->min[mu];
    x[eta] = piece->min[eta];
    const double least = lq_coordinate_at(out, x);
    return lq_axis_make(&out->texels, "mu-critical", fmin(least, 0.0), 1.0, count, LQ_MAP_LINEAR, 1.0, error);
}

static bool is_separated(const lq_pca_options *options, int a) {
    for (int i = 0; i < options->separation_count; i++)
        for (int j = 0; j < options->separations[i].axis_count; j++)
            if (options->separations[i].axes[j] == a) return true;
    return false;
}

static lq_status fill_grid(const lq_table *table, const lq_pca_options *options, const lq_piece *piece,
                           lq_grid *grid, lq_error *error) {
    lq_status status = LQ_OK;
    for (int a = 0; a < table->axis_count; a++) grid->fixed[a] = table->axes[a].nodes[0];
    for (int a = 0; a < table->axis_count && status == LQ_OK; a++) {
        if (table->axes[a].size == 1 || is_separated(options, a)) continue;
        status = axis_texels(table, options, piece, a, &grid->plane[grid->plane_count], error);
        grid->plane_count += status == LQ_OK;
    }
    for (int i = 0; i < options->separation_count && status == LQ_OK; i++)
        for (int j = 0; j < options->separations[i].axis_count && status == LQ_OK; j++) {
            status = axis_texels(table, options, piece, options->separations[i].axes[j],
                                 &grid->rest[grid->rest_count], error);
            grid->rest_count += status == LQ_OK;
        }
    if (status != LQ_OK || !options->critical) return status;
    lq_texture_axis critical;
    const int mu = lq_table_axis(table, "mu"), eta = lq_table_axis(table, "eta");
    status = critical_texels(piece, mu, eta, grid->plane[0].texels.size, &critical, error);
    if (status != LQ_OK) return status;
    lq_axis_free(&grid->plane[0].texels);
    grid->plane[0] = critical;
    return LQ_OK;
}

lq_status lq_piece_grid(const lq_table *table, const lq_pca_options *options, const lq_piece *piece,
                        lq_grid *grid, lq_error *error) {
    *grid = (lq_grid){0};
    const lq_status status = fill_grid(table, options, piece, grid, error);
    if (status != LQ_OK) lq_grid_free(grid);
    return status;
}

/* ------------------------------------------------------------------ the joint scheme */

static void set_stream(const lq_grid *grid, lq_fit *fit, int k, int axes, size_t bases, size_t pairs) {
    lq_stream *s = &fit->streams[k];
    *s = (lq_stream){.axes = axes, .bases = bases, .pairs = axes == 3 ? pairs : 0};
    for (int a = 0; a < 2; a++) s->size[a] = axes & 1 << a ? grid->rest[a].texels.size : 1;
    s->columns = s->size[0] * s->size[1];
}

/* Which column of the stream a column of the samples reads. */
static void set_columns(const lq_grid *grid, lq_stream *s, size_t columns) {
    const size_t first = grid->rest[0].texels.size;
    for (size_t c = 0; c < columns; c++) {
        const size_t i = s->axes & 1 ? c % first : 0, j = s->axes & 2 ? c / first : 0;
        s->column[c] = j * s->size[0] + i;
    }
}

static size_t separated_bases(const lq_pca_options *options) {
    size_t bases = 1;
    for (int i = 0; i < options->separation_count; i++) bases *= options->separations[i].bases;
    return bases;
}

static void plan_fit(const lq_grid *grid, const lq_pca_options *options, lq_fit *fit) {
    const int all = grid->rest_count > 1 ? 3 : 1;
    const size_t pairs = options->separation_count > 1 ? (options->pairs > 0 ? options->pairs : 1) : 0;
    fit->value = options->value;
    fit->power = options->power;
    const size_t bases = options->bases[0] > 0 ? options->bases[0] : separated_bases(options);
    if (options->value != LQ_VALUE_BEER) {
        fit->stream_count = 1;
        set_stream(grid, fit, 0, all, bases, pairs);
        return;
    }
    const int depth = grid->rest[0].axis == options->value_axis ? 0 : 1, others = all & ~(1 << depth);
    fit->stream_count = 2;
    set_stream(grid, fit, 0, others, others ? bases : 1, pairs);
    set_stream(grid, fit, 1, all, options->bases[1] > 0 ? options->bases[1] : bases, pairs);
}

/* log2 of tau at every column; tau = 0 lets nothing through, like a depth of 64 does in half. */
static void set_depth(const lq_grid *grid, const lq_pca_options *options, size_t columns, double *depth) {
    for (size_t c = 0; c < columns; c++) {
        double x[LQ_MAX_AXES];
        lq_grid_point(grid, 0, c, x);
        depth[c] = fmax(log2(x[options->value_axis]), -64.0);
    }
}

static lq_status joint(const float *samples, const lq_grid *grid, const lq_pca_options *options,
                       const lq_progress *progress, double *depth, lq_piece *piece, lq_error *error) {
    lq_fit fit = {
        .rows = lq_grid_rows(grid), .columns = lq_grid_columns(grid), .samples = samples, .depth = depth};
    plan_fit(grid, options, &fit);
    if (fit.value == LQ_VALUE_BEER) set_depth(grid, options, fit.columns, depth);
    lq_status status = lq_fit_create(&fit, error);
    if (status != LQ_OK) return status;
    for (int k = 0; k < fit.stream_count; k++) set_columns(grid, &fit.streams[k], fit.columns);
    status = lq_fit_start(&fit, error);
    if (status == LQ_OK) status = lq_fit_refine(&fit, options->sweeps, false, progress, error);
    if (status == LQ_OK) status = lq_assemble_fit(&fit, grid, piece, error);
    lq_fit_free(&fit);
    piece->value = options->value;
    piece->value_axis = options->value == LQ_VALUE_BEER ? options->value_axis : 0;
    return status;
}

/* ------------------------------------------------------------------ either scheme */

lq_status lq_piece_fit(const float *samples, const lq_grid *grid, const lq_pca_options *options,
                       const lq_progress *progress, lq_piece *piece, lq_error *error) {
    if (options->scheme == LQ_JOINT) {
        const size_t columns = lq_grid_columns(grid);
        double *depth = malloc(columns * sizeof *depth);
        if (!depth) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu columns", columns);
        const lq_status status = joint(samples, grid, options, progress, depth, piece, error);
        free(depth);
        return status;
    }
    lq_chain chain;
    lq_status status = lq_sequential(samples, grid, options, &chain, error);
    if (status != LQ_OK) return status;
    piece->value = LQ_VALUE_PLAIN;
    status = lq_assemble_chain(&chain, grid, options, piece, error);
    lq_chain_free(&chain);
    return status;
}
