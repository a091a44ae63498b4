/* layered_rows.h - figures of stacks as rows: one an angle, side and model. */
#ifndef LACQUER_VALIDATE_LAYERED_ROWS_H
#define LACQUER_VALIDATE_LAYERED_ROWS_H

#include "validate/layered.h"
#include "validate/slice_model.h"

typedef struct lq_layered_row {
    const char *stack, *base, *category, *model, *refused; /* refused: NULL where the model took the stack */
    size_t stack_index, model_index;
    double first, theta;
    int side;
    json_t *exact, *figures; /* as layered_measure.c writes them; of a curve `exact` is a point */
    bool curve;
} lq_layered_row;

typedef void lq_layered_take(void *user, const lq_layered_row *row);
void lq_layered_rows(json_t *figures, lq_layered_take *take, void *user);

/* RMSE of a row, with the direct lobe or without. */
double lq_layered_rmse(const lq_layered_row *row, bool with_direct);

/* Root mean square over angles and sides of each stack and model: [stack * models + model]; NaN: refused. */
typedef struct lq_layered_sums {
    size_t stacks, models;
    double *all, *rest;
} lq_layered_sums;
lq_status lq_layered_sum(lq_layered_sums *sums, json_t *figures, size_t models, lq_error *error);
void lq_layered_sums_free(lq_layered_sums *sums);

#endif
