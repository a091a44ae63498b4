/* atlas.c - tiles on a skyline, the highest first. */
#include "pack/atlas.h"

#include <stdlib.h>
#include <string.h>

#include "system/status.h"

enum { BORDER = 1, CHANNELS = 4, WIDEST = 4096 };

lq_status lq_atlas_add(lq_atlas *atlas, const lq_image *image, int used, const char *name, size_t *first,
                       lq_error *error) {
    if (image->depth > 1)
        return lq_fail(error, LQ_BAD_INPUT,
                       "%s: a volume does not go into an atlas; accepted: two axes, or factors", name);
    *first = atlas->count;
    if (atlas->count + image->layers > atlas->room) {
        const size_t room = 2 * (atlas->count + image->layers);
        lq_tile *tiles = realloc(atlas->tiles, room * sizeof *tiles);
        if (!tiles) return lq_fail(error, LQ_NO_MEMORY, "no memory for an atlas");
        atlas->tiles = tiles;
        atlas->room = room;
    }
    for (size_t l = 0; l < image->layers; l++)
        atlas->tiles[atlas->count++] =
            (lq_tile){.image = image, .layer = l, .used = l + 1 < image->layers ? image->channels : used};
    return LQ_OK;
}

static size_t width_of(const lq_tile *tile) {
    return tile->image->width + 2 * BORDER;
}

static size_t height_of(const lq_tile *tile) {
    return tile->image->height + 2 * BORDER;
}

/* The highest first, then the widest, then as they were added. */
static int by_height(const void *a, const void *b) {
    const lq_tile *x = *(lq_tile *const *)a, *y = *(lq_tile *const *)b;
    if (height_of(x) != height_of(y)) return height_of(x) > height_of(y) ? -1 : 1;
    if (width_of(x) != width_of(y)) return width_of(x) > width_of(y) ? -1 : 1;
    return x < y ? -1 : 1;
}

/* The highest point of the skyline under a tile whose left edge is at x. */
static size_t floor_at(const size_t *skyline, size_t x, size_t width) {
    size_t y = 0;
    for (size_t i = x; i < x + width; i++) y = skyline[i] > y ? skyline[i] : y;
    return y;
}

/* Place every tile in an atlas of that width, each as low as it goes and then as far left; its height.
 * `skyline` holds the height of what stands in each column. */
static size_t place(lq_tile *const *order, size_t count, size_t width, size_t *skyline) {
    size_t height = 0;
    memset(skyline, 0, width * sizeof *skyline);
    for (size_t i = 0; i < count; i++) {
        size_t best = 0, low = SIZE_MAX;
        for (size_t x = 0; x + width_of(order[i]) <= width; x++) {
            const size_t y = floor_at(skyline, x, width_of(order[i]));
            if (y < low) {
                low = y;
                best = x;
            }
        }
        order[i]->x = best + BORDER;
        order[i]->y = low + BORDER;
        const size_t top = low + height_of(order[i]);
        for (size_t x = best; x < best + width_of(order[i]); x++) skyline[x] = top;
        height = top > height ? top : height;
    }
    return height;
}

/* The width of the smallest atlas whose height is at most twice its width. */
static size_t choose_width(lq_tile *const *order, size_t count, size_t *skyline) {
    size_t widest = 1, area = 0, best = 0, least = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        widest = width_of(order[i]) > widest ? width_of(order[i]) : widest;
        area += width_of(order[i]) * height_of(order[i]);
    }
    for (size_t width = widest; width <= WIDEST; width++) {
        if (width > widest && width * width > 4 * area) break; /* flat and wide: emptier and emptier */
        const size_t height = place(order, count, width, skyline);
        if (height > 2 * width || width * height >= least) continue;
        least = width * height;
        best = width;
    }
    return best ? best : widest;
}

static size_t clamped(size_t i, size_t size) { /* i counts from the border */
    return i < BORDER ? 0 : i - BORDER < size ? i - BORDER : size - 1;
}

static void copy_tile(const lq_atlas *atlas, const lq_tile *tile) {
    const lq_image *from = tile->image;
    const size_t channels = (size_t)from->channels, used = (size_t)tile->used;
    const size_t first = tile->layer * from->width * from->height;
    for (size_t y = 0; y < height_of(tile); y++)
        for (size_t x = 0; x < width_of(tile); x++) {
            const size_t texel = first + clamped(y, from->height) * from->width + clamped(x, from->width);
            const size_t to = (tile->y - BORDER + y) * atlas->image.width + tile->x - BORDER + x;
            memcpy(&atlas->image.data[to * CHANNELS + (size_t)tile->channel], &from->data[texel * channels],
                   used * sizeof(float));
        }
}

/* The tile in whose channels a tile finds room: an earlier one of its size, or itself. */
static size_t host_of(const lq_atlas *atlas, size_t i, const int *taken) {
    const lq_tile *tile = &atlas->tiles[i];
    for (size_t h = 0; h < i; h++)
        if (taken[h] > 0 && taken[h] + tile->used <= CHANNELS &&
            width_of(&atlas->tiles[h]) == width_of(tile) && height_of(&atlas->tiles[h]) == height_of(tile))
            return h;
    return i;
}

/* hosts[i] of every tile; channels are set. `taken`: of those that host themselves. */
static void share(const lq_atlas *atlas, size_t *hosts, int *taken) {
    for (size_t i = 0; i < atlas->count; i++) {
        const size_t h = hosts[i] = host_of(atlas, i, taken);
        atlas->tiles[i].channel = h == i ? 0 : taken[h];
        if (h == i) taken[i] = 0;
        taken[h] += atlas->tiles[i].used;
        if (h != i) taken[i] = 0;
    }
}

lq_status lq_atlas_make(lq_atlas *atlas, lq_error *error) {
    lq_tile **order = malloc((atlas->count + 1) * sizeof *order);
    size_t *skyline = malloc((WIDEST + 1) * sizeof *skyline);
    size_t *hosts = calloc(atlas->count + 1, sizeof *hosts);
    int *taken = calloc(atlas->count + 1, sizeof *taken);
    if (!order || !skyline || !hosts || !taken) {
        free(order);
        free(skyline);
        free(hosts);
        free(taken);
        return lq_fail(error, LQ_NO_MEMORY, "no memory for an atlas");
    }
    size_t count = 0;
    share(atlas, hosts, taken);
    for (size_t i = 0; i < atlas->count; i++)
        if (hosts[i] == i) order[count++] = &atlas->tiles[i];
    qsort(order, count, sizeof *order, by_height);
    const size_t width = choose_width(order, count, skyline);
    const size_t height = place(order, count, width, skyline);
    for (size_t i = 0; i < atlas->count; i++) {
        atlas->tiles[i].x = atlas->tiles[hosts[i]].x;
        atlas->tiles[i].y = atlas->tiles[hosts[i]].y;
    }
    free(order);
    free(skyline);
    free(hosts);
    free(taken);
    lq_status status = lq_image_create(&atlas->image, width, height, 1, 1, CHANNELS, error);
    for (size_t i = 0; i < atlas->count && status == LQ_OK; i++) copy_tile(atlas, &atlas->tiles[i]);
    return status;
}

void lq_atlas_free(lq_atlas *atlas) {
    free(atlas->tiles);
    lq_image_free(&atlas->image);
    *atlas = (lq_atlas){0};
}
