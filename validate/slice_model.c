/* slice_model.c - rows of cells in parallel, sums in their order. */
#include "validate/slice_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/parallel.h"
#include "system/status.h"

/* ======================================================================================
 *                                       Measured
 * ====================================================================================== */

static void fold(const float *value, const float *noise, float *folded, float *variance) {
    for (size_t i = 0; i < LQ_FOLDED_CELLS; i++) {
        const size_t row = i / LQ_FOLDED_PHI * LQ_SLICE_PHI, phi = i % LQ_FOLDED_PHI;
        const size_t one = row + phi, other = row + LQ_SLICE_PHI - 1 - phi;
        folded[i] = 0.5F * (value[one] + value[other]);
        variance[i] = 0.25F * (noise[one] * noise[one] + noise[other] * noise[other]);
    }
}

lq_gonio_part lq_slice_part(int side, bool inside, int part, int channel) {
    const int direct_to = inside ? -1 : 0;
    return part == LQ_PART_DIRECT ? (lq_gonio_part){side, 0, direct_to, channel}
                                  : (lq_gonio_part){side, direct_to + 1, LQ_GONIO_ORDERS - 1, channel};
}

void lq_slice_fold(const lq_gonio *g, int side, bool inside, lq_slice_layout layout, const double *solid,
                   lq_slice_pair *pair) {
    float value[LQ_SLICE_CELLS], noise[LQ_SLICE_CELLS];
    for (int part = 0; part < LQ_PARTS; part++)
        for (int c = 0; c < g->channels; c++) {
            const lq_gonio_part orders = lq_slice_part(side, inside, part, c);
            lq_gonio_slice(g, layout, &orders, solid, value, noise);
            fold(value, noise, pair->value[part][c], pair->variance[part][c]);
        }
}

/* ======================================================================================
 *                                       A model
 * ====================================================================================== */

typedef struct sums {
    double energy, sin2, mean, across;
} sums;

typedef struct rows {
    const lq_model_shape *shape;
    double mu;
    int side;
    lq_slice_layout layout;
    const double *solid;
    lq_slice_pair *pair;
    sums (*sums)[LQ_PARTS][LQ_STACK_CHANNELS]; /* [row] */
} rows;

/* A folded cell stands for two. */
static void add(sums *to, double flux, const lq_slice_point *p) {
    to->energy += 2.0 * flux;
    to->sin2 += 2.0 * flux * (p->x * p->x + p->y * p->y);
    to->mean += 2.0 * flux * p->x;
    to->across += 2.0 * flux * p->y * p->y;
}

static void run_cell(const rows *r, size_t row, size_t phi) {
    double value[LQ_PARTS][LQ_STACK_CHANNELS], flux[LQ_PARTS][LQ_STACK_CHANNELS] = {{0.0}};
    const size_t cell = row * LQ_SLICE_PHI + phi;
    lq_slice_point points[LQ_SLICE_POINTS];
    lq_slice_points(r->layout, r->mu, cell, points);
    for (int i = 0; i < LQ_SLICE_POINTS; i++) {
        const lq_slice_point *p = &points[i];
        if (!(p->z > 0.0 && p->solid > 0.0)) continue;
        lq_model_shape_value(r->shape, p->x, p->y, r->side ? -p->z : p->z, value[LQ_PART_DIRECT],
                             value[LQ_PART_REST]);
        for (int part = 0; part < LQ_PARTS; part++)
            for (int c = 0; c < r->shape->channels; c++) {
                flux[part][c] += value[part][c] * p->solid;
                add(&r->sums[row][part][c], value[part][c] * p->solid, p);
            }
    }
    const double scale = r->solid[cell] > 0.0 ? 1.0 / r->solid[cell] : 0.0;
    for (int part = 0; part < LQ_PARTS; part++)
        for (int c = 0; c < r->shape->channels; c++)
            r->pair->value[part][c][row * LQ_FOLDED_PHI + phi] = (float)(flux[part][c] * scale);
}

static lq_status run_row(void *user, size_t row, int thread, lq_error *error) {
    (void)thread, (void)error;
    for (size_t phi = 0; phi < LQ_FOLDED_PHI; phi++) run_cell(user, row, phi);
    return LQ_OK;
}

static void finish(const rows *r, lq_part_lobes *lobes) {
    for (int part = 0; part < LQ_PARTS; part++)
        for (int c = 0; c < r->shape->channels; c++) {
            sums all = {0.0, 0.0, 0.0, 0.0};
            for (size_t row = 0; row < LQ_SLICE_THETA; row++) {
                const sums *s = &r->sums[row][part][c];
                all.energy += s->energy, all.sin2 += s->sin2, all.mean += s->mean, all.across += s->across;
            }
            const double scale = all.energy > 0.0 ? 1.0 / all.energy : 0.0;
            (*lobes)[part][c] =
                (lq_stack_lobe){all.energy, all.sin2 * scale, all.mean * scale, all.across * scale};
        }
}

lq_status lq_slice_of_model(const lq_model_shape *shape, double mu, int side, lq_slice_layout layout,
                            const double *solid, int threads, lq_slice_pair *pair, lq_part_lobes *lobes,
                            lq_error *error) {
    rows r = {shape, mu, side, layout, solid, pair, calloc(LQ_SLICE_THETA, sizeof *r.sums)};
    if (!r.sums) return lq_fail(error, LQ_NO_MEMORY, "no memory for a slice");
    memset(pair->variance, 0, sizeof pair->variance);
    const lq_status status = lq_parallel(LQ_SLICE_THETA, threads, run_row, &r, NULL, error);
    if (status == LQ_OK && lobes) finish(&r, lobes);
    free(r.sums);
    return status;
}

/* ======================================================================================
 *                                     The difference
 * ====================================================================================== */

lq_slice_error lq_slice_compare(const lq_slice_pair *model, const lq_slice_pair *measured, int channels,
                                bool with_direct) {
    double square = 0.0, variance = 0.0;
    for (int c = 0; c < channels; c++)
        for (size_t i = 0; i < LQ_FOLDED_CELLS; i++) {
            double difference = 0.0;
            for (int part = with_direct ? LQ_PART_DIRECT : LQ_PART_REST; part < LQ_PARTS; part++) {
                difference += (double)model->value[part][c][i] - (double)measured->value[part][c][i];
                variance += (double)measured->variance[part][c][i];
            }
            square += difference * difference;
        }
    const double count = (double)channels * LQ_FOLDED_CELLS;
    return (lq_slice_error){sqrt(fmax(square - variance, 0.0) / count), sqrt(variance / count)};
}
