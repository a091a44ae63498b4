/* walk_stack.c - lq_stack_walk: what rays through all of a stack add up to. */
#include "validate/walk_stack.h"

#include "stack/description.h"
#include "system/status.h"
#include "validate/walk_reduce.h"

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

typedef struct sampled {
    lq_walk_pile pile; /* of one channel */
    double mu;
    size_t paths;
} sampled;

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
    const sampled *s = data;
    lq_traveller t;
    size_t meetings;
    const lq_fate fate = lq_walk_through(&s->pile, s->mu, stream, &t, &meetings);
    const size_t path = (meetings < s->paths ? meetings : s->paths) - 1;
    if (fate == LQ_GIVEN_UP) values[s->paths * PATH_VALUES] = t.ray.weight;
    else if (fate != LQ_ABSORBED)
        leave(&t, &values[path * PATH_VALUES + (fate == LQ_RETURNED ? 0 : SIDE_VALUES)]);
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

static lq_status walk_one(const sampled *p, const lq_walk *walk, lq_stack_walked *walked, lq_error *error) {
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
        sampled p = {.paths = query->paths ? query->paths : 1};
        status = lq_walk_pile_make(&p.pile, stack, query, (int)c, 1, error);
        for (size_t m = 0; m < query->mu_count && status == LQ_OK; m++) {
            p.mu = query->mu[m];
            walk.purpose = m * channels + c;
            status = walk_one(&p, &walk, &walked[walk.purpose * p.paths], error);
            if (status == LQ_OK && progress &&
                !progress->report(progress->user, (double)++done / (double)count))
                status = lq_fail(error, LQ_CANCELLED, "stopped");
        }
        lq_walk_pile_free(&p.pile);
    }
    return status;
}
