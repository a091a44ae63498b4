/* solvable.c - which stacks are not solved, nor walked: one set of words for both. */
#include "stack/description.h"
#include "system/status.h"

static const char *unsolved(const lq_layer *layer, unsigned solved) {
    for (int i = 0; i < LQ_PARAMETERS; i++)
        if ((lq_parameters[i].layers >> layer->type & 1) &&
            ((const lq_quantity *)(const void *)((const char *)layer + lq_parameters[i].offset))->form ==
                LQ_RANGE)
            return "has a range; accepted: a number or [r, g, b]";
    if (layer->anisotropic && !(solved & LQ_SOLVED_ANISOTROPIC)) return "is anisotropic; accepted: one alpha";
    if (layer->type == LQ_LAYER_DIELECTRIC && !(solved & LQ_SOLVED_SCATTERING) &&
        lq_medium_scatters(&layer->medium))
        return "has a medium that scatters; accepted: tau, or sigma_s = 0";
    return NULL;
}

lq_status lq_stack_solvable(const lq_stack *stack, const lq_stack_query *query, lq_error *error) {
    return lq_stack_solvable_by(stack, query, 0, error);
}

lq_status lq_stack_solvable_by(const lq_stack *stack, const lq_stack_query *query, unsigned solved,
                               lq_error *error) {
    for (size_t i = 0; i < query->mu_count; i++)
        if (!(query->mu[i] >= 0.0 && query->mu[i] <= 1.0))
            return lq_fail(error, LQ_BAD_INPUT, "mu = %g; accepted: 0 <= mu <= 1", query->mu[i]);
    for (size_t i = 0; i < stack->layer_count; i++) {
        const char *why = unsolved(&stack->layers[i], solved);
        if (why) return lq_fail(error, LQ_BAD_INPUT, "layer %zu %s", i + 1, why);
    }
    const lq_layer_type last = stack->layers[stack->layer_count - 1].type;
    if (query->from_below && last != LQ_LAYER_DIELECTRIC)
        return lq_fail(error, LQ_BAD_INPUT,
                       "light from below a %s base; accepted: a stack that ends with a "
                       "dielectric",
                       lq_layer_type_name(last));
    return LQ_OK;
}
