/* Blocks: how large, where, and their exact values from the evaluator of the kind. */
#include "validate/certificate_blocks.h"

#include "pack/mapping.h"
#include "precompute/evaluator.h"
#include "system/status.h"
#include "validate/stream.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Purposes of the random streams. */
enum { STREAM_POINTS = 0x626c6f63, STREAM_STRATA = 0x73747261 };

/* Points of a block: a dielectric solve costs as much as a hundred answers, a conductor's or a lobe's about
 * as much as a few. Few points a block mean many blocks, that is more independent ones. Of each part of a
 * conductor's index a block has two values: every index has a Fresnel curve of its own. */
enum { POINTS_OF_SOLVE = 640, POINTS_OF_SWEEP = 2048, POINTS_OF_SLICE = 64, INDEX_PARTS = 2 };

/* ------------------------------------------------------------------------------------ the plan */

static bool is_dielectric(const lq_kind *kind) {
    return kind->interface && strcmp(kind->interface, "dielectric") == 0;
}

static bool is_index_part(const char *axis) {
    return strcmp(axis, "n") == 0 || strcmp(axis, "kappa") == 0;
}

int lq_block_slice_axis(const lq_kind *kind) {
    return lq_is_mapping(kind) ? -1 : lq_evaluator_find(kind->id)->slice_axis;
}

/* Fixed axes have one value, axes that cost a solve too; what is left shares the points of a block. */
static void choose_sizes(lq_block_plan *plan, size_t points) {
    const lq_kind *kind = plan->kind;
    const int slice = lq_block_slice_axis(kind);
    /* An index costs a solve, unless there are very many: then one solve in a hundred serves. */
    const bool sweeps = is_dielectric(kind) && kind->axis_count == 2;
    const bool solves_indices = is_dielectric(kind) && !sweeps;
    plan->sweep_axis = sweeps ? 1 - slice : -1;
    bool shares[LQ_MAX_AXES];
    int shared = 0, parts = 1;
    for (int a = 0; a < kind->axis_count; a++) {
        const bool free_axis = plan->domain.max[a] > plan->domain.min[a];
        plan->solves[a] = a == slice || (solves_indices && strcmp(kind->axes[a].name, "eta") == 0);
        plan->size[a] = free_axis && is_index_part(kind->axes[a].name) ? INDEX_PARTS : 1;
        parts *= (int)plan->size[a];
        shares[a] = !plan->solves[a] && free_axis && plan->size[a] == 1;
        shared += shares[a];
    }
    const double most = sweeps ? POINTS_OF_SWEEP : solves_indices ? POINTS_OF_SOLVE : POINTS_OF_SLICE;
    plan->per_block = 1;
    for (int a = 0; a < kind->axis_count; a++) {
        if (shares[a]) plan->size[a] = (size_t)round(pow(most / parts, 1.0 / shared));
        plan->per_block *= plan->size[a];
    }
    plan->count = (points + plan->per_block - 1) / plan->per_block;
}

/* A random permutation (Fisher & Yates). */
static void shuffle(size_t *list, size_t count, uint64_t seed, uint64_t axis) {
    lq_stream stream = lq_stream_open(seed, STREAM_STRATA, axis);
    for (size_t i = 0; i < count; i++) list[i] = i;
    for (size_t i = count; i > 1; i--) {
        const size_t j = (size_t)(lq_stream_uniform(&stream) * (double)i);
        const size_t kept = list[i - 1];
        list[i - 1] = list[j];
        list[j] = kept;
    }
}

lq_status lq_block_plan_make(lq_block_plan *plan, const lq_kind *kind, const lq_domain *domain, size_t points,
                             uint64_t seed, lq_error *error) {
    *plan = (lq_block_plan){.kind = kind, .domain = *domain, .seed = seed};
    choose_sizes(plan, points > 0 ? points : 1);
    for (int a = 0; a < kind->axis_count; a++) {
        if (!plan->solves[a]) continue;
        plan->stratum[a] = malloc(plan->count * sizeof *plan->stratum[a]);
        if (!plan->stratum[a]) {
            lq_block_plan_free(plan);
            return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu blocks of points", plan->count);
        }
        shuffle(plan->stratum[a], plan->count, seed, (uint64_t)a);
    }
    return LQ_OK;
}

void lq_block_plan_free(lq_block_plan *plan) {
    for (int a = 0; a < LQ_MAX_AXES; a++) free(plan->stratum[a]);
    memset(plan->stratum, 0, sizeof plan->stratum);
}

/* -------------------------------------------------------------------------------------- points */

void lq_block_draw(const lq_block_plan *plan, size_t index, lq_block *block) {
    lq_stream stream = lq_stream_open(plan->seed, STREAM_POINTS, index);
    for (int a = 0; a < plan->kind->axis_count; a++) {
        const double from = plan->domain.min[a], length = plan->domain.max[a] - from;
        const size_t first = plan->solves[a] ? plan->stratum[a][index] : 0;
        const double strata = (double)(plan->solves[a] ? plan->count : plan->size[a]);
        block->size[a] = plan->size[a];
        for (size_t i = 0; i < plan->size[a]; i++) {
            const double x = from + length * ((double)(first + i) + lq_stream_uniform(&stream)) / strata;
            block->nodes[a][i] = fmin(x, plan->domain.max[a]);
        }
    }
}

size_t lq_block_points(const lq_block *block, int axis_count) {
    size_t points = 1;
    for (int a = 0; a < axis_count; a++) points *= block->size[a];
    return points;
}

void lq_block_point(const lq_block *block, int axis_count, size_t i, double *point) {
    for (int a = 0; a < axis_count; a++) {
        point[a] = block->nodes[a][i % block->size[a]];
        i /= block->size[a];
    }
}

/* A curve is cheap, and as exact as its accuracy says. */
static lq_status mapping_exact(const lq_kind *kind, const lq_curve *curve, const lq_block *block,
                               double *values, double *estimate) {
    *estimate = 0.0;
    for (size_t i = 0; i < block->size[0]; i++) {
        values[i] = lq_mapping_value(kind, curve, block->nodes[0][i]);
        *estimate = fmax(*estimate, curve->accuracy * fabs(values[i]));
    }
    return LQ_OK;
}

lq_status lq_block_exact(const lq_kind *kind, const lq_settings *settings, const lq_curve *curve,
                         const lq_block *block, double *values, double *estimate, lq_error *error) {
    if (lq_is_mapping(kind)) return mapping_exact(kind, curve, block, values, estimate);
    const lq_evaluator *evaluator = lq_evaluator_find(kind->id);
    const size_t points = lq_block_points(block, kind->axis_count);
    const double *nodes[LQ_MAX_AXES];
    double *channels[LQ_MAX_CHANNELS];
    for (int a = 0; a < kind->axis_count; a++) nodes[a] = block->nodes[a];
    for (int c = 0; c < kind->channel_count; c++) channels[c] = values + (size_t)c * points;
    lq_job job;
    lq_status status = lq_job_make(&job, kind, settings, block->size, nodes, error);
    if (status != LQ_OK) return status;
    void *state = NULL;
    if (block->size[evaluator->slice_axis] != 1)
        status = lq_fail(error, LQ_BAD_INPUT, "a block of more than one slice");
    if (status == LQ_OK) status = lq_job_prepare(&job, evaluator, 0, error);
    if (status == LQ_OK && evaluator->prepare) status = evaluator->prepare(&job, &state, error);
    if (status == LQ_OK) status = evaluator->slice(&job, state, 0, channels, estimate, error);
    if (evaluator->release) evaluator->release(state);
    lq_job_free(&job);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

lq_status lq_point_exact(const lq_kind *kind, const lq_settings *settings, const lq_curve *curve,
                         const double *point, double *values, double *estimate, lq_error *error) {
    if (lq_is_mapping(kind)) {
        values[0] = lq_mapping_value(kind, curve, point[0]);
        *estimate = curve->accuracy * fabs(values[0]);
        return LQ_OK;
    }
    const lq_status status = lq_eval(kind, settings, point, values, estimate, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}
