/* make.h - from a recipe to a pack: what the parts of lq_pack_make share. */
#ifndef LACQUER_PACK_MAKE_H
#define LACQUER_PACK_MAKE_H

#include "pack/manifest.h"
#include "system/watch.h"

#include <limits.h>

typedef struct lq_making {
    const char *recipe;   /* its path, for messages */
    char cache[PATH_MAX]; /* of tables computed before; empty: none */
    char build[64];       /* what computes them, which is part of their keys */
    int threads;
    lq_watch watch;
} lq_making;

/* The table of packed->from: computed or found in the cache, made into textures, measured. */
lq_status lq_make_table(lq_making *making, lq_packed *packed, lq_error *error);

/* All materials: baked, made into texels, measured. */
lq_status lq_make_materials(const lq_making *making, lq_packing *packing, lq_error *error);

/* All files, in a folder that appears whole. */
lq_status lq_make_files(const lq_making *making, const lq_packing *packing, const char *target,
                        lq_error *error);

/* What each table and material came to; NULL: out of memory. */
lq_pack_report *lq_report_packing(const lq_packing *packing);
/* LQ_NOT_CONVERGED where a budget is missed: the first miss in words, the others by name. */
lq_status lq_report_judge(const lq_pack_report *report, const char *recipe, lq_error *error);

#endif
