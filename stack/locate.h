/* locate.h - the line of a value in a JSON text, which its parser does not keep. */
#ifndef LACQUER_STACK_LOCATE_H
#define LACQUER_STACK_LOCATE_H

#include <stddef.h>

/* Down into an object by key, or into an array by index where `key` is NULL. */
typedef struct lq_json_step {
    const char *key;
    size_t index;
} lq_json_step;

/* The line, from 1, of the member that the steps lead to, or of the last one on the way that is there. The
 * text must be valid JSON. */
int lq_json_line(const char *text, const lq_json_step *steps, size_t count);

#endif
