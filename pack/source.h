/* source.h - the decode of a pack as source: one function a table, from one description. */
#ifndef LACQUER_PACK_SOURCE_H
#define LACQUER_PACK_SOURCE_H

#include "pack/language.h"
#include "pack/texture.h"

/* The languages of a pack of single textures. */
enum { LQ_SOURCE_LANGUAGES = LQ_C + 1 };

/* The functions that the decode source of any language has besides those of the tables, without "lacquer_";
 * ends with NULL. */
const char *const *lq_source_helpers(void);

/* A table to decode: one texture, or where that is NULL the textures of its factors. */
typedef struct lq_source_table {
    const lq_kind *kind;
    const lq_texture *texture;
    const struct lq_factored_textures *factored;
} lq_source_table;

/* Write the functions of all tables to `path`. */
lq_status lq_source_write(lq_language language, const lq_source_table *tables, size_t count, const char *path,
                          lq_error *error);

#endif
