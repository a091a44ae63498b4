/* source.h - the decode of a pack as source: one function a table, from one description. */
#ifndef LACQUER_PACK_SOURCE_H
#define LACQUER_PACK_SOURCE_H

#include "pack/texture.h"

typedef enum lq_language { LQ_GLSL, LQ_HLSL, LQ_C, LQ_LANGUAGES } lq_language;

/* "decode.glsl", "decode.hlsl", "decode.h" */
const char *lq_source_file(lq_language language);

/* Write the functions of all textures to `path`; kinds[i] is what texture i holds. */
lq_status lq_source_write(lq_language language, const lq_texture *textures, const lq_kind *const *kinds,
                          size_t count, const char *path, lq_error *error);

#endif
