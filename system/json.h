/* json.h - JSON that is whole or not there: what jansson leaves to its caller to check cannot be left
 * unchecked.
 *
 * A value for which there was no memory is NULL; whatever it is put into becomes NULL too, and so does the
 * text at the end. Only that has to be looked at. */
#ifndef LACQUER_SYSTEM_JSON_H
#define LACQUER_SYSTEM_JSON_H

#include <jansson.h>
#include <stdbool.h>

#include "lacquer.h"

/* null where `value` is not finite, for which JSON has no word. */
json_t *lq_json_number(double value);
/* Bytes that are not UTF-8 become U+FFFD. */
json_t *lq_json_text(const char *text);

/* Put `value` (taken over) in. Without memory, or where `value` is NULL, what it was put into is freed and
 * NULL. */
void lq_json_set(json_t **object, const char *key, json_t *value);
void lq_json_append(json_t **array, json_t *value);

/* The text of `root`, which is freed; `flags` are jansson's. NULL: no memory. */
char *lq_json_dump(json_t *root, size_t flags);

/* Parse `length` bytes, in which no object has a key twice; `name` is for the message. */
lq_status lq_json_parse(json_t **root, const char *name, const char *text, size_t length, lq_error *error);
/* The same of a regular file. */
lq_status lq_json_read(json_t **root, const char *path, lq_error *error);

#endif
