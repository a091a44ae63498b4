/* make.c - lq_pack_make: a recipe is read, its tables and materials are made, judged, and written. */
#include "pack/make.h"

#include "pack/cache.h"
#include "pack/folder.h"
#include "system/extend.h"
#include "system/parallel.h"
#include "system/status.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

lq_pack_options lq_pack_options_default(void) {
    return (lq_pack_options){.struct_size = sizeof(lq_pack_options)};
}

static lq_status begin(lq_making *making, const char *recipe, const lq_pack_options *options,
                       lq_error *error) {
    const char *cache = options->cache ? options->cache : "";
    *making = (lq_making){.recipe = recipe, .threads = options->threads};
    if (options->threads < 0)
        return lq_fail(error, LQ_BAD_INPUT, "%d threads; accepted: 0 for one per core, or more",
                       options->threads);
    if (strlen(cache) >= sizeof making->cache)
        return lq_fail(error, LQ_BAD_INPUT, "the path of the cache is too long; accepted: %d characters",
                       PATH_MAX - 1);
    strcpy(making->cache, cache);
    if (*cache) lq_cache_build(making->build, sizeof making->build);
    return lq_watch_read(&making->watch, options->watch, error);
}

/* Every table and material, and all images in one where that is asked for. */
static lq_status make_all(lq_making *making, lq_packing *packing, lq_error *error) {
    const lq_recipe *recipe = packing->recipe;
    lq_status status = LQ_OK;
    packing->tables = calloc(recipe->count + 1, sizeof *packing->tables);
    packing->materials = calloc(recipe->material_count + 1, sizeof *packing->materials);
    if (!packing->tables || !packing->materials) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    for (size_t i = 0; i < recipe->count && status == LQ_OK; i++) {
        packing->tables[i].from = &recipe->tables[i];
        status = lq_make_table(making, &packing->tables[i], error);
    }
    if (status == LQ_OK && recipe->material_count > 0) status = lq_make_materials(making, packing, error);
    return status == LQ_OK && recipe->atlas ? lq_packing_place(packing, error) : status;
}

/* What can be refused at once, before the work. */
static lq_status check(const lq_making *making, const char *folder, lq_error *error) {
    lq_watch_hold(&making->watch, true); /* it tries whether a folder can be made */
    lq_status status = lq_folder_check(folder, error);
    lq_watch_hold(&making->watch, false);
    if (status != LQ_OK || !*making->cache) return status;
    status = lq_cache_check(making->cache, error);
    if (status == LQ_OK) lq_cache_clear(making->cache);
    return status;
}

static lq_status make(lq_making *making, lq_packing *packing, const char *folder, lq_pack_report **report,
                      lq_error *error) {
    lq_status status = check(making, folder, error);
    if (status == LQ_OK) status = make_all(making, packing, error);
    if (status != LQ_OK) return status;
    *report = lq_report_packing(packing);
    if (!*report) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    status = lq_report_judge(*report, making->recipe, error);
    return status == LQ_OK ? lq_make_files(making, packing, folder, error) : status;
}

lq_status lq_pack_make(const char *recipe_path, const char *folder, const lq_pack_options *options,
                       lq_pack_report **report, lq_error *error) {
    const size_t first = offsetof(lq_pack_options, watch) + sizeof options->watch;
    lq_pack_options o = lq_pack_options_default();
    lq_pack_report *made = NULL;
    lq_making making;
    lq_recipe recipe;
    lq_error own = {""}; /* messages are also told to who watches */
    if (!error) error = &own;
    if (report) *report = NULL;
    lq_status status = options ? lq_extend(&o, sizeof o, options, first, "pack options", error) : LQ_OK;
    if (status == LQ_OK) status = begin(&making, recipe_path, &o, error);
    if (status == LQ_OK) status = lq_recipe_read(&recipe, recipe_path, &o.trust, error);
    if (status != LQ_OK) return status;
    const int before = lq_threads_set(o.threads);
    lq_packing packing = {.recipe = &recipe};
    status = make(&making, &packing, folder, &made, error);
    lq_packing_free(&packing);
    lq_recipe_free(&recipe);
    lq_threads_set(before);
    if (report) *report = made;
    else lq_pack_report_free(made);
    return status;
}
