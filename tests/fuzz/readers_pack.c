/* readers_pack.c - containers of textures, manifests, recipes and scenes. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>

#include "pack/contents.h"
#include "pack/read.h"
#include "pack/recipe.h"

/* Sizes as a manifest says them: the first bytes. */
static void read_image(lq_container container, const char *name, const uint8_t *bytes, size_t size) {
    static const int channels[] = {1, 2, 4};
    lq_error error = {""};
    lq_image image;
    if (size < 5) return;
    if (lq_image_create(&image, 1 + bytes[0] % 16, 1 + bytes[1] % 16, 1 + bytes[2] % 4, 1 + bytes[3] % 4,
                        channels[bytes[4] % 3], &error) == LQ_OK)
        lq_image_read(&image, container, fuzz_file(name, bytes + 5, size - 5), &error);
    lq_image_free(&image);
}

void fuzz_ktx2(const uint8_t *bytes, size_t size) {
    read_image(LQ_CONTAINER_KTX2, "image.ktx2", bytes, size);
}

void fuzz_dds(const uint8_t *bytes, size_t size) {
    read_image(LQ_CONTAINER_DDS, "image.dds", bytes, size);
}

/* The files that the manifests of the corpus name, in every container. */
static void write_images(void) {
    static const struct {
        const char *stem;
        size_t width, height;
        int channels;
        bool array;
    } all[] = {{"a", 8, 8, 1, false},
               {"b.0_0", 8, 1, 4, true},
               {"b.0_1", 8, 1, 4, true},
               {"atlas", 27, 18, 4, false}};
    lq_error error = {""};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        lq_image image;
        if (lq_image_create(&image, all[i].width, all[i].height, 1, 1, all[i].channels, &error) != LQ_OK)
            abort();
        image.array = all[i].array;
        for (int c = 0; c < LQ_CONTAINERS; c++) {
            char path[128];
            snprintf(path, sizeof path, "%s/%s%s", fuzz_folder(), all[i].stem,
                     lq_container_ending((lq_container)c));
            if (lq_image_write(&image, (lq_container)c, "texels", path, &error) != LQ_OK) abort();
        }
        lq_image_free(&image);
    }
}

void fuzz_manifest(const uint8_t *bytes, size_t size) {
    static bool written;
    lq_error error = {""};
    lq_pack pack;
    lq_contents contents;
    if (!written) write_images();
    written = true;
    fuzz_file(LQ_MANIFEST, bytes, size);
    if (lq_pack_read(&pack, fuzz_folder(), &error) == LQ_OK) lq_pack_free(&pack);
    if (lq_contents_read(&contents, fuzz_folder(), &error) == LQ_OK) lq_contents_free(&contents);
}

void fuzz_recipe(const uint8_t *bytes, size_t size) {
    lq_error error = {""};
    lq_recipe *recipe = malloc(sizeof *recipe);
    if (lq_recipe_read(recipe, fuzz_file("recipe.json", bytes, size), NULL, &error) == LQ_OK)
        lq_recipe_free(recipe);
    free(recipe);
}
