/* Shapes of models, and directions to look at them from. */
#ifndef LACQUER_TESTS_MODEL_SHAPE_H
#define LACQUER_TESTS_MODEL_SHAPE_H

#include "stack/model_shape.h"
#include "tests/stack_light.h"

typedef struct shaped {
    lq_stack *stack;
    lq_model_shape shape;
} shaped;

static inline shaped make(const char *text, lq_shape_query query, double mu) {
    shaped s = {.stack = parse(text)};
    lq_error error = {""};
    if (lq_model_shape_make(&s.shape, s.stack, &query, mu, &error) != LQ_OK)
        fail_msg("%s: %s", text, error.text);
    return s;
}

static inline void drop(shaped *s) {
    lq_model_shape_free(&s->shape);
    lq_stack_free(s->stack);
}

static inline void assert_refused(const char *text, lq_shape_query query, double mu, const char *why) {
    lq_stack *stack = parse(text);
    lq_model_shape shape;
    lq_error error = {""};
    assert_int_equal(lq_model_shape_make(&shape, stack, &query, mu, &error), LQ_BAD_INPUT);
    if (!strstr(error.text, why)) fail_msg("%s", error.text);
    lq_model_shape_free(&shape);
    lq_stack_free(stack);
}

#endif
