/* reader.h - a stack that stands within another description: one of the materials of a scene. */
#ifndef LACQUER_STACK_READER_H
#define LACQUER_STACK_READER_H

#include "lacquer.h"

#include "system/json.h"

/* Where: messages say the line. */
typedef struct lq_stack_place {
    const char *name, *text; /* of the file */
    const char *list;        /* the key of the list that it is in, at the root */
    size_t index;            /* its place there */
    const char *keys;        /* accepted beside its layers, "name, layers" and what else the list takes */
} lq_stack_place;

/* As lq_stack_parse. */
lq_status lq_stack_from_json(lq_stack **stack, json_t *json, const lq_stack_place *place, unsigned flags,
                             lq_error *error);

#endif
