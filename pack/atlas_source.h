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

/* What the files that write it share: */

/* "lacquer_fetch(...)" of a tile as an expression; u and v name where in [0,1] times texels - 1. */
void lq_say_tile(FILE *out, lq_language language, const lq_tile *tile, size_t rows);

/* Where in [0,1] the expression `value` is on an axis, as an expression. */
void lq_say_coordinate(FILE *out, lq_language language, const lq_axis *axis, const char *value);

/* What a function does with arguments outside their ranges where LACQUER_CHECK is set. */
typedef struct lq_argument {
    const char *name;
    double min, max;
} lq_argument;
void lq_say_check(FILE *out, lq_language language, const lq_argument *checks, size_t count,
                  const char *value);

/* The same where the value is that many channels of a table. */
void lq_say_outside(FILE *out, lq_language language, const lq_argument *checks, size_t count, int channels);

/* The beginning of a table's comment, left open for its arguments. */
void lq_say_comment(FILE *out, const char *name, const lq_kind *kind);

/* The function of a factored table, and of one that may differ by colour its overload "NAME_rgb": that takes
 * three values of each such axis, and fetches what does not depend on them once. */
void lq_say_factored(FILE *out, lq_language language, const lq_factored_textures *textures,
                     const lq_kind *kind, const lq_tile *tiles);
/* Whether it has one, and the fetches of that. */
bool lq_factored_has_colours(const lq_factored_textures *textures, const lq_kind *kind);
size_t lq_factored_colour_fetches(const lq_factored_textures *textures, const lq_kind *kind);
/* Axes of a kind that may differ by colour, bit 1 << axis: of a metal its index, of a coating its medium. */
unsigned lq_colour_axes(const lq_kind *kind);

/* The functions of all materials, and what shades with them; `albedo` is the function of that table. */
void lq_say_lobes(FILE *out, lq_language language, const lq_atlas_contents *contents, const char *albedo);

#endif
