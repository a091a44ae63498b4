/* read.h - a pack as it was shipped: manifest.json and the texels of its files. docs/packs.md */
#ifndef LACQUER_PACK_READ_H
#define LACQUER_PACK_READ_H

#include "pack/lobes.h"
#include "pack/recipe.h"
#include "pack/texture.h"

#include "system/json.h"

/* One table, with the facts of what made it. */
typedef struct lq_shipped {
    char name[LQ_NAME_SIZE];
    const lq_kind *kind; /* lq_is_mapping: one of those */
    lq_factored *factored;
    lq_axis axes[LQ_MAX_AXES]; /* with factors: of the table they were made from; size 0: not known */
    lq_table *table;           /* where there are no factors: its texels, every axis of the kind, and */
    lq_texture texture;        /* the texture itself */
    double p99, max;           /* budget; INFINITY: none */
    bool relative;             /* of the budget, and of errors */
    size_t files;              /* that were read */
    size_t altered;            /* files whose checksum is not that of the manifest */
    size_t differing;          /* texels that are not the same in all of them */
    char suspect[128];         /* the first file that was altered or differs */
} lq_shipped;

/* One material of a scene. */
typedef struct lq_shipped_material {
    char name[LQ_NAME_SIZE];
    lq_stack *stack;
    lq_material material;
    lq_lobes lobes; /* p99 and max: its budget; INFINITY: none */
} lq_shipped_material;

struct lq_pack {
    char name[LQ_NAME_SIZE];
    size_t count;
    lq_shipped *tables;
    size_t material_count;
    lq_shipped_material *materials;
    lq_shipped atlas; /* its image, where textures are in one; and what its files are like */
    json_t *manifest; /* what it says of itself besides: what was measured, the source it has */
    /* Of lq_pack_open: */
    char *folder;
    lq_pack_function *functions; /* those of the tables, then of the materials */
};

/* Reads every container of every texture. The texels are those of the first listed file. LQ_FORMAT and the
 * file's name where one is missing or not what the manifest says. */
lq_status lq_pack_read(lq_pack *pack, const char *folder, lq_error *error);
void lq_pack_free(lq_pack *pack);
void lq_shipped_free(lq_shipped *shipped);

#endif
