/* source.h - the decode of a pack as source: one function a table, from one description. */
#ifndef LACQUER_PACK_SOURCE_H
#define LACQUER_PACK_SOURCE_H

#include "pack/texture.h"

typedef enum lq_language { LQ_GLSL, LQ_HLSL, LQ_C, LQ_LANGUAGES } lq_language;

/* "decode.glsl", "decode.hlsl", "decode.h" */
const char *lq_source_file(lq_language language);

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
