/* model.c - what models refuse, and B18's: the layers of a stack, from the top, through its adding. */
#include "stack/model.h"

#include <math.h>
#include <string.h>

#include "stack/description.h"
#include "stack/model_baked.h"
#include "stack/spread.h"
#include "system/parallel.h"
#include "system/status.h"

size_t lq_model_lobe_count(const lq_stack *stack) {
    return stack->layer_count + 1;
}

/* ======================================================================================
 *                                     What is refused
 * ====================================================================================== */

static lq_status check_base(size_t coats, lq_model_id model, lq_error *error) {
    if (coats <= 1 || !lq_model_kinds[model].one_coat) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT,
                   "a lambertian base under %zu coats; accepted in a model: one coat, or none", coats);
}

/* Forward scattering is a lobe of its own; what goes back is another, which the model does not have. */
static lq_status check_medium(const lq_layer *layer, const lq_layer *below, size_t number, lq_error *error) {
    if (layer->type != LQ_LAYER_DIELECTRIC || !lq_medium_scatters(&layer->medium)) return LQ_OK;
    if (below && below->type == LQ_LAYER_LAMBERTIAN)
        return lq_fail(
            error, LQ_BAD_INPUT,
            "layer %zu has a medium that scatters, over a lambertian base; accepted there: tau, or "
            "sigma_s = 0",
            number);
    for (int c = 0; c < LQ_STACK_CHANNELS; c++)
        if (!(layer->medium.g.value[c] > 0.0))
            return lq_fail(error, LQ_BAD_INPUT,
                           "layer %zu scatters with g = %g; accepted in a model: 0 < g < 1", number,
                           layer->medium.g.value[c]);
    return LQ_OK;
}

static lq_status check_layer(const lq_stack *stack, size_t i, lq_model_id model, lq_error *error) {
    const lq_layer *layer = &stack->layers[i];
    if (layer->type == LQ_LAYER_LAMBERTIAN) return check_base(i, model, error);
    if (strcmp(layer->ndf, "ggx") == 0)
        return check_medium(layer, i + 1 < stack->layer_count ? layer + 1 : NULL, i + 1, error);
    return lq_fail(error, LQ_BAD_INPUT,
                   "layer %zu has the NDF %.60s; accepted: ggx, as the lobes of the model", i + 1,
                   layer->ndf);
}

lq_status lq_model_check(const lq_stack *stack, const lq_model_query *query, lq_error *error) {
    const lq_stack_query light = {.mu = query->mu, .mu_count = query->mu_count};
    const lq_model_kind *kind = &lq_model_kinds[query->model];
    const unsigned solved =
        (kind->scattering ? LQ_SOLVED_SCATTERING : 0U) | (kind->anisotropic ? LQ_SOLVED_ANISOTROPIC : 0U);
    lq_status status = lq_stack_solvable_by(stack, &light, solved, error);
    for (size_t i = 0; i < stack->layer_count && status == LQ_OK; i++)
        status = check_layer(stack, i, query->model, error);
    return status;
}

/* ======================================================================================
 *                                  One cosine and channel
 * ====================================================================================== */

typedef struct passage {
    const lq_stack *stack;
    const lq_model_tables *tables;
    int channel;
    double mu; /* of incidence */
    lq_model_ray ray;
    lq_model_sum sum;
    double above; /* index over the medium that `ray` is in */
} passage;

static double sine_of(double cosine) {
    return lq_sine(fmin(fmax(cosine, 0.0), 1.0));
}

/* A lobe in the direction of a mirror, for all light that was inside comes back by the way it came. */
static lq_model_lobe mirrored(const passage *p, lq_flow flow) {
    if (!(flow.energy > 0.0)) return (lq_model_lobe){0};
    return (lq_model_lobe){flow.energy, sine_of(p->mu), flow.variance,
                           lq_model_roughness(p->tables->mapping, flow.variance)};
}

static lq_status interface_of(passage *p, const lq_layer *layer, double looked_up, lq_model_interface *i,
                              lq_error *error) {
    const int c = p->channel;
    const double alpha = layer->alpha_x.value[c], n = layer->n.value[c];
    return layer->type == LQ_LAYER_DIELECTRIC
               ? lq_model_dielectric(p->tables, &p->ray, n, alpha, looked_up, i, error)
               : lq_model_conductor(p->tables, p->ray, n, layer->kappa.value[c], alpha, looked_up, i, error);
}

static void cross(passage *p, const lq_medium *medium) {
    lq_model_cross(&p->sum, lq_model_medium(p->tables, medium, p->channel, p->ray.cosine));
}

/* The medium below interface `at`, for the light of the one below that: first what is totally reflected at
 * its upper side, which then crosses like all else. */
static lq_status go_down(passage *p, size_t at, double looked_up, lq_error *error) {
    double pass;
    const lq_status status = lq_model_pass(p->tables, p->ray, p->above, looked_up, &pass, error);
    if (status != LQ_OK) return status;
    lq_model_reflect_back(&p->sum, pass);
    cross(p, &p->stack->layers[at].medium);
    return LQ_OK;
}

static lq_status add_layer(passage *p, size_t at, lq_model_lobe *lobe, lq_error *error) {
    const lq_layer *layer = &p->stack->layers[at];
    const double looked_up =
        lq_model_lookup_alpha(p->tables, p->sum.t0i.variance, layer->alpha_x.value[p->channel]);
    const double here = p->ray.index;
    lq_model_interface interface;
    lq_status status = at > 0 ? go_down(p, at - 1, looked_up, error) : LQ_OK;
    if (status == LQ_OK) status = interface_of(p, layer, looked_up, &interface, error);
    if (status != LQ_OK) return status;
    *lobe = mirrored(p, lq_model_add(&p->sum, &interface));
    p->above = here;
    return LQ_OK;
}

static lq_status add_diffuse(passage *p, size_t at, lq_model_lobe *lobe, lq_error *error) {
    const lq_layer *base = &p->stack->layers[at], *top = &p->stack->layers[0];
    const int c = p->channel;
    lq_model_coat coat = {.mu = p->mu, .eta = 1.0, .tau = 1.0, .rho = base->rho.value[c]};
    if (at > 0) {
        coat.eta = top->n.value[c];
        coat.alpha = top->alpha_x.value[c];
        coat.tau = lq_medium_transmittance(&top->medium, c);
    }
    const lq_status status = lq_model_diffuse(p->tables, &coat, &lobe->energy, &lobe->alpha, error);
    lobe->variance = lq_model_variance(p->tables->mapping, lobe->alpha);
    return status;
}

/* What is left below the last interface, across its medium. */
static void go_through(passage *p, size_t last, lq_model_lobe *lobe) {
    const lq_layer *layer = &p->stack->layers[last];
    if (layer->type != LQ_LAYER_DIELECTRIC || !(p->sum.t0i.energy > 0.0)) return;
    cross(p, &layer->medium);
    *lobe = mirrored(p, p->sum.t0i);
    lobe->mean = lobe->energy > 0.0 ? sine_of(p->ray.cosine) : 0.0;
}

static lq_status pass_down(passage *p, lq_model_lobe *lobes, lq_error *error) {
    const size_t count = p->stack->layer_count;
    memset(lobes, 0, (count + 1) * sizeof *lobes);
    for (size_t i = 0; i < count; i++) {
        const bool diffuse = p->stack->layers[i].type == LQ_LAYER_LAMBERTIAN;
        if (!diffuse && p->ray.cosine == 0.0) break;
        const lq_status status =
            diffuse ? add_diffuse(p, i, &lobes[i], error) : add_layer(p, i, &lobes[i], error);
        if (status != LQ_OK) return status;
    }
    go_through(p, count - 1, &lobes[count]);
    return LQ_OK;
}

/* ======================================================================================
 *                                          All
 * ====================================================================================== */

typedef struct job {
    const lq_stack *stack;
    const lq_model_query *query;
    lq_model_tables tables;
    lq_model_lobe *lobes;
} job;

/* Tables take light along the horizon for light just above it. */
static const double LEAST_MU = 1e-6;

/* One cosine. */
static lq_status turn(void *user, size_t m, int thread, lq_error *error) {
    (void)thread;
    const job *j = user;
    const int channels = lq_stack_channels(j->stack);
    const double mu = fmax(j->query->mu[m], LEAST_MU);
    lq_model_memo memo = {0};
    lq_model_tables tables = j->tables;
    lq_status status = LQ_OK;
    tables.memo = &memo;
    for (int c = 0; c < channels && status == LQ_OK; c++) {
        passage p = {.stack = j->stack,
                     .tables = &tables,
                     .channel = c,
                     .mu = mu,
                     .ray = {mu, 1.0},
                     .sum = lq_model_nothing(),
                     .above = 1.0};
        const size_t line = m * (size_t)channels + (size_t)c;
        status = pass_down(&p, j->lobes + line * lq_model_lobe_count(j->stack), error);
    }
    return status;
}

static lq_status solve_b18(const lq_stack *stack, const lq_model_query *query, lq_model_lobe *lobes,
                           const lq_progress *progress, lq_error *error) {
    const job j = {
        stack, query, {query->variant, query->mapping, query->tolerance, NULL, query->source}, lobes};
    return lq_parallel(query->mu_count, query->threads, turn, (void *)&j, progress, error);
}

lq_status lq_model_solve(const lq_stack *stack, const lq_model_query *query, lq_model_lobe *lobes,
                         const lq_progress *progress, lq_error *error) {
    lq_model_query mapped = *query;
    lq_model_mapping own;
    lq_status status = lq_model_check(stack, query, error);
    if (lq_model_kinds[query->model].of_pairs || lq_model_kinds[query->model].anisotropic ||
        lq_model_kinds[query->model].windowed)
        return lq_fail(error, LQ_BAD_INPUT, "%s has no lobes that one roughness describes",
                       lq_model_names[query->model]);
    if (!query->mapping) {
        mapped.mapping = &own;
        if (status == LQ_OK) status = lq_model_mapping_make(&own, query->f, error);
    }
    if (status != LQ_OK) return status;
    return query->model == LQ_MODEL_BAKED ? lq_model_baked(stack, &mapped, lobes, progress, error)
                                          : solve_b18(stack, &mapped, lobes, progress, error);
}

/* ======================================================================================
 *                                     As light of a stack
 * ====================================================================================== */

static void add_moments(lq_stack_lobe *sum, const lq_model_lobe *lobe) {
    if (!(lobe->energy > 0.0)) return;
    const lq_stack_lobe one = lq_spread_lobe(lq_sine(fmin(lobe->mean, 1.0)), lobe->alpha);
    sum->energy += lobe->energy;
    sum->sin2 += lobe->energy * one.sin2;
    sum->mean += lobe->energy * one.mean;
    sum->across += lobe->energy * one.across;
}

static lq_stack_lobe normalised(lq_stack_lobe sum) {
    if (!(sum.energy > 0.0)) return (lq_stack_lobe){0};
    return (lq_stack_lobe){sum.energy, sum.sin2 / sum.energy, sum.mean / sum.energy, sum.across / sum.energy};
}

lq_stack_light lq_model_light(const lq_stack *stack, const lq_model_lobe *lobes) {
    lq_stack_lobe reflected = {0}, through = {0};
    for (size_t k = 0; k < stack->layer_count; k++) add_moments(&reflected, &lobes[k]);
    add_moments(&through, &lobes[stack->layer_count]);
    return (lq_stack_light){.reflected = normalised(reflected), .transmitted = normalised(through)};
}
