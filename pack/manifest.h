/* manifest.h - what a pack says of itself: how each file was made, and the error it was measured to have. */
#ifndef LACQUER_PACK_MANIFEST_H
#define LACQUER_PACK_MANIFEST_H

#include "pack/atlas_source.h"
#include "pack/factored.h"
#include "pack/lobes_measure.h"
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

/* One material of the pack, done. */
typedef struct lq_packed_material {
    const lq_recipe_material *from;
    char name[LQ_NAME_SIZE]; /* as an identifier */
    lq_lobes lobes;
    lq_lobes reference; /* float texels, many: what a page compares with */
    lq_lobes_measure measure;
} lq_packed_material;

/* All that a pack holds. */
typedef struct lq_packing {
    const lq_recipe *recipe;
    lq_packed *tables;
    lq_packed_material *materials;
    lq_atlas atlas; /* no tiles: the images have files of their own */
    size_t *tiles;  /* first tile of each table, then of each material */
} lq_packing;

/* Put all images into the atlas. */
lq_status lq_packing_place(lq_packing *packing, lq_error *error);
/* The decode source in one language. LQ_BAD_INPUT: one that needs an atlas, without one. */
lq_status lq_packing_source(const lq_packing *packing, lq_language language, const char *path,
                            lq_error *error);
/* The same of a pack with an atlas, as text; free() it. */
lq_status lq_packing_source_text(const lq_packing *packing, lq_language language, char **text,
                                 lq_error *error);
/* Of all textures, as a GPU holds them. */
size_t lq_packing_bytes(const lq_packing *packing);
void lq_packing_free(lq_packing *packing);

/* How many languages a pack has: the first ones of lq_language. */
int lq_packing_languages(const lq_recipe *recipe);

/* Its images: one, or one a factor. The stem of an image's files: "dfg", "transmission.0_1"; the name of its
 * array in C. */
size_t lq_packed_images(const lq_packed *packed);
const lq_image *lq_packed_image(const lq_packed *packed, size_t i);
int lq_packed_channels(const lq_packed *packed, size_t i); /* of its last layer, that are in use */
void lq_packed_stem(const lq_packed *packed, size_t i, char *stem, size_t size);
void lq_packed_array(const lq_packed *packed, size_t i, char *array, size_t size);

/* Of all its images, as a GPU holds them. */
size_t lq_packed_bytes(const lq_packed *packed);

/* Into a folder that holds all the files: their checksums are taken. */
lq_status lq_manifest_write(const lq_packing *packing, const char *folder, lq_error *error);

#endif
