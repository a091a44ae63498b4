/* A stored table at its own nodes: nodes drawn at random, and those that stick out of their neighbours.
 *
 * A single damaged entry of millions is not met by chance. But it departs from the cubic through its
 * neighbours along every axis at once, where the values themselves depart along some axes only, and where
 * they do along all, they do so beside it as well. The entries that depart most, and those that depart most
 * compared with the entries beside them, are compared with the solver too.
 */
#include "validate/certificate_checks.h"

#include "system/number.h"
#include "system/status.h"
#include "validate/certificate_suspects.h"
#include "validate/stream.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCKS = 24, ALONG = 8, ALONG_DEAR = 2, STREAM_NODES = 0x6e6f6465 };

/* Half a unit in the last place of a stored value in [0.5, 1]. */
static const double rounding = 3e-8;

/* ---------------------------------------------------------------------------------- comparison */

typedef struct stored {
    const lq_table *table;
    const lq_kind *kind;
    lq_settings settings;
    const lq_curve *curve;
    bool halves, relative;
    double worst, allowance, rms; /* of |stored - exact| - allowance: worst; rms: sum of squares at first */
    double most;                  /* |stored - exact| at `at` */
    double at[LQ_MAX_AXES];
    size_t count;
} stored;

static void compare(stored *s, const double *at, double value, double exact, double estimate) {
    const double unit = s->relative ? fabs(exact) : 1.0;
    const double d = (value - exact) / unit, size = isnan(d) ? INFINITY : fabs(d);
    const double half = s->halves ? ldexp(fabs(value), -11) : 0.0;
    const double excess = size - (s->allowance + (estimate + half) / unit);
    s->rms += d * d;
    if (s->count++ > 0 && excess <= s->worst) return;
    s->worst = excess;
    s->most = size;
    memcpy(s->at, at, sizeof s->at);
}

/* The `along` nodes of one axis that a block takes: ascending, all of a short axis. */
static size_t draw_nodes(const lq_axis *axis, size_t along, lq_stream *stream, size_t *nodes) {
    const size_t count = axis->size < along ? axis->size : along;
    for (size_t i = 0; i < count; i++) {
        const size_t from = i * axis->size / count, to = (i + 1) * axis->size / count;
        nodes[i] = from + (size_t)(lq_stream_uniform(stream) * (double)(to - from));
    }
    return count;
}

static lq_status compare_block(stored *s, const lq_block_plan *plan, size_t index, lq_error *error) {
    const int axes = s->kind->axis_count;
    size_t node[LQ_MAX_AXES][ALONG];
    double estimate = 0.0;
    lq_stream stream = lq_stream_open(plan->seed, STREAM_NODES, index);
    lq_block *block = malloc(sizeof *block);
    size_t points = 1;
    if (!block) return lq_fail(error, LQ_NO_MEMORY, "no memory for a block");
    for (int a = 0; a < axes; a++) {
        const size_t most = a == plan->sweep_axis ? ALONG_DEAR : ALONG;
        block->size[a] =
            draw_nodes(&s->table->axes[a], plan->size[a] < most ? plan->size[a] : most, &stream, node[a]);
        for (size_t i = 0; i < block->size[a]; i++) block->nodes[a][i] = s->table->axes[a].nodes[node[a][i]];
        points *= block->size[a];
    }
    double *values = malloc(points * (size_t)s->kind->channel_count * sizeof *values);
    lq_status status = values
                           ? lq_block_exact(s->kind, &s->settings, s->curve, block, values, &estimate, error)
                           : lq_fail(error, LQ_NO_MEMORY, "no memory for a block");
    for (size_t i = 0; status == LQ_OK && i < points; i++) {
        double at[LQ_MAX_AXES] = {0.0};
        size_t entry_index = 0, stride = 1, left = i;
        lq_block_point(block, axes, i, at);
        for (int a = 0; a < axes; stride *= s->table->axes[a++].size) {
            entry_index += stride * node[a][left % block->size[a]];
            left /= block->size[a];
        }
        for (int c = 0; c < s->kind->channel_count; c++)
            compare(s, at, (double)s->table->channels[c][entry_index], values[(size_t)c * points + i],
                    estimate);
    }
    free(values);
    free(block);
    return status;
}

static lq_status compare_suspect(stored *s, const lq_suspect *e, lq_error *error) {
    double at[LQ_MAX_AXES] = {0.0}, exact[LQ_MAX_CHANNELS], estimate;
    size_t left = e->index;
    for (int a = 0; a < s->kind->axis_count; a++) {
        at[a] = s->table->axes[a].nodes[left % s->table->axes[a].size];
        left /= s->table->axes[a].size;
    }
    const lq_status status = lq_point_exact(s->kind, &s->settings, s->curve, at, exact, &estimate, error);
    if (status != LQ_OK) return status;
    compare(s, at, (double)s->table->channels[e->channel][e->index], exact[e->channel], estimate);
    return LQ_OK;
}

/* Into `s`, in the order of the parts: sums do not depend on which thread had which. */
static void merge(stored *s, const stored *part) {
    if (part->count == 0) return;
    if (s->count == 0 || part->worst > s->worst) {
        s->worst = part->worst;
        s->most = part->most;
        memcpy(s->at, part->at, sizeof s->at);
    }
    s->count += part->count;
    s->rms += part->rms;
}

static lq_status compare_all(stored *s, const lq_block_plan *plan, const lq_suspect *suspects, int threads,
                             lq_error *error) {
    lq_status status[BLOCKS + LQ_SUSPECTS];
    lq_error causes[BLOCKS + LQ_SUSPECTS];
    stored parts[BLOCKS + LQ_SUSPECTS];
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (size_t i = 0; i < BLOCKS + LQ_SUSPECTS; i++) {
        parts[i] = *s;
        status[i] = LQ_OK;
        if (i < BLOCKS) status[i] = compare_block(&parts[i], plan, i, &causes[i]);
        else if (suspects[i - BLOCKS].score > 0.0)
            status[i] = compare_suspect(&parts[i], &suspects[i - BLOCKS], &causes[i]);
    }
    for (size_t i = 0; i < BLOCKS + LQ_SUSPECTS; i++) {
        if (status[i] != LQ_OK) {
            if (error) *error = causes[i];
            return status[i];
        }
        merge(s, &parts[i]);
    }
    return LQ_OK;
}

/* Texels that were fitted are as far from their nodes as the fact says. */
static double fitted_by(const lq_table *table) {
    const char *fact = lq_table_fact(table, "fit");
    return fact ? fmax(lq_strtod(fact, NULL), 0.0) : 0.0;
}

lq_status lq_check_stored(lq_certified *certified, lq_error *error) {
    const lq_subject *subject = &certified->subject;
    const lq_sampled *c = &certified->certificate;
    if (!subject->table) return LQ_OK;
    const double tolerance = subject->origin.settings.tolerance;
    stored s = {.table = subject->table,
                .kind = subject->origin.kind,
                .allowance = tolerance + rounding + fitted_by(subject->table)};
    s.settings = subject->origin.settings;
    s.curve = subject->curve;
    s.halves = subject->texture.axis_count > 0;
    s.relative = subject->relative;
    s.settings.tolerance = fmax(0.1 * tolerance, s.kind->finest_tolerance);
    lq_suspect suspects[LQ_SUSPECTS];
    lq_suspects_find(s.table, tolerance, suspects);
    const int threads = c->request.threads > 0 ? c->request.threads : omp_get_num_procs();
    const lq_status status = compare_all(&s, &c->plan, suspects, threads, error);
    if (status != LQ_OK) return status;
    certified->integration = (lq_integration){s.count, s.most, sqrt(s.rms / (double)s.count)};
    char at[160];
    lq_point_text(s.kind, s.at, at, sizeof at);
    lq_check_add(
        certified, "stored entries", s.most, s.most - s.worst,
        "%zu entries against the solver, rms %.2e, the %d that stick out most included; limit: stated "
        "tolerance + estimate; at %s",
        s.count, sqrt(s.rms / (double)s.count), LQ_SUSPECTS, at);
    return LQ_OK;
}
