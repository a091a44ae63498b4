/* table.c - what a stack does to light as a table, over the cosine and any parameters of its layers. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stack/description.h"
#include "system/parallel.h"
#include "system/status.h"

static const char *const moments[] = {
    "reflected",         "sin2", "mean", "across", "transmitted", "transmitted_sin2", "transmitted_mean",
    "transmitted_across"};
static const char *const energies[] = {"reflected.r",   "reflected.g",   "reflected.b",
                                       "transmitted.r", "transmitted.g", "transmitted.b"};

typedef struct filling {
    const lq_stack *stack;
    const lq_stack_query *query;
    lq_table *table;
    int mu_axis, channels;
    double *errors; /* of each turn */
} filling;

static bool is_opaque(const lq_stack *stack) {
    return stack->layers[stack->layer_count - 1].type != LQ_LAYER_DIELECTRIC;
}

/* ======================================================================================
 *                                         Turns
 * ====================================================================================== */

/* A turn is one set of the parameters: all axes but mu, the first of them fastest. The offset of its first
 * entry, with the parameters set. */
static lq_status set_parameters(const filling *f, size_t turn, lq_stack *stack, size_t *offset,
                                lq_error *error) {
    size_t stride = 1;
    lq_status status = LQ_OK;
    *offset = 0;
    for (int a = 0; a < f->table->axis_count && status == LQ_OK; a++) {
        const lq_axis *axis = &f->table->axes[a];
        if (a != f->mu_axis) {
            const size_t node = turn % axis->size;
            turn /= axis->size;
            *offset += node * stride;
            status = lq_stack_set(stack, axis->name, axis->nodes[node], error);
        }
        stride *= axis->size;
    }
    return status;
}

static void store(const filling *f, const lq_stack_light *light, size_t offset) {
    const size_t count = f->table->axes[f->mu_axis].size;
    size_t stride = 1;
    for (int a = 0; a < f->mu_axis; a++) stride *= f->table->axes[a].size;
    for (size_t m = 0; m < count; m++)
        for (int k = 0; k < f->table->channel_count; k++) {
            const lq_stack_light *l = &light[m * (size_t)f->channels + (f->channels > 1 ? (size_t)k % 3 : 0)];
            const lq_stack_lobe *lobe = k < (f->channels > 1 ? 3 : 4) ? &l->reflected : &l->transmitted;
            const double of_lobe[4] = {lobe->energy, lobe->sin2, lobe->mean, lobe->across};
            f->table->channels[k][offset + m * stride] = (float)of_lobe[f->channels > 1 ? 0 : k % 4];
        }
}

static lq_status fill_turn(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    const filling *f = user;
    const lq_axis *mu = &f->table->axes[f->mu_axis];
    lq_stack_query query = *f->query;
    query.mu = mu->nodes;
    query.mu_count = mu->size;
    query.paths = 0;
    lq_stack *stack = NULL;
    size_t offset = 0;
    lq_stack_light *light = malloc((mu->size * (size_t)f->channels + 1) * sizeof *light);
    lq_status status = light ? lq_stack_copy(&stack, f->stack, error)
                             : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mu->size);
    if (status == LQ_OK) status = set_parameters(f, turn, stack, &offset, error);
    if (status == LQ_OK) status = lq_stack_solve(stack, &query, light, NULL, error);
    if (status == LQ_OK || status == LQ_NOT_CONVERGED) {
        store(f, light, offset);
        for (size_t i = 0; i < mu->size * (size_t)f->channels; i++)
            f->errors[turn] = fmax(f->errors[turn], light[i].error);
    }
    lq_stack_free(stack);
    free(light);
    return status;
}

/* ======================================================================================
 *                                        Table
 * ====================================================================================== */

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
    if (status == LQ_OK && *mu_axis < 0)
        status =
            lq_fail(error, LQ_BAD_INPUT, "a table of a stack needs the axis mu, the cosine of incidence");
    return status;
}

/* Three digits, never below the value. */
static lq_status set_error(lq_table *table, double value, lq_error *error) {
    char text[32];
    const double unit = value > 0.0 ? pow(10.0, floor(log10(value)) - 2.0) : 1.0;
    snprintf(text, sizeof text, "%.3g", ceil(value / unit * (1.0 - 1e-12)) * unit);
    return lq_table_set_fact(table, "error", text, error);
}

static lq_status set_facts(const filling *f, lq_error *error) {
    char tolerance[32], *description = NULL;
    snprintf(tolerance, sizeof tolerance, "%.3g", f->query->tolerance > 0.0 ? f->query->tolerance : 1e-4);
    lq_status status = lq_stack_text(f->stack, &description, error);
    const char *const facts[][2] = {
        {"table", "stack"},
        {"title", "what a layered material does to light"},
        {"quantity", "flux that leaves / flux that arrives; sin2, mean and across of it, flux-weighted"},
        {"source", "Belcour 2018, sec. 5.1, adding on operators"},
        {"stack", description},
        {"from", f->query->from_below ? "below" : "above"},
        {"scattering", f->query->single ? "single" : "multiple"},
        {"version", LQ_VERSION},
        {"tolerance", tolerance},
        {"rounding", "3e-08"}};
    for (size_t i = 0; i < sizeof facts / sizeof *facts && status == LQ_OK; i++)
        status = lq_table_set_fact(f->table, facts[i][0], facts[i][1], error);
    free(description);
    return status;
}

static lq_status fill(filling *f, const lq_progress *progress, lq_error *error) {
    const size_t turns = lq_table_entries(f->table) / f->table->axes[f->mu_axis].size;
    f->errors = calloc(turns + 1, sizeof *f->errors);
    if (!f->errors) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu stacks", turns);
    lq_status status = lq_parallel(turns, f->query->threads, fill_turn, f, progress, error);
    double worst = 0.0;
    for (size_t i = 0; i < turns; i++) worst = fmax(worst, f->errors[i]);
    free(f->errors);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
    const lq_status told = set_facts(f, error);
    if (told != LQ_OK) return told;
    if (set_error(f->table, worst, error) != LQ_OK) return LQ_NO_MEMORY;
    return status == LQ_OK
               ? LQ_OK
               : lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance", worst);
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
    if (status == LQ_OK || status == LQ_NOT_CONVERGED) return status;
    lq_table_free(*table);
    *table = NULL;
    return status;
}
