/* recipe_text.h - what the readers of a recipe's parts share. */
#ifndef LACQUER_PACK_RECIPE_TEXT_H
#define LACQUER_PACK_RECIPE_TEXT_H

#include "pack/recipe.h"
#include "system/json.h"

enum { LQ_RECIPE_WHOLE = -1 };

typedef struct lq_recipe_reader {
    const char *path;
    const char *text; /* the file */
    int entry;        /* the table being read, or LQ_RECIPE_WHOLE */
    lq_recipe *recipe;
    lq_error *error;
    const lq_trust *trust;
} lq_recipe_reader;

/* The line of the first string `token` in the entry being read, that of the entry if there is none (NULL). */
int lq_recipe_line(const lq_recipe_reader *r, const char *token);

/* LQ_BAD_INPUT and "FILE:LINE: ...". */
lq_status lq_refuse(const lq_recipe_reader *r, const char *token, const char *text);
lq_status lq_refuse_value(const lq_recipe_reader *r, const char *key, const char *accepted);
lq_status lq_refuse_word(const lq_recipe_reader *r, const char *what, const char *word, const char *accepted);

/* Every key of `object` is in the comma-separated list. */
lq_status lq_recipe_keys(const lq_recipe_reader *r, json_t *object, const char *accepted);

/* Values under a key; what is there stays where the key is absent. A choice is an index into `choices`, which
 * ends with NULL. */
lq_status lq_recipe_number(const lq_recipe_reader *r, json_t *object, const char *key, double lowest,
                           double highest, double *value);
lq_status lq_recipe_count(const lq_recipe_reader *r, json_t *object, const char *key, size_t lowest,
                          size_t highest, size_t *value);
lq_status lq_recipe_choice(const lq_recipe_reader *r, json_t *object, const char *key,
                           const char *const *choices, int *choice);

/* The "pca" of an entry, whose kind and axes are read. */
lq_status lq_recipe_read_pca(const lq_recipe_reader *r, json_t *pca, lq_recipe_table *table);

#endif
