/* make_files.c - the files of a pack: images in their containers, decode source, page and manifest. */
#include "pack/folder.h"
#include "pack/make.h"
#include "pack/page.h"

#include <stdio.h>

static lq_status write_image(const lq_recipe *recipe, const lq_image *image, const char *stem,
                             const char *array, const char *folder, lq_error *error) {
    char path[PATH_MAX + 64];
    lq_status status = LQ_OK;
    for (int c = 0; c < LQ_CONTAINERS && status == LQ_OK; c++) {
        if (!recipe->containers[c]) continue;
        snprintf(path, sizeof path, "%s/%s%s", folder, stem, lq_container_ending((lq_container)c));
        status = lq_image_write(image, (lq_container)c, array, path, error);
    }
    return status;
}

static lq_status write_one(const lq_recipe *recipe, const lq_packed *p, const char *folder, lq_error *error) {
    char path[PATH_MAX + 64], stem[64], array[96];
    lq_status status = LQ_OK;
    for (size_t i = 0; i < lq_packed_images(p) && status == LQ_OK && !recipe->atlas; i++) {
        lq_packed_stem(p, i, stem, sizeof stem);
        lq_packed_array(p, i, array, sizeof array);
        status = write_image(recipe, lq_packed_image(p, i), stem, array, folder, error);
    }
    for (int l = 0; l < LQ_LAYOUTS && status == LQ_OK; l++) {
        if (!p->from->layouts[l]) continue;
        snprintf(path, sizeof path, "%s/%s.%s.bin", folder, p->from->name, lq_layout_name((lq_layout)l));
        status = lq_published_write(p->table, path, (lq_layout)l, error);
    }
    return status;
}

static lq_status write_sources(const lq_packing *packing, const char *folder, lq_error *error) {
    char path[PATH_MAX + 64];
    lq_status status = LQ_OK;
    for (int l = 0; l < lq_packing_languages(packing->recipe) && status == LQ_OK; l++) {
        snprintf(path, sizeof path, "%s/%s", folder, lq_language_file((lq_language)l));
        status = lq_packing_source(packing, (lq_language)l, path, error);
    }
    return status;
}

static lq_status write_files(const lq_making *making, const lq_packing *packing, const char *folder,
                             lq_error *error) {
    const lq_recipe *recipe = packing->recipe;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < recipe->count && status == LQ_OK; i++) {
        status = write_one(recipe, &packing->tables[i], folder, error);
        if (status == LQ_OK) status = lq_watch_go_on(&making->watch);
    }
    if (status == LQ_OK && recipe->atlas)
        status = write_image(recipe, &packing->atlas.image, "atlas", "lacquer_atlas_texels", folder, error);
    if (status == LQ_OK) status = write_sources(packing, folder, error);
    if (status == LQ_OK && recipe->material_count > 0) {
        char path[PATH_MAX + 64];
        snprintf(path, sizeof path, "%s/" LQ_PACK_PAGE, folder);
        status = lq_pack_page_write(packing, path, error);
    }
    return status == LQ_OK ? lq_manifest_write(packing, folder, error) : status;
}

static lq_status write_folder(const lq_making *making, const lq_packing *packing, const char *target,
                              lq_error *error) {
    lq_folder folder;
    lq_status status = lq_folder_open(&folder, target, error);
    if (status != LQ_OK) return status;
    status = write_files(making, packing, folder.staging, error);
    if (status == LQ_OK) status = lq_watch_go_on(&making->watch);
    if (status == LQ_OK) status = lq_folder_commit(&folder, error);
    if (status != LQ_OK) lq_folder_abandon(&folder);
    return status;
}

lq_status lq_make_files(const lq_making *making, const lq_packing *packing, const char *target,
                        lq_error *error) {
    lq_watch_hold(&making->watch, true);
    const lq_status status = write_folder(making, packing, target, error);
    lq_watch_hold(&making->watch, false);
    return status;
}
