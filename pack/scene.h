/* scene.h - the materials of a recipe. */
#ifndef LACQUER_PACK_SCENE_H
#define LACQUER_PACK_SCENE_H

#include "pack/recipe_text.h"

/* "materials" of the root; NULL: there are none. */
lq_status lq_scene_read(const lq_recipe_reader *r, json_t *materials);

void lq_scene_free(lq_recipe_material *material);

#endif
