/* model_baked.h - lobes that scenes give a shader (material.h), in the form of a model's. */
#ifndef LACQUER_STACK_MODEL_BAKED_H
#define LACQUER_STACK_MODEL_BAKED_H

#include "stack/model.h"

/* lq_model_solve for LQ_MODEL_BAKED, with a mapping: `variance` is that of the roughness. */
lq_status lq_model_baked(const lq_stack *stack, const lq_model_query *query, lq_model_lobe *lobes,
                         const lq_progress *progress, lq_error *error);

#endif
