/* factored.c - four bases of a factor in each layer of a texture array. */
#include "pack/factored.h"

#include "pack/names.h"
#include "pca/factors.h"

#include <stdio.h>
#include <string.h>

static lq_status lay_out(lq_bases *bases, const lq_factor *factor, const char *name, lq_error *error) {
    const size_t width = factor->axes[0].texels.size, texels = lq_factor_texels(factor);
    const size_t layers = (factor->base_count + LQ_BASES_PER_LAYER - 1) / LQ_BASES_PER_LAYER;
    lq_status status =
        lq_image_create(&bases->image, width, texels / width, 1, layers, LQ_BASES_PER_LAYER, error);
    if (status != LQ_OK) return status;
    bases->image.array = true;
    for (size_t b = 0; b < factor->base_count; b++)
        for (size_t i = 0; i < texels; i++)
            bases->image
                .data[(b / LQ_BASES_PER_LAYER * texels + i) * LQ_BASES_PER_LAYER + b % LQ_BASES_PER_LAYER] =
                factor->data[b * texels + i];
    return lq_image_to_half(&bases->image, name, error);
}

lq_status lq_factored_layout(lq_factored_textures *textures, const lq_factored *factored, const char *name,
                             lq_error *error) {
    lq_status status = LQ_OK;
    *textures = (lq_factored_textures){.factored = factored};
    snprintf(textures->stem, sizeof textures->stem, "%s", name);
    lq_make_identifier(textures->name, name);
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; f < factored->pieces[p].factor_count && status == LQ_OK; f++) {
            lq_bases *bases = &textures->bases[textures->count++];
            bases->piece = p;
            bases->factor = f;
            snprintf(bases->suffix, sizeof bases->suffix, "%d_%d", p, f);
            status = lay_out(bases, &factored->pieces[p].factors[f], name, error);
        }
    if (status != LQ_OK) lq_factored_textures_free(textures);
    return status;
}

void lq_factored_textures_free(lq_factored_textures *textures) {
    for (size_t i = 0; i < textures->count; i++) lq_image_free(&textures->bases[i].image);
    *textures = (lq_factored_textures){0};
}

size_t lq_factored_textures_bytes(const lq_factored_textures *textures) {
    size_t bytes = 0;
    for (size_t i = 0; i < textures->count; i++) bytes += lq_image_bytes(&textures->bases[i].image);
    return bytes;
}
