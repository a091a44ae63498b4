/* layered_rows.c - walks through the JSON of figures. */
#include "validate/layered_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/status.h"

static const char *text_of(json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

static void models_of(json_t *list, lq_layered_row *row, lq_layered_take *take, void *user) {
    for (row->model_index = 0; row->model_index < json_array_size(list); row->model_index++) {
        row->figures = json_array_get(list, row->model_index);
        row->model = text_of(row->figures, "model");
        row->refused = json_string_value(json_object_get(row->figures, "refused"));
        take(user, row);
    }
}

static void angles_of(json_t *list, lq_layered_row *row, lq_layered_take *take, void *user) {
    for (size_t i = 0; i < json_array_size(list); i++) {
        json_t *angle = json_array_get(list, i), *sides = json_object_get(angle, "sides");
        row->theta = json_number_value(json_object_get(angle, "theta"));
        row->curve = !sides;
        row->side = 0;
        row->exact = json_object_get(angle, "exact");
        if (row->curve) models_of(json_object_get(angle, "models"), row, take, user);
        for (size_t k = 0; k < json_array_size(sides); k++) {
            json_t *side = json_array_get(sides, k);
            row->side = (int)k;
            row->exact = json_object_get(side, "exact");
            models_of(json_object_get(side, "models"), row, take, user);
        }
    }
}

void lq_layered_rows(json_t *figures, lq_layered_take *take, void *user) {
    for (size_t i = 0; i < json_array_size(figures); i++) {
        json_t *stack = json_array_get(figures, i), *settings = json_object_get(stack, "settings");
        lq_layered_row row = {.stack = text_of(stack, "name"),
                              .base = text_of(settings, "base"),
                              .category = text_of(settings, "category"),
                              .first = json_number_value(json_object_get(settings, "first")),
                              .stack_index = i};
        angles_of(json_object_get(stack, "angles"), &row, take, user);
    }
}

double lq_layered_rmse(const lq_layered_row *row, bool with_direct) {
    json_t *of = json_object_get(row->figures, "rmse");
    json_t *value = json_object_get(of, with_direct ? "all" : "rest");
    return json_is_number(value) ? json_number_value(value) : NAN;
}

/* ======================================================================================
 *                                      By stack
 * ====================================================================================== */

typedef struct adding {
    lq_layered_sums *sums;
    double *count;
} adding;

static void add(void *user, const lq_layered_row *row) {
    const adding *a = user;
    const size_t at = row->stack_index * a->sums->models + row->model_index;
    const double all = lq_layered_rmse(row, true);
    const double rest = lq_layered_rmse(row, false);
    a->sums->all[at] += all * all;
    a->sums->rest[at] += rest * rest;
    a->count[at] += 1.0;
}

lq_status lq_layered_sum(lq_layered_sums *sums, json_t *figures, size_t models, lq_error *error) {
    const size_t stacks = json_array_size(figures), count = stacks * models + 1;
    *sums = (lq_layered_sums){stacks, models, calloc(count, sizeof *sums->all),
                              calloc(count, sizeof *sums->rest)};
    adding a = {sums, calloc(count, sizeof *a.count)};
    const bool whole = sums->all && sums->rest && a.count;
    if (whole) lq_layered_rows(figures, add, &a);
    for (size_t i = 0; whole && i < stacks * models; i++) {
        sums->all[i] = sqrt(sums->all[i] / a.count[i]);
        sums->rest[i] = sqrt(sums->rest[i] / a.count[i]);
    }
    free(a.count);
    return whole ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for figures");
}

void lq_layered_sums_free(lq_layered_sums *sums) {
    free(sums->all);
    free(sums->rest);
}
