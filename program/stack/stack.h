/* stack.h - what the files of `lacquer stack` share. */
#ifndef LACQUER_PROGRAM_STACK_STACK_H
#define LACQUER_PROGRAM_STACK_STACK_H

#include "stack/model_shape.h"
#include "system/json.h"

/* Light of one query, as lq_stack_solve gives it. */
typedef struct stack_result {
    const lq_stack *stack;
    const lq_stack_query *query;
    int channels;
    const lq_stack_light *light;
} stack_result;

void stack_print_text(const stack_result *result);
void stack_print_csv(const stack_result *result);
/* An exit code: memory may run out. */
int stack_print_json(const stack_result *result);

/* ---- --model ---- */

/* Lobes of one query and their light, by cosine and channel. */
typedef struct model_result {
    const lq_stack *stack;
    const lq_model_query *query;
    const char *model, *variant, *mapping, *first_name,
        *tables; /* as the options name them; NULL: it has none */
    lq_first_lobe first;
    int channels;
    lq_model_lobe *lobes;
    lq_stack_light *light;
    double azimuth;
    lq_turned_ggx
        *turned; /* of each lobe of an anisotropic model, from the plane of incidence; NULL otherwise */
} model_result;

/* Fill `lobes` and `light`; model_free, also after a failure. Where some lobe is not a GGX lobe of the
 * incidence, all have the energy and the mean that they come to, and the roughness in the direction of a
 * mirror. */
lq_status model_run(model_result *result, const lq_progress *progress, lq_error *error);
void model_free(model_result *result);

void model_print_text(const model_result *result);
void model_print_csv(const model_result *result);
int model_print_json(const model_result *result);

/* ---- for both ---- */

bool stack_is_opaque(const lq_stack *stack);
/* Up to the last of the columns that both have, without its line break: its `error` is left to the caller. */
void stack_print_csv_numbers(double mu, int channel, const lq_stack_light *light, bool opaque);
json_t *stack_lobe_json(const lq_stack_lobe *lobe);
extern const char stack_csv_columns[];

#endif
