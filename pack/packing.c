/* packing.c - what a pack holds, put together: the atlas and the decode source. */
#include "pack/manifest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/output.h"
#include "system/status.h"

size_t lq_packed_images(const lq_packed *packed) {
    return packed->factored ? packed->factors.count : 1;
}

const lq_image *lq_packed_image(const lq_packed *packed, size_t i) {
    return packed->factored ? &packed->factors.bases[i].image : &packed->texture.image;
}

int lq_packed_channels(const lq_packed *packed, size_t i) {
    if (!packed->factored) return packed->texture.channel_count;
    const lq_bases *bases = &packed->factors.bases[i];
    const size_t count = packed->factored->pieces[bases->piece].factors[bases->factor].base_count;
    return (int)((count - 1) % LQ_BASES_PER_LAYER) + 1;
}

void lq_packed_stem(const lq_packed *packed, size_t i, char *stem, size_t size) {
    if (packed->factored) snprintf(stem, size, "%s.%s", packed->from->name, packed->factors.bases[i].suffix);
    else snprintf(stem, size, "%s", packed->from->name);
}

void lq_packed_array(const lq_packed *packed, size_t i, char *array, size_t size) {
    if (packed->factored)
        snprintf(array, size, "lacquer_%s_%s_texels", packed->factors.name, packed->factors.bases[i].suffix);
    else snprintf(array, size, "lacquer_%s_texels", packed->texture.name);
}

size_t lq_packed_bytes(const lq_packed *packed) {
    size_t bytes = 0;
    for (size_t i = 0; i < lq_packed_images(packed); i++) bytes += lq_image_bytes(lq_packed_image(packed, i));
    return bytes;
}

int lq_packing_languages(const lq_recipe *recipe) {
    return recipe->atlas ? LQ_LANGUAGES : LQ_SOURCE_LANGUAGES;
}

lq_status lq_packing_place(lq_packing *p, lq_error *error) {
    const lq_recipe *recipe = p->recipe;
    lq_status status = LQ_OK;
    size_t *first = p->tiles = calloc(recipe->count + recipe->material_count + 1, sizeof *p->tiles);
    if (!p->tiles) return lq_fail(error, LQ_NO_MEMORY, "no memory for an atlas");
    for (size_t t = 0; t < recipe->count; t++, first++)
        for (size_t i = 0; i < lq_packed_images(&p->tables[t]) && status == LQ_OK; i++) {
            size_t tile;
            status = lq_atlas_add(&p->atlas, lq_packed_image(&p->tables[t], i),
                                  lq_packed_channels(&p->tables[t], i), recipe->tables[t].name, &tile, error);
            if (i == 0) *first = tile;
        }
    for (size_t m = 0; m < recipe->material_count && status == LQ_OK; m++, first++)
        if (p->materials[m].lobes.channel_count > 0)
            status = lq_atlas_add(&p->atlas, &p->materials[m].lobes.image, LQ_LOBES_PER_TEXEL,
                                  p->materials[m].name, first, error);
    return status == LQ_OK ? lq_atlas_make(&p->atlas, error) : status;
}

static void list_sources(const lq_packing *p, lq_source_table *tables) {
    for (size_t i = 0; i < p->recipe->count; i++) {
        const lq_packed *table = &p->tables[i];
        tables[i] =
            (lq_source_table){table->from->kind, table->factored ? NULL : &table->texture, &table->factors};
    }
}

lq_status lq_packing_source_text(const lq_packing *p, lq_language language, char **text, lq_error *error) {
    const lq_recipe *recipe = p->recipe;
    lq_source_table sources[LQ_RECIPE_TABLES];
    lq_atlas_table tables[LQ_RECIPE_TABLES];
    lq_atlas_material materials[LQ_RECIPE_MATERIALS];
    list_sources(p, sources);
    for (size_t i = 0; i < recipe->count; i++) tables[i] = (lq_atlas_table){sources[i], p->tiles[i]};
    for (size_t i = 0; i < recipe->material_count; i++)
        materials[i] =
            (lq_atlas_material){p->materials[i].name, &p->materials[i].lobes, p->tiles[recipe->count + i]};
    const lq_atlas_contents contents = {&p->atlas, recipe->count, recipe->material_count, tables, materials};
    return lq_atlas_source_text(language, &contents, text, error);
}

lq_status lq_packing_source(const lq_packing *p, lq_language language, const char *path, lq_error *error) {
    lq_source_table tables[LQ_RECIPE_TABLES];
    char *text = NULL;
    if ((int)language >= lq_packing_languages(p->recipe))
        return lq_fail(error, LQ_BAD_INPUT, "%s: this language is for packs with an atlas", path);
    list_sources(p, tables);
    if (!p->recipe->atlas) return lq_source_write(language, tables, p->recipe->count, path, error);
    lq_status status = lq_packing_source_text(p, language, &text, error);
    if (status == LQ_OK) status = lq_output_save(path, text, strlen(text), error);
    free(text);
    return status;
}

size_t lq_packing_bytes(const lq_packing *p) {
    size_t bytes = 0;
    if (p->recipe->atlas) return lq_image_bytes(&p->atlas.image);
    for (size_t i = 0; i < p->recipe->count; i++) bytes += lq_packed_bytes(&p->tables[i]);
    return bytes;
}

void lq_packing_free(lq_packing *p) {
    for (size_t i = 0; p->tables && i < p->recipe->count; i++) {
        lq_table_free(p->tables[i].table);
        lq_texture_free(&p->tables[i].texture);
        lq_factored_textures_free(&p->tables[i].factors);
        lq_factored_free(p->tables[i].factored);
    }
    for (size_t i = 0; p->materials && i < p->recipe->material_count; i++) {
        lq_lobes_free(&p->materials[i].lobes);
        lq_lobes_free(&p->materials[i].reference);
    }
    lq_atlas_free(&p->atlas);
    free(p->tables);
    free(p->materials);
    free(p->tiles);
    *p = (lq_packing){0};
}
