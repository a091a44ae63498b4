/* assemble.c - bases into textures: scales, halves, and the terms of a shader.
 *
 * What is rounded first is what has few texels: the lines of the separated axes. The plane's bases are then
 * fitted again to the lines as they are stored, so that only their own rounding is left. Scales are powers of
 * two, chosen so that the largest values of the factors of a base are about equal: none gets near the
 * subnormal halves, where relative precision ends.
 */
#include "pca/assemble.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "pca/low_rank.h"
#include "pca/refine_lines.h"
#include "system/status.h"
#include "tables/half.h"

enum { FINAL_SWEEPS = 4 }; /* of the plane's bases alone: weights settle after two or three */

/* ------------------------------------------------------------------ scales */

/* Largest size of values[i * step], i < count. */
static double largest(const double *values, size_t count, size_t step) {
    double most = 0.0;
    for (size_t i = 0; i < count; i++) most = fmax(most, fabs(values[i * step]));
    return most;
}

static void scale(double *values, size_t count, size_t step, double factor) {
    for (size_t i = 0; i < count; i++) values[i * step] *= factor;
}

static void round_halves(double *values, size_t count) {
    for (size_t i = 0; i < count; i++) values[i] = (double)lq_half_round((float)values[i]);
}

/* Free columns: each base of q has 1 for its largest value. */
static void scale_columns(lq_stream *s, size_t rows) {
    for (size_t b = 0; b < s->bases; b++) {
        const double most = largest(s->q + b, s->columns, s->bases);
        if (most == 0.0) continue;
        scale(s->q + b, s->columns, s->bases, 1.0 / most);
        scale(s->p + b, rows, s->bases, most);
    }
}

/* Lines: the two of a pair alike, the largest pair of a base 1. */
static void scale_lines(lq_stream *s, size_t rows) {
    for (size_t b = 0; b < s->bases; b++) {
        double most = 0.0, size[LQ_MAX_PAIRS][2];
        for (size_t j = 0; j < s->pairs; j++) {
            for (int a = 0; a < 2; a++)
                size[j][a] = largest(s->lines[a] + (b * s->pairs + j) * s->size[a], s->size[a], 1);
            most = fmax(most, size[j][0] * size[j][1]);
        }
        for (size_t j = 0; j < s->pairs; j++)
            for (int a = 0; a < 2; a++)
                if (size[j][0] * size[j][1] > 0.0)
                    scale(s->lines[a] + (b * s->pairs + j) * s->size[a], s->size[a], 1,
                          sqrt(size[j][1 - a] / size[j][a] / most));
        scale(s->p + b, rows, s->bases, most);
    }
}

/* The separated side of a stream, as it will be stored. */
static lq_status round_columns(lq_stream *s, size_t rows, lq_error *error) {
    lq_status status = LQ_OK;
    if (s->axes == 0) { /* one constant: into p */
        for (size_t b = 0; b < s->bases; b++) scale(s->p + b, rows, s->bases, s->q[b]), s->q[b] = 1.0;
    } else if (s->pairs > 0) {
        scale_lines(s, rows);
        for (int a = 0; a < 2; a++) round_halves(s->lines[a], s->bases * s->pairs * s->size[a]);
        lq_lines_multiply(s);
    } else {
        status = lq_canonical(s->p, rows, s->q, s->columns, s->bases, error);
        if (status == LQ_OK) scale_columns(s, rows);
        round_halves(s->q, s->columns * s->bases);
    }
    return status;
}

/* Powers of two from the plane's bases to their partners; q stays what the product is. */
static void balance(lq_stream *s, size_t rows) {
    const int partners = s->axes == 0 ? 0 : s->pairs > 0 ? 2 : 1;
    for (size_t b = 0; b < s->bases && partners > 0; b++) {
        const double most = largest(s->p + b, rows, s->bases);
        if (most == 0.0) continue;
        const int shift = (int)lround(log2(most) / (partners + 1));
        scale(s->p + b, rows, s->bases, ldexp(1.0, -partners * shift));
        scale(s->q + b, s->columns, s->bases, ldexp(1.0, partners * shift));
        for (int a = 0; a < 2 && s->pairs > 0; a++)
            scale(s->lines[a] + b * s->pairs * s->size[a], s->pairs * s->size[a], 1, ldexp(1.0, shift));
    }
}

/* ------------------------------------------------------------------ textures of a fit */

/* Where the bases of the streams go: the plane, lines of each separated axis, planes of both. */
typedef struct layout {
    size_t plane, line[2], both; /* bases so far */
    int line_factor[2], both_factor;
} layout;

static void count_bases(const lq_fit *fit, layout *l) {
    *l = (layout){.line_factor = {-1, -1}, .both_factor = -1};
    for (int k = 0; k < fit->stream_count; k++) {
        const lq_stream *s = &fit->streams[k];
        l->plane += s->bases;
        if (s->axes == 3 && s->pairs == 0) l->both += s->bases;
        for (int a = 0; a < 2; a++)
            if (s->axes == 3 ? s->pairs > 0 : s->axes == 1 << a)
                l->line[a] += s->bases * (s->pairs > 0 ? s->pairs : 1);
    }
}

static lq_status create_factors(const lq_grid *grid, layout *l, lq_piece *piece, lq_error *error) {
    int *count = &piece->factor_count;
    lq_status status = lq_factor_create(&piece->factors[0], grid->plane, grid->plane_count, l->plane, error);
    *count = status == LQ_OK;
    for (int a = 0; a < 2 && status == LQ_OK; a++) {
        if (l->line[a] == 0) continue;
        l->line_factor[a] = *count;
        status = lq_factor_create(&piece->factors[*count], &grid->rest[a], 1, l->line[a], error);
        *count += status == LQ_OK;
    }
    if (status == LQ_OK && l->both > 0) {
        l->both_factor = *count;
        status = lq_factor_create(&piece->factors[*count], grid->rest, 2, l->both, error);
        *count += status == LQ_OK;
    }
    l->plane = l->line[0] = l->line[1] = l->both = 0;
    return status;
}

/* values[i * step] into a base. */
static void put(lq_factor *factor, size_t base, const double *values, size_t step) {
    const size_t texels = lq_factor_texels(factor);
    for (size_t i = 0; i < texels; i++)
        factor->data[base * texels + i] = lq_half_round((float)values[i * step]);
}

static lq_status put_stream(const lq_stream *s, layout *l, lq_piece *piece, int k, lq_error *error) {
    const size_t pairs = s->pairs > 0 ? s->pairs : 1;
    int factors[3] = {0}, count = 1;
    for (int a = 0; a < 2; a++)
        if (s->axes == 3 ? s->pairs > 0 : s->axes == 1 << a) factors[count++] = l->line_factor[a];
    if (s->axes == 3 && s->pairs == 0) factors[count++] = l->both_factor;
    const lq_status status = lq_term_sum_create(&piece->streams[k], s->bases * pairs, factors, count, error);
    piece->stream_count += status == LQ_OK;
    if (status != LQ_OK) return status;
    unsigned short *index = piece->streams[k].index;
    for (size_t b = 0; b < s->bases; b++, l->plane++) {
        put(&piece->factors[0], l->plane, s->p + b, s->bases);
        for (size_t j = 0; j < pairs; j++) {
            *index++ = (unsigned short)l->plane;
            for (int g = 1; g < count; g++) {
                const int a = factors[g] == l->line_factor[1];
                size_t *slot = factors[g] == l->both_factor ? &l->both : &l->line[a];
                if (s->pairs > 0)
                    put(&piece->factors[factors[g]], *slot, s->lines[a] + (b * pairs + j) * s->size[a], 1);
                else put(&piece->factors[factors[g]], *slot, s->q + b, s->bases);
                *index++ = (unsigned short)(*slot)++;
            }
        }
    }
    return LQ_OK;
}

lq_status lq_assemble_fit(lq_fit *fit, const lq_grid *grid, lq_piece *piece, lq_error *error) {
    layout l;
    lq_status status = LQ_OK;
    for (int k = 0; k < fit->stream_count && status == LQ_OK; k++)
        status = round_columns(&fit->streams[k], fit->rows, error);
    if (status == LQ_OK) status = lq_fit_refine(fit, FINAL_SWEEPS, true, NULL, error);
    for (int k = 0; k < fit->stream_count; k++) balance(&fit->streams[k], fit->rows);
    count_bases(fit, &l);
    if (status == LQ_OK) status = create_factors(grid, &l, piece, error);
    for (int k = 0; k < fit->stream_count && status == LQ_OK; k++)
        status = put_stream(&fit->streams[k], &l, piece, k, error);
    return status;
}

/* ------------------------------------------------------------------ textures of the sequential scheme */

/* Each base of the plane shares its size with those it is multiplied with. */
static void balance_chain(const lq_chain *chain) {
    const size_t leaves = chain->bases[chain->levels], texels = chain->texels[chain->levels];
    for (size_t leaf = 0; leaf < leaves && chain->levels > 0; leaf++) {
        const size_t level = chain->levels - 1;
        const size_t partner = leaf; /* the last separation has one base a leaf */
        double *plane = chain->data[chain->levels] + leaf * texels;
        const double most = largest(plane, texels, 1);
        if (most == 0.0) continue;
        const int shift = (int)lround(log2(most) / 2.0);
        scale(plane, texels, 1, ldexp(1.0, -shift));
        scale(chain->data[level] + partner * chain->texels[level], chain->texels[level], 1,
              ldexp(1.0, shift));
    }
}

lq_status lq_assemble_chain(const lq_chain *chain, const lq_grid *grid, const lq_pca_options *options,
                            lq_piece *piece, lq_error *error) {
    const size_t levels = chain->levels, leaves = chain->bases[levels];
    int factors[LQ_MAX_AXES + 1];
    const lq_texture_axis *axes = grid->rest;
    lq_status status = LQ_OK;
    balance_chain(chain);
    for (size_t i = 0; i <= levels && status == LQ_OK; i++) {
        const int count = i < levels ? options->separations[i].axis_count : grid->plane_count;
        lq_factor *factor = &piece->factors[i];
        factors[i] = (int)i;
        status = lq_factor_create(factor, i < levels ? axes : grid->plane, count, chain->bases[i], error);
        piece->factor_count += status == LQ_OK;
        for (size_t b = 0; b < chain->bases[i] && status == LQ_OK; b++)
            put(factor, b, chain->data[i] + b * chain->texels[i], 1);
        axes += count;
    }
    if (status == LQ_OK)
        status = lq_term_sum_create(&piece->streams[0], leaves, factors, (int)levels + 1, error);
    piece->stream_count = status == LQ_OK;
    for (size_t leaf = 0; leaf < leaves && status == LQ_OK; leaf++)
        for (size_t i = 0; i <= levels; i++)
            piece->streams[0].index[leaf * (levels + 1) + i] =
                (unsigned short)(leaf / (leaves / chain->bases[i]));
    return status;
}
