/* walk_stack.c - lq_stack_walk: a stack made ready for rays, rays through all of it, and what they add up to.
 */
#include "validate/walk_stack.h"

#include <math.h>
#include <stdlib.h>

#include "stack/description.h"
#include "system/status.h"
#include "validate/walk_reduce.h"

/* No light needs so many; only a lossless trap does, such as a mirror below total reflection. */
static const long MOST_HITS = 1000000;

/* What one sample adds for each number of meetings with the first interface, on either side (0 the light's
 * own). The sums with the energy give the covariance that the error of a ratio needs. */
enum {
    ENERGY,
    SIN2,
    MEAN,
    ACROSS,
    MOMENTS,
    SUM = MOMENTS - 1,
    SIDE_VALUES = SUM + MOMENTS,
    PATH_VALUES = 2 * SIDE_VALUES
};
_Static_assert(LQ_STACK_WALK_PATHS *PATH_VALUES + 1 <= LQ_WALK_MAX_VALUES, "a walk has room for its values");

/* One channel of a stack. */
typedef struct pile {
    size_t count;
    lq_walk_interface *interface;
    double *log_tau; /* of the media, [count + 1]; the first is outside */
    bool from_below;
    double mu;
    size_t paths;
} pile;

/* ======================================================================================
 *                                       One ray
 * ====================================================================================== */

static lq_traveller arrive(const pile *p) {
    const double s = lq_sine(p->mu);
    const double entering = p->from_below ? lq_ray_crossing(p->log_tau[p->count], p->mu) : 1.0;
    return (lq_traveller){.ray = {.z = -p->mu, .s = s, .weight = entering},
                          .x = s,
                          .side = p->from_below ? 1 : 0,
                          .hits_left = MOST_HITS};
}

static void leave(const lq_traveller *t, double *values) {
    const double energy = t->ray.weight;
    values[ENERGY] = energy;
    values[SIN2] = energy * (t->x * t->x + t->y * t->y);
    values[MEAN] = energy * t->x;
    values[ACROSS] = energy * t->y * t->y;
    for (int i = SIN2; i < MOMENTS; i++) values[SUM + i] = energy + values[i];
}

/* The last of the values is the energy that was given up. */
static void sample(const void *data, lq_stream *stream, double *values) {
    const pile *p = data;
    const size_t first = p->from_below ? p->count - 1 : 0;
    lq_traveller t = arrive(p);
    size_t meetings = 0;
    for (size_t at = first;;) {
        meetings += at == first;
        lq_walk_meet(&p->interface[at], &t, stream);
        if (t.hits_left <= 0) {
            values[p->paths * PATH_VALUES] = t.ray.weight;
            return;
        }
        const size_t medium = at + (size_t)t.side;
        t.ray.weight *= lq_ray_crossing(p->log_tau[medium], t.ray.z);
        if (medium == 0 || medium == p->count) {
            const bool returns = (medium > 0) == p->from_below;
            const size_t path = (meetings < p->paths ? meetings : p->paths) - 1;
            leave(&t, &values[path * PATH_VALUES + (returns ? 0 : SIDE_VALUES)]);
            return;
        }
        lq_ray_roulette(&t.ray, stream);
        if (!(t.ray.weight > 0.0)) return;
        at = t.side ? at + 1 : at - 1;
        t.side = 1 - t.side;
        t.ray.z = -t.ray.z;
    }
}

/* ======================================================================================
 *                                     Made ready
 * ====================================================================================== */

static lq_status make_rough(lq_walk_interface *f, const lq_layer *layer, double alpha, lq_error *error) {
    lq_status status = lq_ndf_open(&f->ndf, layer->ndf, error);
    f->alpha = alpha;
    if (status == LQ_OK && alpha > 0.0) status = lq_ndf_prepare(f->ndf, alpha, error);
    if (status == LQ_OK && f->rough) lq_visible_make(&f->visible, f->ndf, alpha, true);
    return status;
}

static lq_status make_interface(lq_walk_interface *f, const lq_layer *layer, int channel, double n_above,
                                bool single, lq_error *error) {
    const double n = layer->n.value[channel], alpha = layer->alpha_x.value[channel];
    f->opaque = layer->type != LQ_LAYER_DIELECTRIC;
    f->diffuse = layer->type == LQ_LAYER_LAMBERTIAN;
    f->once = single;
    if (f->diffuse) {
        f->rho = layer->rho.value[channel];
        return LQ_OK;
    }
    f->n = n / n_above;
    f->kappa = layer->kappa.value[channel] / n_above;
    f->eta[0] = n / n_above;
    f->eta[1] = n_above / n;
    /* An interface between equal media is none, however often a grazing ray would have to cross it. */
    f->rough = alpha > 0.0 && (f->opaque || n != n_above);
    return make_rough(f, layer, alpha, error);
}

static void pile_free(pile *p) {
    for (size_t i = 0; p->interface && i < p->count; i++) lq_ndf_close(p->interface[i].ndf);
    free(p->interface);
    free(p->log_tau);
}

/* Free it whatever comes back. */
static lq_status pile_make(pile *p, const lq_stack *stack, const lq_stack_query *query, int channel,
                           lq_error *error) {
    const size_t count = stack->layer_count;
    *p = (pile){.count = count, .from_below = query->from_below, .paths = query->paths ? query->paths : 1};
    p->interface = calloc(count, sizeof *p->interface);
    p->log_tau = calloc(count + 1, sizeof *p->log_tau);
    if (!p->interface || !p->log_tau)
        return lq_fail(error, LQ_NO_MEMORY, "no memory for a stack of %zu layers", count);
    lq_status status = LQ_OK;
    double n_above = 1.0;
    for (size_t i = 0; i < count && status == LQ_OK; i++) {
        const lq_layer *layer = &stack->layers[i];
        status = make_interface(&p->interface[i], layer, channel, n_above, query->single, error);
        n_above = layer->n.value[channel];
        if (layer->type == LQ_LAYER_DIELECTRIC)
            p->log_tau[i + 1] = log(lq_medium_transmittance(&layer->medium, channel));
    }
    return status;
}

/* ======================================================================================
 *                                     All of them
 * ====================================================================================== */

static void read_lobe(const lq_walk_mean *m, lq_stack_lobe *mean, lq_stack_lobe *noise) {
    lq_walk_mean ratio[MOMENTS];
    for (int i = SIN2; i < MOMENTS; i++) ratio[i] = lq_walk_ratio(m[i], m[ENERGY], m[SUM + i]);
    *mean = (lq_stack_lobe){m[ENERGY].mean, ratio[SIN2].mean, ratio[MEAN].mean, ratio[ACROSS].mean};
    *noise = (lq_stack_lobe){m[ENERGY].error, ratio[SIN2].error, ratio[MEAN].error, ratio[ACROSS].error};
}

static lq_status walk_one(const pile *p, const lq_walk *walk, lq_stack_walked *walked, lq_error *error) {
    lq_walk_mean m[LQ_WALK_MAX_VALUES];
    const size_t count = p->paths * PATH_VALUES + 1;
    const lq_status status = lq_walk_reduce(walk, sample, p, count, m, error);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < p->paths; i++) {
        const lq_walk_mean *path = &m[i * PATH_VALUES];
        read_lobe(path, &walked[i].light.reflected, &walked[i].reflected_noise);
        read_lobe(path + SIDE_VALUES, &walked[i].light.transmitted, &walked[i].transmitted_noise);
        walked[i].light.error = m[count - 1].mean;
    }
    return LQ_OK;
}

static lq_status check(const lq_stack *stack, const lq_stack_query *query, size_t samples, lq_error *error) {
    if (query->paths > LQ_STACK_WALK_PATHS)
        return lq_fail(error, LQ_BAD_INPUT, "%zu paths of a random walk; accepted: up to %d", query->paths,
                       LQ_STACK_WALK_PATHS);
    if (samples < 2 || samples > LQ_WALK_MAX_SAMPLES)
        return lq_fail(error, LQ_BAD_INPUT, "random walk: %zu samples, accepted are 2 to %zu", samples,
                       (size_t)LQ_WALK_MAX_SAMPLES);
    return lq_stack_solvable(stack, query, error);
}

lq_status lq_stack_walk(const lq_stack *stack, const lq_stack_query *query, size_t samples, size_t seed,
                        lq_stack_walked *walked, const lq_progress *progress, lq_error *error) {
    lq_status status = check(stack, query, samples, error);
    const size_t channels = (size_t)lq_stack_channels(stack), count = query->mu_count * channels;
    lq_walk walk = {.samples = samples, .seed = seed, .threads = query->threads};
    for (size_t c = 0, done = 0; c < channels && status == LQ_OK; c++) {
        pile p;
        status = pile_make(&p, stack, query, (int)c, error);
        for (size_t m = 0; m < query->mu_count && status == LQ_OK; m++) {
            p.mu = query->mu[m];
            walk.purpose = m * channels + c;
            status = walk_one(&p, &walk, &walked[walk.purpose * p.paths], error);
            if (status == LQ_OK && progress &&
                !progress->report(progress->user, (double)++done / (double)count))
                status = lq_fail(error, LQ_CANCELLED, "stopped");
        }
        pile_free(&p);
    }
    return status;
}
