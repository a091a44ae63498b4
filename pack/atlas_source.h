/* atlas_source.h - the decode of a pack whose textures are one: functions of its tables and materials.
 */
#ifndef LACQUER_PACK_ATLAS_SOURCE_H
#define LACQUER_PACK_ATLAS_SOURCE_H

#include "pack/atlas.h"
#include "pack/factored.h"
#include "pack/lobes.h"

/* A table or a material, and its first tile. */
typedef struct lq_atlas_table {
    lq_source_table table;
    size_t tile; /* of a factored table those of its bases follow each other */
} lq_atlas_table;

typedef struct lq_atlas_material {
    const char *name; /* an identifier */
    const lq_lobes *lobes;
    size_t tile;
} lq_atlas_material;

typedef struct lq_atlas_contents {
    const lq_atlas *atlas;
    size_t table_count, material_count;
    const lq_atlas_table *tables;
    const lq_atlas_material *materials;
} lq_atlas_contents;

lq_status lq_atlas_source_write(lq_language language, const lq_atlas_contents *contents, const char *path,
                                lq_error *error);

/* The same as text; free() it. */
lq_status lq_atlas_source_text(lq_language language, const lq_atlas_contents *contents, char **text,
                               lq_error *error);

/* Fetches of the function of a table, at most, and of a material. */
size_t lq_atlas_table_fetches(const lq_atlas_table *table);
size_t lq_atlas_material_fetches(const lq_atlas_material *material);

/* What atlas_source.c and lobes_source.c share: */

/* "lacquer_fetch(...)" of a tile as an expression; u and v name where in [0,1] times texels - 1. */
void lq_say_tile(FILE *out, lq_language language, const lq_tile *tile, size_t rows);

/* Where in [0,1] the expression `value` is on an axis, as an expression. */
void lq_say_coordinate(FILE *out, lq_language language, const lq_axis *axis, const char *value);

/* What a function does with arguments outside their ranges where LACQUER_CHECK is set. */
typedef struct lq_check {
    const char *name;
    double min, max;
} lq_check;
void lq_say_check(FILE *out, lq_language language, const lq_check *checks, size_t count, const char *value);

/* The functions of all materials, and what shades with them; `albedo` is the function of that table. */
void lq_say_lobes(FILE *out, lq_language language, const lq_atlas_contents *contents, const char *albedo);

#endif
