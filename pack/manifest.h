/* manifest.h - what a pack says of itself: how each file was made, and the error it was measured to have. */
#ifndef LACQUER_PACK_MANIFEST_H
#define LACQUER_PACK_MANIFEST_H

#include "pack/measure.h"
#include "pack/recipe.h"

/* One table of the pack, done. */
typedef struct lq_packed {
    const lq_recipe_table *from;
    lq_table *table;
    lq_texture texture;
    lq_measure measure;
} lq_packed;

/* The name of a file of it: "dfg.ktx2". */
void lq_packed_file(const lq_packed *packed, const char *ending, char *name, size_t size);

lq_status lq_manifest_write(const lq_recipe *recipe, const lq_packed *packed, const char *path,
                            lq_error *error);

#endif
