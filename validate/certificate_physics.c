/* Physics of a table as stored and as decoded: range, false zeros, monotony, and bands at the scale of a
 * texel. */
#include "validate/certificate_checks.h"

#include "pca/factors.h"
#include "system/status.h"
#include "validate/entries.h"
#include "validate/stream.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* One step of an 8-bit display: no band weaker than this is seen. */
static const double display_step = 1.0 / 255.0;

/* --------------------------------------------------------------------------------------- range */

static void check_entries(lq_certified *certified) {
    const lq_subject *s = &certified->subject;
    const lq_entries found = lq_entries_look(s->table, s->origin.kind);
    char at[160];
    lq_point_text(s->origin.kind, found.at, at, sizeof at);
    if (found.faults == 0)
        lq_check_add(certified, "range stored", found.worst, LQ_RANGE_SLACK, "%zu values", found.looked_at);
    else
        lq_check_add(certified, "range stored", found.worst, LQ_RANGE_SLACK,
                     "%zu of %zu values; the worst is %g in %s at %s", found.faults, found.looked_at,
                     found.value, s->table->channel_names[found.channel], at);
}

/* Of factors every texel, of a table every entry. */
static void check_stored_range(lq_certified *certified) {
    const lq_subject *s = &certified->subject;
    double worst = 0.0;
    if (s->table) check_entries(certified);
    if (!s->factored) return;
    size_t texels = 0;
    for (int p = 0; p < s->factored->piece_count; p++)
        for (int f = 0; f < s->factored->pieces[p].factor_count; f++) {
            const lq_factor *factor = &s->factored->pieces[p].factors[f];
            const size_t count = lq_factor_texels(factor) * factor->base_count;
            texels += count;
            for (size_t i = 0; i < count; i++)
                worst = fmax(worst, isfinite(factor->data[i]) ? 0.0 : INFINITY);
        }
    lq_check_add(certified, "texels finite", worst, 0.0, "%zu texels", texels);
}

static void check_decoded_range(lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const double *decoded = c->decoded[c->request.stage_count - 1];
    double worst = 0.0;
    /* Parts of the exact value have no range: that they do not change sign is what is left. */
    lq_kind kind = *c->request.kind;
    if (c->request.relative) kind.value_min = 0.0, kind.value_max = INFINITY;
    for (size_t i = 0; i < c->points * (size_t)kind.channel_count; i++)
        worst = fmax(worst, lq_out_of_range(&kind, decoded[i]));
    lq_check_add(certified, "range decoded", worst, 1e-7, "%zu points", c->points);
}

/* Energy below this is not missed. */
static double noticeable(const lq_certified *certified) {
    const double bound = certified->budget.bound[LQ_NORM_MAX];
    return bound > 0.0 ? bound : 1e-3;
}

static void check_false_zeros(lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const double *decoded = c->decoded[c->request.stage_count - 1];
    double worst = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < c->points * (size_t)c->request.kind->channel_count; i++)
        if (decoded[i] <= 0.0 && c->exact[i] > 1e-6) {
            worst = fmax(worst, c->exact[i]);
            count++;
        }
    lq_check_add(certified, "false zeros", worst, noticeable(certified),
                 "exact value where 0 is decoded; %zu such points", count);
}

/* ------------------------------------------------------------------------------------ monotony */

/* The largest fall of `decoded` over lines of `n` values, `stride` apart, on which `exact` only rises, or the
 * other way about. */
static double reversal(const double *exact, const double *decoded, size_t n, size_t stride, double slack) {
    double up = INFINITY, down = INFINITY, fall = 0.0, rise = 0.0;
    for (size_t i = 1; i < n; i++) {
        const double e = exact[i * stride] - exact[(i - 1) * stride];
        const double d = decoded[i * stride] - decoded[(i - 1) * stride];
        up = fmin(up, e);
        down = fmin(down, -e);
        fall = fmax(fall, -d);
        rise = fmax(rise, d);
    }
    return up > slack ? fall : down > slack ? rise : 0.0;
}

static void check_monotony(lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const lq_block_plan *plan = &c->plan;
    const double *decoded = c->decoded[c->request.stage_count - 1];
    const double bound = certified->budget.bound[LQ_NORM_MAX];
    double worst = 0.0;
    size_t stride = 1;
    for (int a = 0; a < plan->kind->axis_count; stride *= plan->size[a++]) {
        if (plan->size[a] < 2) continue;
        for (size_t i = 0; i < c->points * (size_t)plan->kind->channel_count; i++)
            if (i % plan->per_block / stride % plan->size[a] == 0)
                worst = fmax(worst,
                             reversal(c->exact + i, decoded + i, plan->size[a], stride, 2.0 * c->estimate));
    }
    lq_check_add(
        certified, "monotony", worst, bound > 0.0 ? bound : 1e-2,
        "largest fall of decoded values along lines on which the exact ones only rise, or vice versa");
}

void lq_check_physics(lq_certified *certified) {
    check_stored_range(certified);
    check_decoded_range(certified);
    check_false_zeros(certified);
    check_monotony(certified);
}

/* --------------------------------------------------------------------------------------- bands */

/* Texels along a table axis: the finest texture axis that measures it. */
static size_t cells_along(const lq_subject *s, int axis) {
    size_t most = 1;
    if (!s->factored) return s->table->axes[axis].size;
    for (int p = 0; p < s->factored->piece_count; p++)
        for (int f = 0; f < s->factored->pieces[p].factor_count; f++) {
            const lq_factor *factor = &s->factored->pieces[p].factors[f];
            for (int k = 0; k < factor->axis_count; k++)
                if (factor->axes[k].axis == axis && factor->axes[k].texels.size > most)
                    most = factor->axes[k].texels.size;
        }
    return most;
}

/* An axis that blocks have few values of gets few triples. */
enum { BANDS = 6, TRIPLES = 8, FEW = 4, FEW_TRIPLES = 2, STREAM_BANDS = 0x62616e64 };

/* Second differences of the error at one place. */
typedef struct band {
    double *size; /* absolute */
    size_t count;
} band;

/* Decoded minus exact over one block, values[channel * points + i]. */
static lq_status errors_of(const lq_sample_request *r, const lq_block *block, double *values,
                           lq_error *error) {
    const lq_stage *last = &r->stages[r->stage_count - 1];
    const size_t points = lq_block_points(block, r->kind->axis_count);
    double estimate;
    const lq_status status = lq_block_exact(r->kind, &r->settings, r->curve, block, values, &estimate, error);
    for (size_t i = 0; status == LQ_OK && i < points * (size_t)r->kind->channel_count; i++) {
        double point[LQ_MAX_AXES];
        lq_block_point(block, r->kind->axis_count, i % points, point);
        const double unit = r->relative ? fabs(values[i]) : 1.0;
        values[i] = (last->decode(last->subject, (int)(i / points), point) - values[i]) / unit;
    }
    return status;
}

/* Three blocks one texel apart along `axis`, or one block that holds triples along it. */
static lq_status second_differences(const lq_sample_request *r, const lq_block *blocks, int block_count,
                                    int axis, band *to, lq_error *error) {
    const size_t points = lq_block_points(&blocks[0], r->kind->axis_count);
    const size_t values = points * (size_t)r->kind->channel_count;
    double *d = malloc((size_t)block_count * values * sizeof *d);
    lq_status status = d ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for bands");
    for (int k = 0; status == LQ_OK && k < block_count; k++)
        status = errors_of(r, &blocks[k], d + (size_t)k * values, error);
    size_t stride = block_count > 1 ? values : 1;
    for (int a = 0; a < axis && block_count == 1; a++) stride *= blocks[0].size[a];
    for (size_t i = 0; status == LQ_OK && i < values; i++)
        if (block_count > 1 || i / stride % blocks[0].size[axis] % 3 == 0)
            to->size[to->count++] = fabs(d[i] - 2.0 * d[i + stride] + d[i + 2 * stride]);
    free(d);
    return status;
}

/* Where band `index` along `axis` lies: a block like any other, but along the axis triples one texel apart.
 */
static int place_band(const lq_block_plan *plan, double texel, int axis, size_t index, lq_block *blocks) {
    const double min = plan->domain.min[axis], room = plan->domain.max[axis] - min - 2.0 * texel;
    lq_stream stream = lq_stream_open(plan->seed, STREAM_BANDS, index * LQ_MAX_AXES + (size_t)axis);
    lq_block_draw(plan, index, &blocks[0]);
    if (plan->solves[axis]) {
        const double first = min + room * lq_stream_uniform(&stream);
        blocks[2] = blocks[1] = blocks[0];
        for (int k = 0; k < 3; k++) blocks[k].nodes[axis][0] = first + k * texel;
        return 3;
    }
    blocks[0].size[axis] = (size_t)3 * (plan->size[axis] < FEW ? FEW_TRIPLES : TRIPLES);
    for (size_t i = 0; i < blocks[0].size[axis]; i += 3) {
        const double first = min + room * lq_stream_uniform(&stream);
        for (size_t k = 0; k < 3; k++) blocks[0].nodes[axis][i + k] = first + (double)k * texel;
    }
    return 1;
}

static lq_status measure_band(const lq_certified *certified, const lq_block_plan *plan, int axis,
                              size_t index, band *to, lq_error *error) {
    const double length = plan->domain.max[axis] - plan->domain.min[axis];
    const size_t cells = cells_along(&certified->subject, axis);
    if (cells < 4 || !(length > 0.0)) return LQ_OK;
    lq_block *blocks = malloc(3 * sizeof *blocks);
    if (!blocks) return lq_fail(error, LQ_NO_MEMORY, "no memory for bands");
    const int count = place_band(plan, length / (double)(cells - 1), axis, index, blocks);
    const lq_status status =
        second_differences(&certified->certificate.request, blocks, count, axis, to, error);
    free(blocks);
    return status;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void judge_bands(lq_certified *certified, double *size, size_t count) {
    const double bound = certified->budget.bound[LQ_NORM_MAX];
    if (count == 0) return;
    qsort(size, count, sizeof *size, ascending);
    lq_check_add(
        certified, "banding", size[count - 1 - count / 100], bound > 0.0 ? fmax(bound, display_step) : NAN,
        "p99 of second differences one texel apart against the exact ones, %zu triples; largest %.2e", count,
        size[count - 1]);
}

lq_status lq_check_bands(lq_certified *certified, lq_error *error) {
    const lq_sampled *c = &certified->certificate;
    const lq_kind *kind = c->request.kind;
    const size_t room = c->plan.per_block * TRIPLES * (size_t)kind->channel_count;
    const size_t items = (size_t)kind->axis_count * BANDS;
    const int threads = c->request.threads > 0 ? c->request.threads : omp_get_num_procs();
    band list[LQ_MAX_AXES * BANDS];
    lq_error causes[LQ_MAX_AXES * BANDS];
    lq_status states[LQ_MAX_AXES * BANDS];
    lq_block_plan plan;
    lq_status status =
        lq_block_plan_make(&plan, kind, &c->plan.domain, c->plan.per_block * BANDS, c->request.seed, error);
    if (plan.sweep_axis >= 0) plan.size[plan.sweep_axis] = FEW; /* each costs a solve */
    double *size = malloc(items * room * sizeof *size);
    if (status == LQ_OK && !size) status = lq_fail(error, LQ_NO_MEMORY, "no memory for bands");
    size_t count = 0;
    if (status == LQ_OK) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
        for (size_t i = 0; i < items; i++) {
            list[i] = (band){size + i * room, 0};
            states[i] = measure_band(certified, &plan, (int)(i / BANDS), i % BANDS, &list[i], &causes[i]);
        }
    }
    for (size_t i = 0; status == LQ_OK && i < items; i++) {
        memmove(size + count, list[i].size, list[i].count * sizeof *size);
        count += list[i].count;
        status = states[i];
        if (status != LQ_OK && error) *error = causes[i];
    }
    if (status == LQ_OK) judge_bands(certified, size, count);
    free(size);
    lq_block_plan_free(&plan);
    return status;
}
