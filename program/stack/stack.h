/* stack.h - what the files of `lacquer stack` share. */
#ifndef LACQUER_PROGRAM_STACK_STACK_H
#define LACQUER_PROGRAM_STACK_STACK_H

#include "lacquer.h"

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

#endif
