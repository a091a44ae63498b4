/* model_shape.c - the lobes of one incidence as densities of directions. */
#include "stack/model_shape.h"

#include <math.h>
#include <stdlib.h>

#include "system/status.h"

static const double PI = 3.14159265358979323846;

/* Light along the horizon is that just above it, as tables have it. */
static const double LEAST_MU = 1e-6;

/* ======================================================================================
 *                                         A lobe
 * ====================================================================================== */

static lq_status albedo(double mu, double alpha, double *value, lq_error *error) {
    const lq_kind *kind = lq_kind_find("albedo", error);
    const lq_settings settings = lq_settings_default();
    double estimate;
    if (!kind) return LQ_BAD_INPUT;
    const lq_status status = lq_eval(kind, &settings, (double[]){mu, alpha}, value, &estimate, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* D G2 / (4 mu_i), at an outgoing direction above the horizon. The tangent of the half vector is taken from
 * differences, so that a narrow lobe keeps its digits. */
static double unscaled(const lq_shape_lobe *lobe, double x, double y, double z) {
    const double a2 = lobe->alpha * lobe->alpha, in = lobe->cosine;
    const double along = x - lobe->sine, up = z + in;
    const double tan2 = (along * along + y * y) / (up * up), widened = a2 + tan2;
    const double d = a2 * (1.0 + tan2) * (1.0 + tan2) / (PI * widened * widened);
    const double si = sqrt(a2 + (1.0 - a2) * in * in), so = sqrt(a2 + (1.0 - a2) * z * z);
    return d * z / (2.0 * (z * si + in * so));
}

static lq_status make_lobe(lq_shape_lobe *lobe, const lq_model_lobe *from, const lq_shape_query *query,
                           lq_error *error) {
    const double sine = fmin(fmax(from->mean, 0.0), 1.0);
    const double least = query->least_alpha > 0.0 ? query->least_alpha : LQ_SHAPE_LEAST_ALPHA;
    double whole = 1.0;
    *lobe = (lq_shape_lobe){.energy = from->energy, .alpha = fmin(fmax(from->alpha, least), 1.0)};
    lobe->cosine = fmax(sqrt((1.0 - sine) * (1.0 + sine)), LEAST_MU);
    lobe->sine = sqrt((1.0 - lobe->cosine) * (1.0 + lobe->cosine));
    if (!(from->energy > 0.0)) return LQ_OK;
    const lq_status status = query->masked ? LQ_OK : albedo(lobe->cosine, lobe->alpha, &whole, error);
    lobe->scale = from->energy / whole;
    return status;
}

/* ======================================================================================
 *                                         All
 * ====================================================================================== */

static lq_status make_lobes(lq_model_shape *shape, const lq_model_lobe *lobes, const lq_shape_query *query,
                            lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t i = 0; i < shape->count * (size_t)shape->channels && status == LQ_OK; i++) {
        status = make_lobe(&shape->lobes[i], &lobes[i], query, error);
        if (lobes[i].energy > 0.0) shape->sharpest = fmin(shape->sharpest, lobes[i].alpha);
    }
    return status;
}

lq_status lq_model_shape_make(lq_model_shape *shape, const lq_stack *stack, const lq_shape_query *query,
                              double mu, lq_error *error) {
    const lq_model_query light = {.mu = &mu,
                                  .mu_count = 1,
                                  .model = query->model,
                                  .variant = query->variant,
                                  .f = query->f,
                                  .mapping = query->mapping,
                                  .threads = 1};
    *shape = (lq_model_shape){
        .channels = lq_stack_channels(stack), .count = lq_model_lobe_count(stack), .sharpest = 1.0};
    const size_t all = shape->count * (size_t)shape->channels;
    lq_model_lobe *lobes = calloc(all, sizeof *lobes);
    shape->lobes = calloc(all, sizeof *shape->lobes);
    lq_status status = lobes && shape->lobes ? lq_model_solve(stack, &light, lobes, NULL, error)
                                             : lq_fail(error, LQ_NO_MEMORY,
                                                       "no memory for the lobes of %zu layers", shape->count);
    if (status == LQ_OK) status = make_lobes(shape, lobes, query, error);
    free(lobes);
    return status;
}

void lq_model_shape_free(lq_model_shape *shape) {
    free(shape->lobes);
    *shape = (lq_model_shape){0};
}

/* Lobe k in a direction on its own side. */
static double lobe_value(const lq_model_shape *shape, int channel, size_t k, double x, double y, double z) {
    const lq_shape_lobe *lobe = &shape->lobes[(size_t)channel * shape->count + k];
    return lobe->scale > 0.0 ? lobe->scale * unscaled(lobe, x, y, z) : 0.0;
}

static void channel_value(const lq_model_shape *shape, int channel, double x, double y, double z,
                          double *direct, double *rest) {
    const size_t last = shape->count - 1;
    *direct = *rest = 0.0;
    if (z < 0.0) {
        *(last == 1 ? direct : rest) = lobe_value(shape, channel, last, x, y, -z);
        return;
    }
    *direct = lobe_value(shape, channel, 0, x, y, z);
    for (size_t k = 1; k < last; k++) *rest += lobe_value(shape, channel, k, x, y, z);
}

void lq_model_shape_value(const lq_model_shape *shape, double x, double y, double z,
                          double direct[LQ_STACK_CHANNELS], double rest[LQ_STACK_CHANNELS]) {
    for (int c = 0; c < LQ_STACK_CHANNELS; c++)
        if (c < shape->channels) channel_value(shape, c, x, y, z, &direct[c], &rest[c]);
        else {
            direct[c] = direct[0];
            rest[c] = rest[0];
        }
}
