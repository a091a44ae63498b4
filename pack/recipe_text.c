/* recipe_text.c - values of a recipe, and what is wrong with them, with the line. */
#include "pack/recipe_text.h"

#include "system/number.h"
#include "system/status.h"

#include <stdio.h>
#include <string.h>

enum { ENTRY_DEPTH = 3 };

/* ------------------------------------------------------------------------------------- lines
 * The JSON library forgets where a value stood. The text was valid JSON, so that finding the string again is
 * a matter of counting brackets and skipping strings. */

/* The line of the first string `token` in the entry being read, that of the entry if there is none (NULL). */
int lq_recipe_line(const lq_recipe_reader *r, const char *token) {
    int line = 1, depth = 0, entry = LQ_RECIPE_WHOLE, entry_line = 1;
    const size_t length = token ? strlen(token) : 0;
    for (const char *c = r->text; *c; c++) {
        if (*c == '\n') line++;
        if (*c == '{' || *c == '[') depth++;
        if (*c == '{' && depth == ENTRY_DEPTH && ++entry == r->entry) entry_line = line;
        if (*c == '}' || *c == ']') depth--;
        if (*c != '"') continue;
        const char *start = ++c;
        while (*c && *c != '"') c += *c == '\\' && c[1] ? 2 : 1;
        const bool inside = (depth >= ENTRY_DEPTH ? entry : LQ_RECIPE_WHOLE) == r->entry;
        if (inside && token && (size_t)(c - start) == length && strncmp(start, token, length) == 0)
            return line;
    }
    return entry_line;
}

lq_status lq_refuse(const lq_recipe_reader *r, const char *token, const char *text) {
    return lq_fail(r->error, LQ_BAD_INPUT, "%s:%d: %s", r->path, lq_recipe_line(r, token), text);
}

lq_status lq_refuse_value(const lq_recipe_reader *r, const char *key, const char *accepted) {
    return lq_fail(r->error, LQ_BAD_INPUT, "%s:%d: '%s' is not understood; accepted: %s", r->path,
                   lq_recipe_line(r, key), key, accepted);
}

lq_status lq_refuse_word(const lq_recipe_reader *r, const char *what, const char *word,
                         const char *accepted) {
    return lq_fail(r->error, LQ_BAD_INPUT, "%s:%d: unknown %s '%s'; accepted: %s", r->path,
                   lq_recipe_line(r, word), what, word, accepted);
}

/* Every key of `object` is in the comma-separated list. */
lq_status lq_recipe_keys(const lq_recipe_reader *r, json_t *object, const char *accepted) {
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) {
        bool known = false;
        for (const char *at = accepted; at && !known; at = strchr(at, ',')) {
            at += strspn(at, ", ");
            known = strlen(key) == strcspn(at, ",") && strncmp(at, key, strlen(key)) == 0;
        }
        if (!known) return lq_refuse_word(r, "key", key, accepted);
    }
    return LQ_OK;
}

/* ------------------------------------------------------------------------------------ values */

lq_status lq_recipe_number(const lq_recipe_reader *r, json_t *object, const char *key, double lowest,
                           double highest, double *value) {
    json_t *item = json_object_get(object, key);
    char accepted[64];
    if (!item) return LQ_OK;
    lq_print(accepted, sizeof accepted, "a number from %g to %g", lowest, highest);
    if (!json_is_number(item)) return lq_refuse_value(r, key, accepted);
    *value = json_number_value(item);
    return *value >= lowest && *value <= highest ? LQ_OK : lq_refuse_value(r, key, accepted);
}

lq_status lq_recipe_count(const lq_recipe_reader *r, json_t *object, const char *key, size_t lowest,
                          size_t highest, size_t *value) {
    json_t *item = json_object_get(object, key);
    char accepted[64];
    if (!item) return LQ_OK;
    snprintf(accepted, sizeof accepted, "a whole number from %zu to %zu", lowest, highest);
    const json_int_t n = json_integer_value(item);
    if (!json_is_integer(item) || n < (json_int_t)lowest || n > (json_int_t)highest)
        return lq_refuse_value(r, key, accepted);
    *value = (size_t)n;
    return LQ_OK;
}

lq_status lq_recipe_choice(const lq_recipe_reader *r, json_t *object, const char *key,
                           const char *const *choices, int *choice) {
    json_t *item = json_object_get(object, key);
    const char *word = json_string_value(item);
    char accepted[64] = "";
    if (!item) return LQ_OK;
    for (int i = 0; choices[i]; i++) {
        if (word && strcmp(word, choices[i]) == 0) return *choice = i, LQ_OK;
        lq_list_add(accepted, sizeof accepted, choices[i]);
    }
    return word ? lq_refuse_word(r, key, word, accepted) : lq_refuse_value(r, key, accepted);
}
