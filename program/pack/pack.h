/* pack.h - what the parts of `lacquer pack` share. */
#ifndef LACQUER_PROGRAM_PACK_PACK_H
#define LACQUER_PROGRAM_PACK_PACK_H

#include "pack/manifest.h"

#include <limits.h>

typedef struct pack_request {
    const char *recipe_path, *output, *cache_given;
    size_t threads;
    lq_trust trust;       /* which NDF the recipe names may be opened */
    char cache[PATH_MAX]; /* empty: none */
    char build[64];
    char found[PATH_MAX]; /* a shipped recipe that was named */
} pack_request;

/* A name that is no file becomes the shipped recipe of that name; false: a line was printed. */
bool pack_find_recipe(pack_request *request);

/* The table of packed->from: computed or found in the cache, made into textures, measured. */
lq_status pack_make(pack_request *request, lq_packed *packed, lq_error *error);

/* All materials: baked, made into texels, measured. */
lq_status pack_bake(pack_request *request, lq_packing *packing, lq_error *error);

#endif
