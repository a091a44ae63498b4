/* table.c - what a stack does to light as a table, over the cosine and any parameters of its layers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "precompute/along.h"
#include "stack/description.h"
#include "stack/level.h"
#include "system/status.h"
#include "tables/facts.h"

static const char *const moments[] = {
    "reflected",         "sin2", "mean", "across", "transmitted", "transmitted_sin2", "transmitted_mean",
    "transmitted_across"};
static const char *const energies[] = {"reflected.r",   "reflected.g",   "reflected.b",
                                       "transmitted.r", "transmitted.g", "transmitted.b"};

/* A table is solved by turns, one for a set of the parameters; along one axis of them, at values of lq_along.
 */
typedef struct filling {
    const lq_stack *stack;
    const lq_stack_query *query;
    lq_table *table;
    int mu_axis, channels;
    int along_axis; /* -1: there are no parameters */
    bool interpolates;
    lq_along along;
    size_t others;  /* sets of the other parameters */
    size_t done;    /* values of `along` that are solved */
    double *solved; /* [((value * others) + other) * numbers_of + channel * cosines + m] */
    double *errors; /* likewise, of each turn */
} filling;

static bool is_opaque(const lq_stack *stack) {
    return stack->layers[stack->layer_count - 1].type != LQ_LAYER_DIELECTRIC;
}

/* ======================================================================================
 *                                         Turns
 * ====================================================================================== */

/* The share of the tolerance that interpolation may take. */
static const double INTERPOLATION = 0.25;

static double tolerance_of(const filling *f) {
    return lq_stack_tolerance(f->query);
}

static size_t cosines_of(const filling *f) {
    return f->table->axes[f->mu_axis].size;
}

static size_t numbers_of(const filling *f) {
    return (size_t)f->table->channel_count * cosines_of(f);
}

/* The parameters of one turn; `other` counts those that are not interpolated, the first axis fastest. */
static lq_status set_parameters(const filling *f, size_t value, size_t other, lq_stack *stack,
                                lq_error *error) {
    lq_status status = LQ_OK;
    for (int a = 0; a < f->table->axis_count && status == LQ_OK; a++) {
        const lq_axis *axis = &f->table->axes[a];
        if (a == f->mu_axis) continue;
        if (a == f->along_axis) {
            status = lq_stack_set(stack, axis->name, f->along.value[value], error);
            continue;
        }
        status = lq_stack_set(stack, axis->name, axis->nodes[other % axis->size], error);
        other /= axis->size;
    }
    return status;
}

/* The light of one turn, which is the first of `stride` channels at `light`. */
static void keep(const filling *f, const lq_stack_light *light, size_t stride, size_t place) {
    double *numbers = f->solved + place * numbers_of(f);
    const size_t count = cosines_of(f);
    const bool rgb = f->channels > 1;
    for (size_t m = 0; m < count; m++, light += stride) {
        for (int k = 0; k < f->table->channel_count; k++) {
            const lq_stack_light *l = &light[rgb ? (size_t)k % 3 : 0];
            const lq_stack_lobe *lobe = k < (rgb ? 3 : 4) ? &l->reflected : &l->transmitted;
            const double of_lobe[4] = {lobe->energy, lobe->sin2, lobe->mean, lobe->across};
            numbers[(size_t)k * count + m] = of_lobe[rgb ? 0 : k % 4];
        }
        for (int c = 0; c < f->channels; c++) f->errors[place] = fmax(f->errors[place], light[c].error);
    }
}

/* Turns that are solved as one list share what does not depend on the parameters; so many layers are held at
 * once. */
enum { LAYERS_TOGETHER = 96 };

static size_t turns_together(const filling *f) {
    const size_t of_one = f->stack->layer_count * (size_t)f->channels;
    return of_one < LAYERS_TOGETHER ? LAYERS_TOGETHER / of_one : 1;
}

/* Solving a list reports what has been done before it, and can be stopped. */
typedef struct list_progress {
    const lq_progress *all;
    double fraction;
} list_progress;

static bool report_list(void *user, double fraction) {
    (void)fraction;
    const list_progress *p = user;
    return !p->all || !p->all->report || p->all->report(p->all->user, p->fraction);
}

static void free_list(lq_stack **list, size_t count) {
    for (size_t i = 0; list && i < count; i++) lq_stack_free(list[i]);
    free((void *)list);
}

/* `count` turns from a place on. */
static lq_status solve_list(const filling *f, size_t first, size_t count, const lq_progress *progress,
                            lq_error *error) {
    const lq_axis *mu = &f->table->axes[f->mu_axis];
    lq_stack_query query = *f->query;
    query.mu = mu->nodes;
    query.mu_count = mu->size;
    query.paths = 0;
    query.tolerance = (f->interpolates ? 1.0 - INTERPOLATION : 1.0) * tolerance_of(f);
    const size_t channels = count * (size_t)f->channels;
    lq_stack **list = calloc(count, sizeof(lq_stack *));
    lq_stack_light *light = malloc(mu->size * channels * sizeof *light);
    lq_status status =
        list && light ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu stacks", count);
    for (size_t i = 0; i < count && status == LQ_OK; i++) {
        status = lq_stack_copy(&list[i], f->stack, error);
        if (status == LQ_OK)
            status = set_parameters(f, (first + i) / f->others, (first + i) % f->others, list[i], error);
    }
    if (status == LQ_OK)
        status = lq_stack_solve_list((const lq_stack *const *)list, count, &query, light, progress, error);
    for (size_t i = 0; i < count && (status == LQ_OK || status == LQ_NOT_CONVERGED); i++)
        keep(f, light + i * (size_t)f->channels, channels, first + i);
    free_list(list, count);
    free(light);
    return status;
}

/* Solve what `along` has and is not solved yet. */
static lq_status solve_turns(filling *f, const lq_progress *progress, lq_error *error) {
    const size_t from = f->done * f->others, to = f->along.count * f->others, together = turns_together(f);
    lq_status status = LQ_OK;
    f->done = f->along.count;
    for (size_t at = from; at < to; at += together) {
        list_progress p = {progress, (double)(at - from) / (double)(to - from)};
        const lq_progress of_list = {report_list, &p};
        const lq_status list = solve_list(f, at, at + together < to ? together : to - at, &of_list, error);
        if (list != LQ_OK && list != LQ_NOT_CONVERGED) return list;
        if (list != LQ_OK) status = list;
    }
    return status;
}

/* ======================================================================================
 *                                     Interpolation
 * ====================================================================================== */

/* What the series of a panel leaves out. */
static double missing(const filling *f, int panel) {
    const size_t size = numbers_of(f);
    double most = 0.0;
    for (size_t other = 0; other < f->others; other++)
        most = fmax(most,
                    lq_series_truncation(&f->along.panel[panel].series,
                                         f->solved + (f->along.panel[panel].first * f->others + other) * size,
                                         f->others * size, 1, size));
    return most;
}

/* Where the share of interpolation does not do, nodes are solved one by one. The most that is left out. */
static double settle_panels(filling *f) {
    double most = 0.0;
    for (int p = 0; p < LQ_ALONG_PANELS; p++) {
        if (!f->along.panel[p].used) continue;
        const double left = missing(f, p);
        if (left > INTERPOLATION * tolerance_of(f)) lq_along_drop(&f->along, p);
        else most = fmax(most, left);
    }
    return most;
}

/* The error of what a node is made of, and its numbers into the table. */
static double store_node(const filling *f, size_t node, size_t other, size_t offset, size_t stride) {
    double weight[LQ_ALONG_POINTS], error = 0.0;
    size_t first;
    const size_t points = lq_along_weights(&f->along, node, &first, weight), count = cosines_of(f);
    for (size_t k = 0; k < points; k++) error = fmax(error, f->errors[(first + k) * f->others + other]);
    for (size_t i = 0; i < numbers_of(f); i++) {
        double sum = 0.0;
        for (size_t k = 0; k < points; k++)
            sum += weight[k] * f->solved[((first + k) * f->others + other) * numbers_of(f) + i];
        f->table->channels[i / count][offset + i % count * stride] = (float)sum;
    }
    return error;
}

/* Every node of the table; the largest error of a solve. */
static double store_all(const filling *f) {
    const size_t sets = lq_table_entries(f->table) / cosines_of(f);
    double most = 0.0;
    for (size_t set = 0; set < sets; set++) {
        size_t left = set, stride = 1, offset = 0, mu_stride = 1, node = 0, other = 0, others = 1;
        for (int a = 0; a < f->table->axis_count; a++) {
            const size_t size = f->table->axes[a].size;
            if (a == f->mu_axis) mu_stride = stride;
            else {
                const size_t at = left % size;
                left /= size;
                offset += at * stride;
                if (a == f->along_axis) node = at;
                else {
                    other += at * others;
                    others *= size;
                }
            }
            stride *= size;
        }
        most = fmax(most, store_node(f, node, other, offset, mu_stride));
    }
    return most;
}

/* ======================================================================================
 *                                        Table
 * ====================================================================================== */

/* The later of two axes of one parameter would hide the other. */
static lq_status check_apart(const lq_stack *stack, const lq_axis *axes, int count, lq_error *error) {
    for (int a = 0; a < count; a++)
        for (int b = 0; b < a; b++)
            if (lq_stack_overlap(stack, axes[b].name, axes[a].name))
                return lq_fail(error, LQ_BAD_INPUT,
                               "the axes '%s' and '%s' set the same parameter; accepted are different ones",
                               axes[b].name, axes[a].name);
    return LQ_OK;
}

static lq_status check_axes(const lq_stack *stack, const lq_axis *axes, int count, int *mu_axis,
                            lq_error *error) {
    lq_stack *trial = NULL;
    lq_status status = lq_stack_copy(&trial, stack, error);
    *mu_axis = -1;
    for (int a = 0; a < count && status == LQ_OK; a++) {
        if (strcmp(axes[a].name, "mu") == 0) {
            *mu_axis = a;
            continue;
        }
        for (size_t i = 0; i < axes[a].size && status == LQ_OK; i++)
            status = lq_stack_set(trial, axes[a].name, axes[a].nodes[i], error);
    }
    lq_stack_free(trial);
    if (status == LQ_OK) status = check_apart(stack, axes, count, error);
    if (status == LQ_OK && *mu_axis < 0)
        status =
            lq_fail(error, LQ_BAD_INPUT, "a table of a stack needs the axis mu, the cosine of incidence");
    return status;
}

static lq_status set_facts(const filling *f, double worst, lq_error *error) {
    char *description = NULL;
    lq_status status = lq_stack_text(f->stack, &description, error);
    const char *const facts[][2] = {
        {"table", "stack"},
        {"title", "what a layered material does to light"},
        {"quantity", "flux that leaves / flux that arrives; sin2, mean and across of it, flux-weighted"},
        {"source", "Belcour 2018, sec. 5.1, adding on operators"},
        {"stack", description},
        {"from", f->query->from_below ? "below" : "above"},
        {"scattering", f->query->single ? "single" : "multiple"},
        {"version", LQ_VERSION}};
    for (size_t i = 0; i < sizeof facts / sizeof *facts && status == LQ_OK; i++)
        status = lq_table_set_fact(f->table, facts[i][0], facts[i][1], error);
    if (status == LQ_OK) status = lq_table_set_number(f->table, "tolerance", tolerance_of(f), error);
    if (status == LQ_OK) status = lq_table_set_bound(f->table, "rounding", LQ_STORAGE_ROUNDING, error);
    if (status == LQ_OK) status = lq_table_set_bound(f->table, "error", worst, error);
    free(description);
    return status;
}

static bool is_roughness(const lq_axis *axis) {
    return strstr(axis->name, ".alpha") && !strstr(axis->name, ".rotate");
}

/* The parameter that turns go along: the first roughness, otherwise any. */
static void choose_along(filling *f) {
    f->along_axis = -1;
    for (int a = f->table->axis_count; a-- > 0;)
        if (a != f->mu_axis) f->along_axis = a;
    for (int a = f->table->axis_count; a-- > 0;)
        if (is_roughness(&f->table->axes[a])) f->along_axis = a;
}

static lq_status allocate(filling *f, lq_error *error) {
    static const double none = 0.0;
    choose_along(f);
    const lq_axis *axis = f->along_axis < 0 ? NULL : &f->table->axes[f->along_axis];
    bool ok = lq_along_make(&f->along, axis ? axis->nodes : &none, axis ? axis->size : 1,
                            axis && is_roughness(axis));
    for (int p = 0; p < LQ_ALONG_PANELS; p++) f->interpolates |= f->along.panel[p].used;
    f->others = lq_table_entries(f->table) / cosines_of(f) / (axis ? axis->size : 1);
    const size_t most = f->along.most;
    f->solved = calloc(most * f->others * numbers_of(f) + 1, sizeof *f->solved);
    f->errors = calloc(most * f->others + 1, sizeof *f->errors);
    ok &= f->solved && f->errors;
    return ok ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu stacks", most * f->others);
}

static lq_status fill(filling *f, const lq_progress *progress, lq_error *error) {
    lq_status status = allocate(f, error), again = LQ_OK;
    if (status == LQ_OK) status = solve_turns(f, progress, error);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
    const double left_out = settle_panels(f);
    again = solve_turns(f, progress, error);
    if (again != LQ_OK && again != LQ_NOT_CONVERGED) return again;
    const double worst = store_all(f) + left_out;
    status = set_facts(f, worst, error);
    if (status != LQ_OK || worst <= tolerance_of(f)) return status;
    return lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance", worst);
}

lq_status lq_stack_precompute(const lq_stack *stack, const lq_stack_query *query, const lq_axis *axes,
                              int axis_count, const lq_progress *progress, lq_table **table,
                              lq_error *error) {
    filling f = {.stack = stack, .query = query, .channels = lq_stack_channels(stack)};
    const bool rgb = f.channels > 1;
    const int of_side = rgb ? 3 : 4;
    *table = NULL;
    lq_status status = check_axes(stack, axes, axis_count, &f.mu_axis, error);
    if (status == LQ_OK)
        status = lq_table_create(table, axes, axis_count, rgb ? energies : moments,
                                 is_opaque(stack) ? of_side : 2 * of_side, error);
    if (status != LQ_OK) return status;
    f.table = *table;
    status = fill(&f, progress, error);
    lq_along_free(&f.along);
    free(f.solved);
    free(f.errors);
    if (status == LQ_OK || status == LQ_NOT_CONVERGED) return status;
    lq_table_free(*table);
    *table = NULL;
    return status;
}
