/* level.c - surfaces solved side by side, their blocks added, rewards paid. */
#include "stack/level.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stack/pile.h"
#include "system/blas.h"
#include "system/parallel.h"
#include "system/status.h"

/* Nodes of each element of a medium's axis where it has many, from LQ_LEVEL_TRIAL on. Where they limit
 * (smooth interfaces among rough ones), 9 and 10 are off by the same 1e-4, and agree. */
static const int axis_nodes[LQ_SURFACE_LEVELS + 1] = {9, 12, 16, 20, 26, 34, 44, 56};

/* Few elements have so many times as many each: behind an interface of alpha = 1 a lone one needs 24 for
 * 1e-5. Rewards outside the stack are smooth. */
static int nodes_of(int level, int elements, bool outer) {
    static const double shares[] = {2.4, 1.55, 1.4, 1.1};
    const double share = outer ? 0.9 : elements <= 4 ? shares[elements - 1] : 1.0;
    return (int)(axis_nodes[level - LQ_LEVEL_TRIAL] * share);
}

typedef struct solving {
    const lq_plan *plan;
    const lq_stack_query *query;
    int level;
    lq_node_axis *axis;     /* of the plan's */
    bool *outer;            /* of these, those that light meets outside the stack alone */
    lq_surface_work **work; /* of the plan's surfaces, while they are solved */
    double **entry;         /* cosines of both sides of each surface: [2 * surface + side] */
    lq_block (*block)[LQ_STACK_CHANNELS][LQ_MODES]; /* of each surface and material */
    size_t *first;   /* rows, or batches, of the surfaces before: surfaces + 1 */
    size_t from, to; /* surfaces that are solved together */
    lq_stack_light *light;
} solving;

/* ======================================================================================
 *                                      Surfaces
 * ====================================================================================== */

static size_t inside_count(const solving *s, const lq_plan_surface *surface, int side) {
    return surface->inside[side] ? (size_t)s->axis[surface->axis[side]].count : 0;
}

/* Below this cosine light needs more depths. */
static const double GRAZING = 0.004;

static bool is_grazing(const lq_stack_query *query) {
    for (size_t i = 0; i < query->mu_count; i++)
        if (query->mu[i] < GRAZING) return true;
    return false;
}

static lq_status fill_entries(solving *s, size_t index, lq_surface *spec, lq_error *error) {
    const lq_plan_surface *surface = &s->plan->surface[index];
    for (int side = 0; side < 2; side++) {
        const size_t inside = inside_count(s, surface, side);
        const size_t asked = surface->asked[side] ? s->query->mu_count : 0;
        double *mu = s->entry[2 * index + (size_t)side] = malloc((inside + asked + 1) * sizeof *mu);
        if (!mu) return lq_fail(error, LQ_NO_MEMORY, "no memory for the cosines of an interface");
        memcpy(mu, s->axis[surface->axis[side]].mu, inside * sizeof *mu);
        memcpy(mu + inside, s->query->mu, asked * sizeof *mu);
        spec->grazing |= surface->asked[side] && is_grazing(s->query);
        spec->entry[side] = mu;
        spec->entry_count[side] = inside + asked;
        spec->axis[side] = &s->axis[surface->axis[side]];
        if (!s->outer[surface->axis[side]]) spec->sharp[side] = s->plan->axis[surface->axis[side]].sharp;
    }
    if (spec->opaque) spec->axis[1] = NULL;
    return LQ_OK;
}

static lq_status begin_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    solving *s = user;
    const size_t index = s->from + turn;
    lq_surface spec = s->plan->surface[index].spec;
    const lq_status status = fill_entries(s, index, &spec, error);
    return status == LQ_OK ? lq_surface_begin(&s->work[index], &spec, s->level, error) : status;
}

/* The surface that owns a turn, and its own number there. */
static lq_surface_work *owner(const solving *s, size_t turn, size_t *own) {
    size_t i = s->from;
    while (turn >= s->first[i - s->from + 1]) i++;
    *own = turn - s->first[i - s->from];
    return s->work[i];
}

static lq_status row_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    size_t own;
    lq_surface_work *work = owner(user, turn, &own);
    return lq_surface_row(work, own, error);
}

static lq_status batch_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    size_t own;
    lq_surface_work *work = owner(user, turn, &own);
    return lq_surface_batch(work, own, error);
}

static lq_status block_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    solving *s = user;
    const size_t index = s->from + turn;
    lq_status status = LQ_OK;
    for (int m = 0; m < s->plan->surface[index].spec.materials && status == LQ_OK; m++)
        status = lq_surface_blocks(s->work[index], m, s->block[index][m], error);
    lq_surface_end(s->work[index]);
    s->work[index] = NULL;
    return status;
}

static size_t count_turns(solving *s, size_t (*turns)(const lq_surface_work *)) {
    size_t sum = 0;
    for (size_t i = s->from; i < s->to; i++) {
        s->first[i - s->from] = sum;
        sum += turns(s->work[i]);
    }
    return s->first[s->to - s->from] = sum;
}

/* Work space of this many surfaces is held at once: some megabytes each. */
enum { TOGETHER = 32 };

static lq_status solve_together(solving *s, const lq_progress *progress, lq_error *error) {
    const size_t count = s->to - s->from;
    const int threads = s->query->threads;
    lq_status status = lq_parallel(count, threads, begin_turn, s, NULL, error);
    if (status == LQ_OK)
        status = lq_parallel(count_turns(s, lq_surface_rows), threads, row_turn, s, progress, error);
    if (status == LQ_OK)
        status = lq_parallel(count_turns(s, lq_surface_batches), threads, batch_turn, s, progress, error);
    if (status == LQ_OK) status = lq_parallel(count, threads, block_turn, s, NULL, error);
    return status;
}

static lq_status solve_surfaces(solving *s, const lq_progress *progress, lq_error *error) {
    const size_t all = s->plan->surface_count;
    lq_status status = LQ_OK;
    for (s->from = 0; s->from < all && status == LQ_OK; s->from = s->to) {
        s->to = all - s->from < TOGETHER ? all : s->from + TOGETHER;
        status = solve_together(s, progress, error);
    }
    return status;
}

/* ======================================================================================
 *                                       Layers
 * ====================================================================================== */

/* One mode of a step of a chain, the right way up; rows of light from outside where it is the first. */
static lq_status step_block(const solving *s, const lq_plan_step *step, bool first, int mode, lq_block *block,
                            lq_error *error) {
    const lq_plan_surface *surface = &s->plan->surface[step->surface];
    const lq_block *all = &s->block[step->surface][step->material][mode];
    const int front = step->flipped ? 1 : 0;
    const size_t inside = inside_count(s, surface, front);
    const lq_block_rows rows = {
        .flipped = step->flipped,
        .from = {first ? inside : 0, 0},
        .count = {first ? s->query->mu_count : inside, inside_count(s, surface, 1 - front)}};
    return lq_block_part(all, &rows, block, error);
}

static double crossing(double tau, double mu) {
    return tau == 1.0 ? 1.0 : tau > 0.0 && mu > 0.0 ? exp(log(tau) / mu) : 0.0;
}

static lq_status fill_steps(const solving *s, const lq_plan_chain *chain, int mode, lq_pile *pile,
                            lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t i = 0; i < chain->steps && status == LQ_OK; i++)
        status = step_block(s, &chain->step[i], i == 0, mode, &pile->block[i], error);
    for (size_t i = 0; i <= chain->steps && status == LQ_OK; i++) {
        const lq_node_axis *axis = &s->axis[chain->medium[i].axis];
        for (int j = 0; j < axis->count; j++)
            pile->crossing[i][j] = crossing(chain->medium[i].tau, axis->mu[j]);
    }
    return status;
}

/* The rewards of a mode at the nodes of an outer axis: 1, then sin^2, or the one there is. */
static void fill_rewards(const lq_node_axis *axis, const double *crossings, int mode, double *reward) {
    const size_t n = (size_t)axis->count;
    for (size_t j = 0; j < n; j++) {
        const double sine2 = (1.0 - axis->mu[j]) * (1.0 + axis->mu[j]), pays = crossings ? crossings[j] : 0.0;
        reward[j] = pays * (mode == 2 ? sine2 : 1.0);
        reward[n + j] = pays * sine2;
    }
}

/* Flux-weighted sums of one cosine, channel and path. */
typedef struct flux {
    double energy, sin2, mean, cos2phi;
} flux;

static lq_stack_lobe lobe_of(const flux *f) {
    lq_stack_lobe lobe = {0};
    if (!(f->energy > 0.0)) return lobe;
    lobe.energy = f->energy;
    lobe.sin2 = fmin(fmax(f->sin2 / f->energy, 0.0), 1.0);
    lobe.mean = fmin(fmax(f->mean / f->energy, -1.0), 1.0);
    lobe.across = fmin(fmax(0.5 * (f->sin2 - f->cos2phi) / f->energy, 0.0), lobe.sin2);
    return lobe;
}

/* Add the values of one mode; `arrives`: what a crossing of the medium outside leaves of the light. */
static void pay(flux *f, int mode, const double *value, double sine, double arrives) {
    if (mode == 0) {
        f->energy = arrives * value[0];
        f->sin2 = arrives * value[1];
    }
    if (mode == 1) f->mean = arrives * sine * value[0];
    if (mode == 2) f->cos2phi = arrives * value[0];
}

static size_t paths_of(const lq_stack_query *query) {
    return query->paths ? query->paths : 1;
}

/* One mode into the sums of every cosine, path and side; `values` is as large as they are twice. */
static lq_status solve_mode(const solving *s, const lq_plan_chain *chain, int mode, double *values,
                            flux *sums, lq_error *error) {
    const size_t paths = paths_of(s->query);
    double reward[2][2 * LQ_NODES_MAX];
    lq_pile pile;
    lq_status status = lq_pile_make(&pile, chain, error);
    if (status == LQ_OK) status = fill_steps(s, chain, mode, &pile, error);
    if (status == LQ_OK) {
        fill_rewards(&s->axis[chain->medium[0].axis], pile.crossing[0], mode, reward[0]);
        fill_rewards(&s->axis[chain->medium[chain->steps].axis], pile.crossing[chain->steps], mode,
                     reward[1]);
        status = lq_pile_values(&pile, reward[0], reward[1], paths, values, error);
    }
    lq_pile_free(&pile);
    for (size_t i = 0; i < 2 * paths * s->query->mu_count && status == LQ_OK; i++) {
        const double mu = s->query->mu[i / 2 / paths];
        pay(&sums[i], mode, values + 2 * i, lq_sine(mu), crossing(chain->medium[0].tau, mu));
    }
    return status;
}

static lq_status solve_channel(const solving *s, int channel, lq_error *error) {
    const lq_plan_chain *chain = &s->plan->chain[channel];
    const size_t paths = paths_of(s->query), count = s->query->mu_count;
    flux *sums = calloc(2 * paths * count + 1, sizeof *sums);
    double *values = malloc((4 * paths * count + 1) * sizeof *values);
    lq_status status =
        sums && values ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    for (int mode = 0; mode < LQ_MODES && status == LQ_OK; mode++)
        status = solve_mode(s, chain, mode, values, sums, error);
    for (size_t i = 0; i < count * paths && status == LQ_OK; i++) {
        const size_t m = i / paths,
                     place = (m * (size_t)s->plan->channels + (size_t)channel) * paths + i % paths;
        s->light[place].reflected = lobe_of(&sums[2 * i]);
        s->light[place].transmitted = chain->opaque ? (lq_stack_lobe){0} : lobe_of(&sums[2 * i + 1]);
    }
    free(sums);
    free(values);
    return status;
}

/* ======================================================================================
 *                                        Level
 * ====================================================================================== */

/* Axes that no light between layers is on. */
static void mark_outer(const lq_plan *plan, bool *outer) {
    for (size_t i = 0; i < plan->axis_count; i++) outer[i] = true;
    for (size_t i = 0; i < plan->surface_count; i++)
        for (int side = 0; side < 2; side++)
            if (plan->surface[i].inside[side]) outer[plan->surface[i].axis[side]] = false;
    for (int c = 0; c < plan->channels; c++) {
        const lq_plan_chain *chain = &plan->chain[c];
        const lq_plan_medium *last = &chain->medium[chain->steps];
        if (chain->medium[0].tau != 1.0) outer[chain->medium[0].axis] = false;
        if (!chain->opaque && last->tau != 1.0) outer[last->axis] = false;
    }
}

/* Where the axis outside is divided, with cosines of masking below: one element of as many nodes is off by
 * twenty times as much at alpha = 0.016. */
static const double OUTER_CUT = 0.2;

/* From cut to cut; what lies below a step is halved, so that nodes are dense on both sides of the step. */
static int elements_of(const lq_plan_axis *a, bool outer, lq_root_element *elements) {
    int count = 0;
    for (int c = 0; c < a->cut_count && !outer; c++) {
        const double from = c > 0 ? a->cut[c - 1] : 0.0;
        const bool halved = a->stepped[c] && count + 2 + a->cut_count - c <= LQ_ELEMENTS_MAX;
        if (halved) elements[count++] = (lq_root_element){0.5 * (from + a->cut[c]), false};
        elements[count++] = (lq_root_element){a->cut[c], halved};
    }
    if (outer) elements[count++] = (lq_root_element){OUTER_CUT, false};
    elements[count++] = (lq_root_element){1.0, false};
    return count;
}

static lq_status begin(solving *s, lq_error *error) {
    const size_t surfaces = s->plan->surface_count, axes = s->plan->axis_count;
    s->axis = calloc(axes, sizeof *s->axis);
    s->outer = calloc(axes, sizeof *s->outer);
    s->work = calloc(surfaces, sizeof(lq_surface_work *));
    s->entry = calloc(2 * surfaces, sizeof *s->entry);
    s->block = calloc(surfaces, sizeof *s->block);
    s->first = calloc(TOGETHER + 1, sizeof *s->first);
    bool ok = s->axis && s->outer && s->work && s->entry && s->block && s->first;
    if (ok) mark_outer(s->plan, s->outer);
    for (size_t i = 0; i < axes && ok; i++) {
        const lq_plan_axis *a = &s->plan->axis[i];
        lq_root_element elements[LQ_ELEMENTS_MAX];
        const int count = elements_of(a, s->outer[i], elements);
        const int nodes = nodes_of(s->level, count, s->outer[i]);
        if (nodes * count > LQ_NODES_MAX)
            return lq_fail(error, LQ_NOT_CONVERGED, "%d elements of a cosine axis are too many for level %d",
                           count, s->level);
        ok = lq_node_axis_make_roots(&s->axis[i], elements, count, nodes);
    }
    return ok ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for a stack of %zu surfaces", surfaces);
}

static void end(solving *s) {
    for (size_t i = 0; i < s->plan->surface_count; i++) {
        if (s->work) lq_surface_end(s->work[i]);
        for (int side = 0; side < 2 && s->entry; side++) free(s->entry[2 * i + (size_t)side]);
        for (int m = 0; m < LQ_STACK_CHANNELS && s->block; m++)
            for (int mode = 0; mode < LQ_MODES; mode++) lq_block_free(&s->block[i][m][mode]);
    }
    for (size_t i = 0; i < s->plan->axis_count && s->axis; i++) lq_node_axis_free(&s->axis[i]);
    free(s->axis);
    free(s->outer);
    free(s->work);
    free(s->entry);
    free(s->block);
    free(s->first);
}

lq_status lq_stack_level(const lq_plan *plan, const lq_stack_query *query, int level, lq_stack_light *light,
                         const lq_progress *progress, lq_error *error) {
    solving s = {.plan = plan, .query = query, .level = level, .light = light};
    lq_status status = begin(&s, error);
    if (status == LQ_OK) status = solve_surfaces(&s, progress, error);
    lq_blas_begin();
    for (int c = 0; c < plan->channels && status == LQ_OK; c++) status = solve_channel(&s, c, error);
    lq_blas_end();
    end(&s);
    return status;
}
