/* json.c - jansson with its failures seen. */
#include "system/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/draft.h"
#include "system/input.h"
#include "system/status.h"
#include "system/utf8.h"

/* ------------------------------------------------------------------ values */

json_t *lq_json_number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static const char replacement[] = "\xEF\xBF\xBD"; /* U+FFFD */

json_t *lq_json_text(const char *text) {
    const size_t length = strlen(text);
    char *valid = malloc(3 * length + 1), *end = valid;
    if (!valid) return NULL;
    for (size_t i = 0; i < length;) {
        const size_t size = lq_utf8_character(text + i, length - i);
        end = size > 0 ? (char *)memcpy(end, text + i, size) + size : (char *)memcpy(end, replacement, 3) + 3;
        i += size > 0 ? size : 1;
    }
    json_t *json = json_stringn(valid, (size_t)(end - valid));
    free(valid);
    return json;
}

void lq_json_set(json_t **object, const char *key, json_t *value) {
    if (*object && json_object_set_new(*object, key, value) == 0) return;
    if (!*object) json_decref(value);
    json_decref(*object);
    *object = NULL;
}

void lq_json_append(json_t **array, json_t *value) {
    if (*array && json_array_append_new(*array, value) == 0) return;
    if (!*array) json_decref(value);
    json_decref(*array);
    *array = NULL;
}

/* ------------------------------------------------------------------ text */

/* jansson 2.14 does not look at what this returns where it writes a key: the draft remembers a failure. */
static int add(const char *bytes, size_t size, void *draft) {
    return lq_draft_add(draft, bytes, size) ? 0 : -1;
}

char *lq_json_dump(json_t *root, size_t flags) {
    lq_draft draft = {.text = NULL};
    const bool done = root && json_dump_callback(root, add, &draft, flags) == 0 && !draft.failed;
    json_decref(root);
    if (done) return draft.text;
    free(draft.text);
    return NULL;
}

/* ------------------------------------------------------------------ reading */

/* jansson 2.14 drops a byte of a number or text where its buffer cannot grow, and goes on: what it reads
 * counts if it reads the same again. */
lq_status lq_json_parse(json_t **root, const char *name, const char *text, size_t length, lq_error *error) {
    json_error_t cause;
    *root = json_loadb(text, length, JSON_REJECT_DUPLICATES, &cause);
    if (!*root && json_error_code(&cause) != json_error_out_of_memory)
        return lq_fail(error, LQ_FORMAT, "%s:%d: not JSON: %s", name, cause.line, cause.text);
    json_t *again = *root ? json_loadb(text, length, JSON_REJECT_DUPLICATES, &cause) : NULL;
    const bool same = again && json_equal(*root, again);
    json_decref(again);
    if (same) return LQ_OK;
    json_decref(*root);
    *root = NULL;
    return lq_fail(error, LQ_NO_MEMORY, "%s: no memory to read it", name);
}

lq_status lq_json_read(json_t **root, const char *path, lq_error *error) {
    char *text;
    size_t length;
    *root = NULL;
    lq_status status = lq_input_read(path, &text, &length, error);
    if (status) return status;
    status = lq_json_parse(root, path, text, length, error);
    free(text);
    return status;
}
