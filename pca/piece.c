/* piece.c - one box of a table: its texels, its samples, its factors. */
#include "pca/piece.h"

#include <math.h>
#include <stdlib.h>

#include "pca/assemble.h"
#include "pca/factors.h"
#include "pca/refine_start.h"
#include "pca/sequential.h"
#include "system/status.h"

/* ------------------------------------------------------------------ texels */

/* Nodes of an axis within a range. */
static size_t nodes_within(const lq_axis *axis, double min, double max) {
    size_t count = 0;
    for (size_t i = 0; i < axis->size; i++) count += axis->nodes[i] >= min && axis->nodes[i] <= max;
    return count;
}

static lq_map map_of(double exponent) {
    return exponent == 1.0 ? LQ_MAP_LINEAR : exponent == 2.0 ? LQ_MAP_SQRT : LQ_MAP_POWER;
}

/* Texels along a table axis: its nodes where these are regular and all in the piece, otherwise as many,
 * linear.
 */
static lq_status axis_texels(const lq_table *table, const lq_pca_options *options, const lq_piece *piece,
                             int a, lq_texture_axis *out, lq_error *error) {
    const lq_axis *axis = &table->axes[a];
    const size_t inside = nodes_within(axis, piece->min[a], piece->max[a]);
    const size_t count = options->texels[a] > 0 ? options->texels[a] : inside;
    const bool whole = inside == axis->size && axis->map != LQ_MAP_CUSTOM;
    const double exponent = options->exponents[a] > 0.0 ? options->exponents[a]
                            : whole                     ? axis->exponent
                                                        : 1.0;
    *out = (lq_texture_axis){.coordinate = LQ_COORDINATE_AXIS, .axis = a};
    return lq_axis_make(&out->texels, axis->name, piece->min[a], piece->max[a], count, map_of(exponent),
                        exponent, error);
}

/* The texels of a coordinate other than an axis itself, over what it covers in the piece. */
static lq_status other_texels(lq_texture_axis *out, const char *name, double min, double max, size_t count,
                              double exponent, lq_error *error) {
    if (exponent <= 0.0) exponent = 1.0;
    return lq_axis_make(&out->texels, name, min, max, count, map_of(exponent), exponent, error);
}

/* mu from the critical cosine, from as far below as the smallest eta needs; eta by its critical cosine, on
 * which a map that was asked for counts. */
static lq_status critical_texels(const lq_table *table, const lq_pca_options *options, const lq_piece *piece,
                                 lq_grid *grid, lq_error *error) {
    const int mu = lq_table_axis(table, "mu"), eta = lq_table_axis(table, "eta");
    double x[LQ_MAX_AXES] = {0.0};
    lq_status status = LQ_OK;
    for (int a = 0; a < 2 && status == LQ_OK; a++) {
        lq_texture_axis *axis = &grid->plane[a];
        const size_t count = axis->texels.size;
        const bool is_mu = axis->axis == mu;
        lq_axis_free(&axis->texels);
        axis->coordinate = is_mu ? LQ_COORDINATE_CRITICAL : LQ_COORDINATE_COSINE;
        axis->other = is_mu ? eta : 0;
        x[mu] = piece->min[mu];
        x[eta] = piece->min[eta];
        const double widest = lq_coordinate_at(axis, x);
        x[eta] = piece->max[eta];
        status = is_mu ? other_texels(axis, "mu-critical", fmin(widest, 0.0), 1.0, count, 1.0, error)
                       : other_texels(axis, "critical", lq_coordinate_at(axis, x), widest, count,
                                      options->exponents[eta], error);
    }
    return status;
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
    return critical_texels(table, options, piece, grid, error);
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
    const size_t first = grid->rest_count > 0 ? grid->rest[0].texels.size : 1;
    for (size_t c = 0; c < columns; c++) {
        const size_t i = s->axes & 1 ? c % first : 0, j = s->axes & 2 ? c / first : 0;
        s->column[c] = j * s->size[0] + i;
    }
}

size_t lq_separated_bases(const lq_pca_options *options) {
    size_t bases = 1;
    for (int i = 0; i < options->separation_count; i++) bases *= options->separations[i].bases;
    return bases;
}

static void plan_fit(const lq_grid *grid, const lq_pca_options *options, lq_fit *fit) {
    const int all = (1 << grid->rest_count) - 1; /* of none, one or two separated axes */
    const size_t pairs = options->separation_count > 1 ? (options->pairs > 0 ? options->pairs : 1) : 0;
    fit->value = options->value;
    fit->power = options->power;
    const size_t bases = options->bases[0] > 0 ? options->bases[0] : lq_separated_bases(options);
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

/* Singular vectors already have the least rms error of a plain value where nothing ties the columns. */
static bool is_best(const lq_fit *fit) {
    return fit->value == LQ_VALUE_PLAIN && fit->power == 2.0 && fit->streams[0].pairs == 0;
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
    if (status == LQ_OK && !is_best(&fit))
        status = lq_fit_refine(&fit, options->sweeps, false, progress, error);
    if (status == LQ_OK) status = lq_assemble_fit(&fit, grid, piece, error);
    lq_fit_free(&fit);
    piece->value = options->value;
    piece->value_axis = options->value == LQ_VALUE_BEER ? options->value_axis : 0;
    return status;
}

/* ------------------------------------------------------------------ either scheme */

static lq_status fit_samples(const float *samples, const lq_grid *grid, const lq_pca_options *options,
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

void lq_piece_box(const lq_table *table, const lq_pca_options *options, int p, lq_piece *piece) {
    for (int a = 0; a < table->axis_count; a++) {
        piece->min[a] = table->axes[a].min;
        piece->max[a] = table->axes[a].max;
    }
    if (p > 0) piece->min[options->split_axis] = options->splits[p - 1];
    if (p < options->split_count) piece->max[options->split_axis] = options->splits[p];
}

lq_status lq_piece_make(const lq_table *table, int channel, const lq_pca_options *options,
                        const lq_progress *progress, lq_piece *piece, lq_error *error) {
    lq_grid grid;
    float *samples = NULL;
    lq_status status = lq_piece_grid(table, options, piece, &grid, error);
    if (status != LQ_OK) return status;
    status = lq_unfold(table, channel, &grid, &samples, error);
    if (status == LQ_OK) status = fit_samples(samples, &grid, options, progress, piece, error);
    free(samples);
    lq_grid_free(&grid);
    return status;
}
