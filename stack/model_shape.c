/* model_shape.c - the lobes of a model as densities of directions. */
#include "stack/model_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/status.h"

/* ======================================================================================
 *                                   Lobes of an incidence
 * ====================================================================================== */

static double least_alpha(const lq_shape_query *query) {
    return query->least_alpha > 0.0 ? query->least_alpha : LQ_SHAPE_LEAST_ALPHA;
}

static double cosine_of(double sine) {
    return lq_sine(fmin(fmax(sine, 0.0), 1.0));
}

static lq_status make_lobe(lq_shape_lobe *lobe, const lq_model_lobe *from, const lq_shape_query *query,
                           lq_error *error) {
    double albedo = 1.0;
    *lobe = (lq_shape_lobe){.energy = from->energy,
                            .alpha = fmin(fmax(from->alpha, least_alpha(query)), 1.0),
                            .from = lq_incidence_of(cosine_of(from->mean))};
    if (!(from->energy > 0.0)) return LQ_OK;
    const lq_status status =
        query->masked ? LQ_OK : lq_lobe_albedo(lobe->from.cosine, lobe->alpha, &albedo, error);
    lobe->scale = from->energy / albedo;
    return status;
}

static lq_model_query query_of(const lq_shape_query *query, lq_model_id model, const double *mu) {
    return (lq_model_query){.model = model,
                            .mu = mu,
                            .mu_count = 1,
                            .variant = query->variant,
                            .f = query->f,
                            .mapping = query->mapping,
                            .source = query->source,
                            .threads = query->threads};
}

static lq_status aim_lobes(lq_model_shape *shape, double mu, lq_error *error) {
    /* Below a coat over a Lambertian base there is no window: the model is baked then. */
    const lq_model_id model =
        lq_model_kinds[shape->query.model].windowed ? LQ_MODEL_BAKED : shape->query.model;
    const lq_model_query query = query_of(&shape->query, model, &mu);
    const size_t all = shape->count * (size_t)shape->channels;
    lq_model_lobe *lobes = calloc(all, sizeof *lobes);
    lq_status status = lobes ? lq_model_solve(shape->stack, &query, lobes, NULL, error)
                             : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu lobes", all);
    for (size_t i = 0; i < all && status == LQ_OK; i++) {
        status = make_lobe(&shape->lobes[i], &lobes[i], &shape->query, error);
        if (lobes[i].energy > 0.0) shape->sharpest = fmin(shape->sharpest, lobes[i].alpha);
    }
    free(lobes);
    return status;
}

/* ======================================================================================
 *                                  Lobes of a half vector
 * ====================================================================================== */

/* Index of the medium that light leaves into by lobe k. */
static double index_after(const lq_model_shape *shape, int channel, size_t k) {
    const size_t layers = shape->stack->layer_count;
    return k < layers ? 1.0 : shape->stack->layers[layers - 1].n.value[channel];
}

/* A cosine in the medium of that index as it is outside; beyond the critical angle along the horizon. */
static double outside(double cosine, double index) {
    return cosine_of(index * lq_sine(cosine));
}

static lq_status aim_grid(lq_model_shape *shape, double mu, lq_error *error) {
    if (!(mu >= 0.0 && mu <= 1.0)) return lq_fail(error, LQ_BAD_INPUT, "mu = %g; accepted: 0 <= mu <= 1", mu);
    const double sine = lq_incidence_of(mu).sine;
    for (size_t i = 0; i < shape->count * (size_t)shape->channels; i++) {
        const size_t k = i % shape->count;
        const double index = index_after(shape, (int)(i / shape->count), k);
        const lq_grid_lobe lobe = lq_shape_grid_at(&shape->grid, i, mu);
        shape->lobes[i] = (lq_shape_lobe){.energy = lobe.energy,
                                          .alpha = lobe.alpha,
                                          .scale = lobe.scale,
                                          .from = lq_incidence_of(cosine_of(sine / index))};
        if (lobe.energy > 0.0) shape->sharpest = fmin(shape->sharpest, lobe.alpha);
    }
    return LQ_OK;
}

/* A lobe about the normal has no half vector with the light. */
static lq_status make_grid(lq_model_shape *shape, lq_error *error) {
    const lq_model_query query = query_of(&shape->query, LQ_MODEL_B18_FORWARD, NULL);
    const lq_stack *stack = shape->stack;
    if (stack->layers[stack->layer_count - 1].type == LQ_LAYER_LAMBERTIAN)
        return lq_fail(error, LQ_BAD_INPUT, "a lambertian base; accepted by %s: a conductor, or none",
                       lq_model_names[shape->query.model]);
    return lq_shape_grid_make(&shape->grid, stack, &query, least_alpha(&shape->query), shape->query.masked,
                              error);
}

/* ======================================================================================
 *                                      Anisotropic lobes
 * ====================================================================================== */

static lq_status make_turned(lq_model_shape *shape, size_t i, const lq_turned_lobe *from, lq_error *error) {
    const double least = least_alpha(&shape->query);
    const double x = fmin(fmax(from->alpha_x, least), 1.0), y = fmin(fmax(from->alpha_y, least), 1.0);
    lq_shape_lobe *lobe = &shape->lobes[i];
    /* Round lobes are those of b18-forward to the last digit. */
    const lq_model_lobe round = {.energy = from->energy, .mean = from->mean, .alpha = from->alpha_x};
    if (from->energy > 0.0) shape->sharpest = fmin(shape->sharpest, fmin(from->alpha_x, from->alpha_y));
    if (x == y) return make_lobe(lobe, &round, &shape->query, error);
    *lobe = (lq_shape_lobe){.energy = from->energy,
                            .alpha = sqrt(x * y),
                            .scale = from->energy > 0.0 ? 1.0 : 0.0,
                            .from = lq_incidence_of(cosine_of(from->mean)),
                            .turned = true,
                            .ggx = {x, y, cos(from->angle), sin(from->angle)}};
    if (!(from->energy > 0.0)) return LQ_OK;
    const size_t k = i % shape->count;
    const double whole =
        shape->query.masked ? 1.0 : lq_model_shape_moments(shape, (int)(i / shape->count), k).energy;
    lobe->scale = from->energy / whole;
    return LQ_OK;
}

static lq_status aim_turned(lq_model_shape *shape, double mu, lq_error *error) {
    const lq_model_query query = query_of(&shape->query, shape->query.model, &mu);
    const size_t all = shape->count * (size_t)shape->channels;
    lq_turned_lobe *lobes = calloc(all, sizeof *lobes);
    lq_status status = lobes ? lq_model_y19(shape->stack, &query, shape->query.azimuth, lobes, error)
                             : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu lobes", all);
    for (size_t i = 0; i < all && status == LQ_OK; i++) status = make_turned(shape, i, &lobes[i], error);
    free(lobes);
    return status;
}

/* ======================================================================================
 *                                      Behind a window
 * ====================================================================================== */

static bool is_windowed(const lq_model_shape *shape) {
    return lq_model_kinds[shape->query.model].windowed &&
           shape->stack->layers[shape->stack->layer_count - 1].type != LQ_LAYER_LAMBERTIAN;
}

/* The top's lobe and the light that goes through as lobes in the direction of a mirror, and between them what
 * was inside, as the last layer's. */
static lq_status set_windowed(lq_model_shape *shape, int channel, double mu, const lq_windowed *from,
                              lq_error *error) {
    const lq_layer *layers = shape->stack->layers;
    const size_t last = shape->stack->layer_count - 1;
    lq_shape_lobe *lobes = shape->lobes + (size_t)channel * shape->count;
    const double away = cosine_of(mu), below = fmin(away / layers[last].n.value[channel], 1.0);
    const lq_model_lobe top = {.energy = from->top, .mean = away, .alpha = layers[0].alpha_x.value[channel]},
                        through = {.energy = from->through, .mean = below, .alpha = from->through_alpha};
    for (size_t k = 0; k < shape->count; k++) lobes[k] = (lq_shape_lobe){0};
    lq_status status = make_lobe(&lobes[0], &top, &shape->query, error);
    if (status == LQ_OK && layers[last].type == LQ_LAYER_DIELECTRIC)
        status = make_lobe(&lobes[last + 1], &through, &shape->query, error);
    if (last > 0 && from->inner.energy > 0.0)
        lobes[last] = (lq_shape_lobe){.energy = from->inner.energy,
                                      .alpha = from->inner.part[0].alpha,
                                      .scale = 1.0,
                                      .from = lq_incidence_of(mu),
                                      .window = from->inner};
    for (size_t k = 0; k < shape->count; k++)
        if (lobes[k].energy > 0.0) shape->sharpest = fmin(shape->sharpest, lobes[k].alpha);
    return status;
}

static lq_status aim_windowed(lq_model_shape *shape, double mu, lq_error *error) {
    lq_windowed made[LQ_STACK_CHANNELS];
    lq_status status =
        lq_model_windowed(shape->stack, mu, least_alpha(&shape->query), shape->query.threads, made, error);
    for (int c = 0; c < shape->channels && status == LQ_OK; c++)
        status = set_windowed(shape, c, mu, &made[c], error);
    return status;
}

/* ======================================================================================
 *                                      Rays and BRDFs
 * ====================================================================================== */

static bool of_rays(const lq_model_shape *shape) {
    return shape->query.model == LQ_MODEL_WEIDLICH_WILKIE ||
           shape->query.model == LQ_MODEL_WEIDLICH_WILKIE_CORRECTED;
}

static bool is_anisotropic(const lq_model_shape *shape) {
    return lq_model_kinds[shape->query.model].anisotropic;
}

static bool is_brdf(const lq_model_shape *shape, size_t k) {
    return of_rays(shape) || (k == 0 && shape->query.first != LQ_FIRST_OF_MODEL);
}

/* Their lobes have no energy known beforehand, and the roughness of their layers; the last is not there. */
static lq_status aim_rays(lq_model_shape *shape, double mu, lq_error *error) {
    if (!(mu >= 0.0 && mu <= 1.0)) return lq_fail(error, LQ_BAD_INPUT, "mu = %g; accepted: 0 <= mu <= 1", mu);
    for (size_t i = 0; i < shape->count * (size_t)shape->channels; i++) {
        const size_t k = i % shape->count;
        if (k + 1 == shape->count) continue;
        const lq_layer *layer = &shape->stack->layers[k];
        const double alpha =
            layer->type == LQ_LAYER_LAMBERTIAN ? 1.0 : layer->alpha_x.value[i / shape->count];
        shape->lobes[i] = (lq_shape_lobe){.energy = 1.0,
                                          .alpha = fmax(alpha, least_alpha(&shape->query)),
                                          .scale = 1.0,
                                          .from = lq_incidence_of(mu)};
        shape->sharpest = fmin(shape->sharpest, alpha);
    }
    return LQ_OK;
}

/* Energy of the top interface's BRDF: FGD of one scattering; a dielectric is a conductor without kappa. */
static lq_status single_energy(const lq_model_shape *shape, int channel, double *energy, lq_error *error) {
    const lq_layer *top = &shape->stack->layers[0];
    const lq_shape_lobe *lobe = &shape->lobes[(size_t)channel * shape->count];
    const lq_kind *kind = lq_kind_find("fgd", error);
    lq_settings settings = lq_settings_default();
    double estimate;
    settings.scattering = LQ_SINGLE;
    const double kappa = top->type == LQ_LAYER_CONDUCTOR ? top->kappa.value[channel] : 0.0;
    const double point[] = {lobe->from.cosine, lobe->alpha, top->n.value[channel], kappa};
    if (!kind) return LQ_BAD_INPUT;
    const lq_status status = lq_eval(kind, &settings, point, energy, &estimate, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* The first lobe is a BRDF: `scale` is what that is multiplied with. */
static lq_status aim_first(lq_model_shape *shape, lq_error *error) {
    lq_status status = LQ_OK;
    if (of_rays(shape) || shape->query.first == LQ_FIRST_OF_MODEL) return LQ_OK;
    for (int c = 0; c < shape->channels && status == LQ_OK; c++) {
        lq_shape_lobe *lobe = &shape->lobes[(size_t)c * shape->count];
        double energy = 0.0;
        status = single_energy(shape, c, &energy, error);
        lobe->scale = energy > 0.0 ? 1.0 : 0.0;
        if (shape->query.first == LQ_FIRST_SCALED && energy > 0.0) lobe->scale = lobe->energy / energy;
        else lobe->energy = energy;
    }
    return status;
}

static lq_status check_first(const lq_model_shape *shape, lq_error *error) {
    if (shape->query.first == LQ_FIRST_OF_MODEL) return LQ_OK;
    if (is_anisotropic(shape))
        return lq_fail(error, LQ_BAD_INPUT, "the first lobe of %s is the model's own",
                       lq_model_names[shape->query.model]);
    if (of_rays(shape))
        return lq_fail(error, LQ_BAD_INPUT, "the first lobe of %s is the top interface's BRDF already",
                       lq_model_names[shape->query.model]);
    if (shape->stack->layers[0].type != LQ_LAYER_LAMBERTIAN) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT,
                   "the first lobe of a bare lambertian surface is its own; accepted on top: an interface");
}

/* ======================================================================================
 *                                          All
 * ====================================================================================== */

lq_status lq_model_shape_aim(lq_model_shape *shape, double mu, lq_error *error) {
    shape->sharpest = 1.0;
    const lq_status status = of_rays(shape)          ? aim_rays(shape, mu, error)
                             : is_anisotropic(shape) ? aim_turned(shape, mu, error)
                             : is_windowed(shape)    ? aim_windowed(shape, mu, error)
                             : shape->grid.nodes > 0 ? aim_grid(shape, mu, error)
                                                     : aim_lobes(shape, mu, error);
    return status == LQ_OK ? aim_first(shape, error) : status;
}

/* What `query` does not say of any stack: lobes of pairs of directions, and what they refuse. */
static lq_status prepare(lq_model_shape *shape, double mu, lq_error *error) {
    lq_status status = check_first(shape, error);
    if (status != LQ_OK) return status;
    if (!of_rays(shape)) return lq_model_kinds[shape->query.model].of_pairs ? make_grid(shape, error) : LQ_OK;
    const lq_model_query query = {.mu = &mu, .mu_count = 1, .model = shape->query.model};
    status = lq_model_check(shape->stack, &query, error);
    return status == LQ_OK ? lq_weidlich_check(shape->stack, error) : status;
}

lq_status lq_model_shape_make(lq_model_shape *shape, const lq_stack *stack, const lq_shape_query *query,
                              double mu, lq_error *error) {
    *shape = (lq_model_shape){.stack = stack,
                              .query = *query,
                              .channels = lq_stack_channels(stack),
                              .count = lq_model_lobe_count(stack),
                              .rays = {.stack = stack,
                                       .corrected = query->model == LQ_MODEL_WEIDLICH_WILKIE_CORRECTED,
                                       .least_alpha = least_alpha(query)}};
    shape->lobes = calloc(shape->count * (size_t)shape->channels, sizeof *shape->lobes);
    lq_status status =
        shape->lobes ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu lobes", shape->count);
    if (status == LQ_OK) status = prepare(shape, mu, error);
    return status == LQ_OK ? lq_model_shape_aim(shape, mu, error) : status;
}

void lq_model_shape_free(lq_model_shape *shape) {
    lq_shape_grid_free(&shape->grid);
    free(shape->lobes);
    *shape = (lq_model_shape){0};
}

/* ======================================================================================
 *                                        Values
 * ====================================================================================== */

double lq_model_shape_lobe(const lq_model_shape *shape, int channel, size_t k, double x, double y, double z) {
    const size_t at = (size_t)channel * shape->count + k;
    const lq_shape_lobe *lobe = &shape->lobes[at];
    double scale = lobe->scale, alpha = lobe->alpha;
    if (!(scale > 0.0)) return 0.0;
    if (is_brdf(shape, k)) return scale * lq_weidlich_value(&shape->rays, channel, k, lobe->from, x, y, z);
    if (lobe->window.n > 0.0) return lq_window_value(&lobe->window, lobe->from, x, y, z);
    if (lobe->turned) return scale * lq_lobe_turned_density(lobe->from, &lobe->ggx, x, y, z);
    if (shape->grid.nodes > 0) {
        const double half = lq_incidence_half(lobe->from, x, z);
        const lq_grid_lobe other =
            lq_shape_grid_at(&shape->grid, at, outside(half, index_after(shape, channel, k)));
        scale = other.scale;
        alpha = other.alpha;
    }
    return scale > 0.0 ? scale * lq_lobe_density(lobe->from, alpha, x, y, z) : 0.0;
}

static void channel_value(const lq_model_shape *shape, int channel, double x, double y, double z,
                          double *direct, double *rest) {
    const size_t last = shape->count - 1;
    *direct = *rest = 0.0;
    if (z < 0.0) {
        *(last == 1 ? direct : rest) = lq_model_shape_lobe(shape, channel, last, x, y, -z);
        return;
    }
    *direct = lq_model_shape_lobe(shape, channel, 0, x, y, z);
    for (size_t k = 1; k < last; k++) *rest += lq_model_shape_lobe(shape, channel, k, x, y, z);
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
