/* The directed search: from the worst points uphill, until the steps are a few thousandths of the domain.
 *
 * Each round looks at one solve to either side along one of the axes that cost a solve, in turn, and at the
 * present one; in each at a window around the present point along all other axes. The best of all is the next
 * point. Windows shrink from round to round, steps where they did not help.
 */
#include "validate/certificate.h"

#include "system/status.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 8 };

static const double first_step = 0.02, step_shrinks = 0.5, window_shrinks = 0.55;

typedef struct climb {
    const lq_sampled *c;
    lq_found best;
    double step[LQ_MAX_AXES]; /* in parts of the domain */
    lq_block block;
    double values[];
} climb;

/* Window points along one axis: an axis that blocks have few values of is a dear one. */
static size_t window_size(const lq_block_plan *plan, int axis) {
    const bool dear = plan->size[axis] < 4 || axis == plan->sweep_axis;
    return plan->size[axis] == 1 ? 1 : dear ? 3 : 9;
}

/* The window around `at`, ascending and within the domain. */
static void place(climb *s, const double *at) {
    const lq_block_plan *plan = &s->c->plan;
    for (int a = 0; a < plan->kind->axis_count; a++) {
        const double min = plan->domain.min[a], max = plan->domain.max[a], reach = s->step[a] * (max - min);
        const size_t window = s->block.size[a] = window_size(plan, a);
        for (size_t i = 0; i < window; i++) {
            const double part = window > 1 ? 2.0 * (double)i / (double)(window - 1) - 1.0 : 0.0;
            s->block.nodes[a][i] = fmin(fmax(at[a] + part * reach, min), max);
        }
    }
}

/* One solve and its window; keeps the best. */
static lq_status look(climb *s, const double *at, lq_found *best, lq_error *error) {
    const lq_sample_request *r = &s->c->request;
    const lq_stage *last = &r->stages[r->stage_count - 1];
    double estimate;
    place(s, at);
    const lq_status status =
        lq_block_exact(r->kind, &r->settings, r->curve, &s->block, s->values, &estimate, error);
    const size_t count = lq_block_points(&s->block, r->kind->axis_count);
    s->best.evaluations += count;
    for (size_t i = 0; status == LQ_OK && i < count; i++) {
        double point[LQ_MAX_AXES] = {0.0};
        lq_block_point(&s->block, r->kind->axis_count, i, point);
        for (int k = 0; k < r->kind->channel_count; k++) {
            const double value = s->values[(size_t)k * count + i], unit = r->relative ? fabs(value) : 1.0;
            const double exact = value / unit, decoded = last->decode(last->subject, k, point) / unit;
            const double off = fabs(decoded - exact);
            if (off <= best->error) continue; /* a NaN is worse than any number */
            *best = (lq_found){.channel = k, .decoded = decoded, .exact = exact};
            best->error = isnan(off) ? INFINITY : off;
            memcpy(best->at, point, sizeof point);
        }
    }
    return status;
}

/* One round along axis `along`, -1 where no axis costs a solve that can be moved. */
static lq_status look_around(climb *s, int along, lq_error *error) {
    lq_found best = s->best;
    const lq_domain *domain = &s->c->plan.domain;
    bool moved = false;
    lq_status status = LQ_OK;
    for (int side = 0; status == LQ_OK && side < (along < 0 ? 1 : 3); side++) {
        double at[LQ_MAX_AXES];
        memcpy(at, s->best.at, sizeof at);
        if (side > 0) {
            const double reach = s->step[along] * (domain->max[along] - domain->min[along]);
            at[along] += side == 1 ? -reach : reach;
            if (!(at[along] >= domain->min[along] && at[along] <= domain->max[along])) continue;
        }
        const double before = best.error;
        status = look(s, at, &best, error);
        if (side > 0 && best.error > before) moved = true;
    }
    const size_t evaluations = s->best.evaluations;
    s->best = best;
    s->best.evaluations = evaluations;
    for (int a = 0; a < s->c->plan.kind->axis_count; a++)
        if (!s->c->plan.solves[a]) s->step[a] *= window_shrinks;
        else if (a == along && !moved) s->step[a] *= step_shrinks;
    return status;
}

static lq_status climb_from(const lq_sampled *c, size_t value, lq_found *found, lq_error *error) {
    const lq_kind *kind = c->request.kind;
    size_t room = (size_t)kind->channel_count;
    for (int a = 0; a < kind->axis_count; a++) room *= window_size(&c->plan, a);
    climb *s = malloc(sizeof *s + room * sizeof *s->values);
    if (!s) return lq_fail(error, LQ_NO_MEMORY, "no memory for a search");
    s->c = c;
    s->best = (lq_found){.channel = (int)(value / c->points), .exact = c->exact[value]};
    s->best.decoded = c->decoded[c->request.stage_count - 1][value];
    s->best.error = fabs(s->best.decoded - s->best.exact);
    memcpy(s->best.at, c->at + value % c->points * (size_t)kind->axis_count,
           (size_t)kind->axis_count * sizeof *s->best.at);
    int turning[LQ_MAX_AXES], turns = 0;
    for (int a = 0; a < kind->axis_count; a++) {
        s->step[a] = c->plan.solves[a] ? first_step : 1.5 / (double)c->plan.size[a];
        if (c->plan.solves[a] && c->plan.domain.max[a] > c->plan.domain.min[a]) turning[turns++] = a;
    }
    lq_status status = LQ_OK;
    for (int round = 0; status == LQ_OK && round < ROUNDS; round++)
        status = look_around(s, turns > 0 ? turning[round % turns] : -1, error);
    *found = s->best;
    free(s);
    return status;
}

/* The worst value of each of the `count` worst blocks, worst first. */
static size_t choose_starts(const lq_sampled *c, size_t *starts, size_t count) {
    const double *decoded = c->decoded[c->request.stage_count - 1];
    double size[LQ_STARTS_MAX];
    size_t kept = 0;
    for (size_t b = 0; b < c->plan.count; b++) {
        size_t worst = b * c->plan.per_block;
        double most = -1.0;
        for (size_t k = 0; k < (size_t)c->request.kind->channel_count; k++)
            for (size_t i = 0; i < c->plan.per_block; i++) {
                const size_t value = k * c->points + b * c->plan.per_block + i;
                const double d = fabs(decoded[value] - c->exact[value]), off = isnan(d) ? INFINITY : d;
                if (off > most) most = off, worst = value;
            }
        size_t at = kept;
        while (at > 0 && size[at - 1] < most) at--;
        if (at >= count) continue;
        if (kept < count) kept++;
        memmove(size + at + 1, size + at, (kept - 1 - at) * sizeof *size);
        memmove(starts + at + 1, starts + at, (kept - 1 - at) * sizeof *starts);
        size[at] = most;
        starts[at] = worst;
    }
    return kept;
}

lq_status lq_sampled_search(lq_sampled *c, lq_error *error) {
    size_t starts[LQ_STARTS_MAX];
    lq_found found[LQ_STARTS_MAX];
    lq_status status[LQ_STARTS_MAX];
    lq_error causes[LQ_STARTS_MAX];
    const size_t wanted = c->request.starts < LQ_STARTS_MAX ? c->request.starts : LQ_STARTS_MAX;
    const size_t count = choose_starts(c, starts, wanted);
    const int threads = c->request.threads > 0 ? c->request.threads : omp_get_num_procs();
    size_t evaluations = 0;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (size_t i = 0; i < count; i++) status[i] = climb_from(c, starts[i], &found[i], &causes[i]);
    for (size_t i = 0; i < count; i++) {
        if (status[i] != LQ_OK) {
            if (error) *error = causes[i];
            return status[i];
        }
        evaluations += found[i].evaluations;
        if (i == 0 || found[i].error > c->found.error) c->found = found[i];
    }
    c->found.evaluations = evaluations;
    return LQ_OK;
}
