/* atlas.h - all textures of a pack in one 2D texture, so that a shader binds one.
 *
 * Every tile has a border of one texel that repeats its edge: filters whose weights or coordinates are
 * rounded never see a neighbour.
 */
#ifndef LACQUER_PACK_ATLAS_H
#define LACQUER_PACK_ATLAS_H

#include "pack/image.h"

/* One layer of an image. Tiles of the same size that do not use all channels share their texels. */
typedef struct lq_tile {
    const lq_image *image; /* 2D: depth 1; 1 to 4 channels */
    size_t layer;
    int used;    /* channels of the image that mean something */
    int channel; /* which channel of the atlas is its first */
    size_t x, y; /* where its first texel is in the atlas */
} lq_tile;

typedef struct lq_atlas {
    size_t count, room;
    lq_tile *tiles;
    lq_image image; /* four channels */
} lq_atlas;

/* All layers of an image, in a row of the list: the index of the first. `used`: channels of its last layer;
 * the others use all. `image` stays until the atlas is made. LQ_BAD_INPUT: a volume. */
lq_status lq_atlas_add(lq_atlas *atlas, const lq_image *image, int used, const char *name, size_t *first,
                       lq_error *error);

/* Place all tiles and copy them. The same tiles give the same atlas. */
lq_status lq_atlas_make(lq_atlas *atlas, lq_error *error);
void lq_atlas_free(lq_atlas *atlas);

#endif
