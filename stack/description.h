/* description.h - the parameters of a layer: which there are, what they accept, and where they are kept. */
#ifndef LACQUER_STACK_DESCRIPTION_H
#define LACQUER_STACK_DESCRIPTION_H

#include "lacquer.h"

typedef struct lq_parameter {
    const char *name;
    unsigned layers; /* bit 1 << lq_layer_type: those that have it */
    bool required;
    bool in_medium, by_sigma;
    size_t offset; /* of the lq_quantity in lq_layer */
    double lowest, highest, otherwise;
    bool open_low, open_high; /* that end is left out */
} lq_parameter;

enum { LQ_PARAMETERS = 12 };
extern const lq_parameter lq_parameters[LQ_PARAMETERS];

static inline lq_quantity *lq_parameter_of(lq_layer *layer, const lq_parameter *parameter) {
    return (lq_quantity *)(void *)((char *)layer + parameter->offset);
}

/* NULL where layers of that type have none of that name; a dielectric's index has another range than a
 * conductor's. */
const lq_parameter *lq_parameter_find(lq_layer_type type, const char *name);

bool lq_parameter_accepts(const lq_parameter *parameter, double value);
/* "0 < n <= 10", into `text`. */
void lq_parameter_range_text(const lq_parameter *parameter, char *text, size_t size);

lq_quantity lq_quantity_one(double value);
const char *lq_layer_type_name(lq_layer_type type);

/* A layer of that type with every parameter at what it is unless given. */
lq_layer lq_layer_default(lq_layer_type type);

/* Do two paths, which lq_stack_set accepts, set anything in common? "top.alpha", "1.alpha", "1.alpha.y". */
bool lq_stack_overlap(const lq_stack *stack, const char *one, const char *other);

/* Transmittance at normal incidence by absorption alone, and whether anything scatters besides. */
double lq_medium_transmittance(const lq_medium *medium, int channel);
bool lq_medium_scatters(const lq_medium *medium);

/* LQ_BAD_INPUT: an anisotropic interface, a medium that scatters, a range, or light from below an opaque
 * base. */
lq_status lq_stack_solvable(const lq_stack *stack, const lq_stack_query *query, lq_error *error);

/* The same but for what is solved by no more than a model. */
enum { LQ_SOLVED_SCATTERING = 1, LQ_SOLVED_ANISOTROPIC = 2 };
lq_status lq_stack_solvable_by(const lq_stack *stack, const lq_stack_query *query, unsigned solved,
                               lq_error *error);

#endif
