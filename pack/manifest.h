/* manifest.h - what a pack says of itself: how each file was made, and the error it was measured to have. */
#ifndef LACQUER_PACK_MANIFEST_H
#define LACQUER_PACK_MANIFEST_H

#include "pack/factored.h"
#include "pack/measure.h"
#include "pack/recipe.h"

/* One table of the pack, done. */
typedef struct lq_packed {
    const lq_recipe_table *from;
    lq_table *table; /* may be NULL where there are factors */
    lq_texture texture;
    lq_factored *factored; /* NULL: texture; otherwise: */
    lq_factored_textures factors;
    lq_measure measure;
} lq_packed;

/* Its images: one, or one a factor. The stem of an image's files: "dfg", "transmission.0_1"; the name of its
 * array in C. */
size_t lq_packed_images(const lq_packed *packed);
const lq_image *lq_packed_image(const lq_packed *packed, size_t i);
void lq_packed_stem(const lq_packed *packed, size_t i, char *stem, size_t size);
void lq_packed_array(const lq_packed *packed, size_t i, char *array, size_t size);

/* Of all its images, as a GPU holds them. */
size_t lq_packed_bytes(const lq_packed *packed);

/* Into a folder that holds all the files: their checksums are taken. */
lq_status lq_manifest_write(const lq_recipe *recipe, const lq_packed *packed, const char *folder,
                            lq_error *error);

#endif
