/* recipe.h - a recipe: which tables, how fine, in which files, and the error they may have. docs/packs.md */
#ifndef LACQUER_PACK_RECIPE_H
#define LACQUER_PACK_RECIPE_H

#include "pack/image.h"
#include "stack/material.h"

enum { LQ_RECIPE_TABLES = 32, LQ_RECIPE_MATERIALS = 64, LQ_PCA_TEXT = 512 };

typedef struct lq_recipe_table {
    const lq_kind *kind;
    char name[LQ_NAME_SIZE];   /* of its files and functions; the kind's id unless said */
    lq_axis axes[LQ_MAX_AXES]; /* one per axis of the kind */
    lq_settings settings;      /* ndf points to `ndf`, or to that of the recipe */
    char *ndf;                 /* its own; NULL: that of the recipe */
    double p99, max;           /* budget; INFINITY: none */
    size_t points;             /* where the error is measured, at least */
    int layouts[LQ_LAYOUTS];   /* published binaries to write too */
    int line;                  /* in the recipe's file */
    bool fit;                  /* texels are fitted to what is between them, too */
    bool factored;             /* then: */
    lq_pca_options pca;        /* how; of a search, where it starts */
    int channel;               /* of the table */
    lq_pca_norm pca_norm;
    double pca_budget; /* > 0, or bytes > 0: a search */
    size_t pca_bytes;
    char pca_text[LQ_PCA_TEXT]; /* the object, as the manifest and the cache name it */
} lq_recipe_table;

/* A material of a scene: a stack, some of whose numbers are ranges. */
typedef struct lq_recipe_material {
    char name[LQ_NAME_SIZE];
    lq_stack *stack;
    lq_material material; /* of that stack */
    char *source;         /* where its constants are from; may be NULL */
    int line;
} lq_recipe_material;

typedef struct lq_recipe {
    char name[LQ_NAME_SIZE];
    char *ndf;
    bool atlas; /* all textures in one */
    bool containers[LQ_CONTAINERS];
    size_t max_bytes; /* of all textures; 0: no bound */
    size_t count;
    lq_recipe_table tables[LQ_RECIPE_TABLES];
    double p99, max; /* of the materials; INFINITY: none */
    size_t points;   /* where each of them is checked, at least */
    size_t material_count;
    lq_recipe_material materials[LQ_RECIPE_MATERIALS];
} lq_recipe;

/* Messages are "FILE:LINE: what; accepted: ...". */
/* `trust`: which NDF files and plugins a recipe may name; NULL: none. */
lq_status lq_recipe_read(lq_recipe *recipe, const char *path, const lq_trust *trust, lq_error *error);
void lq_recipe_free(lq_recipe *recipe);

#endif
