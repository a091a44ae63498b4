/* pack.h - what the parts of `lacquer pack` share. */
#ifndef LACQUER_PROGRAM_PACK_PACK_H
#define LACQUER_PROGRAM_PACK_PACK_H

#include "lacquer.h"

#include <limits.h>

typedef struct pack_request {
    const char *recipe_path, *output, *cache_given;
    size_t threads;
    lq_trust trust;       /* which NDF the recipe names may be opened */
    char cache[PATH_MAX]; /* empty: none */
    char found[PATH_MAX]; /* a shipped recipe that was named */
} pack_request;

/* A name that is no file becomes the shipped recipe of that name; false: a line was printed. */
bool pack_find_recipe(pack_request *request);

#endif
