/* published_mitsuba.c - Mitsuba 0.6 transmittance files: 17 bytes of magic, u64 n_eta, n_alpha, n_mu, float32
 * eta and alpha ranges, then two blocks, outside and inside, each [eta][alpha][mu..., cosine-weighted mean];
 * all axes are warped by t^4, and eta of the inside block is 1/eta of the outside one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/output.h"
#include "system/status.h"
#include "tables/axis.h"
#include "tables/published.h"

static const char magic[] = "MTS_TRANSMITTANCE"; /* 17 bytes without the NUL */
static const double warp = 4.0;

typedef struct mitsuba_header {
    uint64_t eta_count, alpha_count, mu_count;
    float eta_min, eta_max, alpha_min, alpha_max;
} mitsuba_header;

static lq_status read_mitsuba_header(lq_bytes *file, const char *path, const lq_stored *what,
                                     mitsuba_header *h, lq_error *error) {
    char start[sizeof magic - 1];
    uint64_t size[3];
    float range[4];
    if (!lq_published_take(file, start, sizeof start) || memcmp(start, magic, sizeof start) != 0)
        return lq_fail(error, LQ_FORMAT, "%s: not a Mitsuba transmittance file: no '%s' at its start", path,
                       magic);
    if (!lq_published_take(file, size, sizeof size) || !lq_published_take(file, range, sizeof range))
        return lq_published_foreign(path, what, error);
    *h = (mitsuba_header){size[0], size[1], size[2], range[0], range[1], range[2], range[3]};
    /* Two blocks of n_eta n_alpha (n_mu + 1). */
    const bool small = size[0] <= LQ_MAX_AXIS_SIZE && size[1] <= LQ_MAX_AXIS_SIZE;
    const uint64_t rows = small ? size[0] * size[1] : 0, block = size[2] <= LQ_MAX_AXIS_SIZE ? size[2] : 0;
    lq_status status = lq_published_check_length(file, path, what, size, 3, rows * (block + 2), error);
    if (status == LQ_OK) status = lq_published_check_range(path, "eta", h->eta_min, h->eta_max, error);
    if (status == LQ_OK) status = lq_published_check_range(path, "alpha", h->alpha_min, h->alpha_max, error);
    if (status == LQ_OK && !(h->eta_min > 0.0f))
        status = lq_fail(error, LQ_FORMAT, "%s: an index of %g is not positive", path, (double)h->eta_min);
    return status;
}

/* eta of the inside block is 1/eta of the outside one: a custom axis, and the rows in reverse order. */
static lq_status make_inside_eta(lq_axis *axis, const mitsuba_header *h, lq_error *error) {
    lq_axis outside;
    lq_status status = lq_axis_make(&outside, "eta", (double)h->eta_min, (double)h->eta_max, h->eta_count,
                                    LQ_MAP_POWER, warp, error);
    if (status != LQ_OK) return status;
    double *nodes = malloc(h->eta_count * sizeof *nodes);
    if (!nodes) status = lq_fail(error, LQ_NO_MEMORY, "no memory for an axis");
    for (size_t i = 0; nodes && i < h->eta_count; i++) nodes[i] = 1.0 / outside.nodes[h->eta_count - 1 - i];
    if (nodes) status = lq_axis_make_custom(axis, "eta", nodes, h->eta_count, error);
    free(nodes);
    lq_axis_free(&outside);
    return status;
}

static lq_status make_mitsuba_axis(lq_axis *axis, const char *name, const mitsuba_header *h, bool invert,
                                   lq_error *error) {
    if (strcmp(name, "mu") == 0)
        return lq_axis_make(axis, name, 0.0, 1.0, h->mu_count, LQ_MAP_POWER, warp, error);
    if (strcmp(name, "alpha") == 0)
        return lq_axis_make(axis, name, (double)h->alpha_min, (double)h->alpha_max, h->alpha_count,
                            LQ_MAP_POWER, warp, error);
    if (strcmp(name, "tau") == 0) return lq_axis_make(axis, name, 1.0, 1.0, 1, LQ_MAP_LINEAR, 0.0, error);
    if (invert) return make_inside_eta(axis, h, error);
    return lq_axis_make(axis, name, (double)h->eta_min, (double)h->eta_max, h->eta_count, LQ_MAP_POWER, warp,
                        error);
}

/* The file runs [eta][alpha][mu..., mean]. Its first mu is not 0 but a ten-thousandth of the second one. */
static void fill_mitsuba(lq_table *table, const float *block, const mitsuba_header *h, bool invert) {
    const bool diffuse = table->axis_count == 3;
    const size_t row = h->mu_count + 1;
    for (size_t e = 0; e < h->eta_count; e++)
        for (size_t a = 0; a < h->alpha_count; a++) {
            const float *from = block + (e * h->alpha_count + a) * row;
            const size_t to = invert ? h->eta_count - 1 - e : e;
            if (diffuse) table->channels[0][to + h->eta_count * a] = from[h->mu_count];
            else
                memcpy(table->channels[0] + h->mu_count * (a + h->alpha_count * to), from,
                       h->mu_count * sizeof *from);
        }
}

lq_status lq_mitsuba_read(lq_table **table, lq_bytes *file, const char *path, const lq_stored *what,
                          lq_error *error) {
    mitsuba_header h = {0};
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_status status = read_mitsuba_header(file, path, what, &h, error);
    if (status != LQ_OK) return status;
    const bool inside = what->layout == LQ_MITSUBA_INSIDE, diffuse = what->axis_count == 3;
    const bool invert = inside && !diffuse; /* diffuse-transmission has the index from above on its axis */
    for (int a = 0; status == LQ_OK && a < what->axis_count; a++)
        status = make_mitsuba_axis(&axes[a], what->axes[a], &h, invert, error);
    status = lq_published_make_table(table, status, what, axes, error);
    if (status != LQ_OK) return status;
    const size_t entries = h.eta_count * h.alpha_count * (h.mu_count + 1);
    float *block = malloc(entries * sizeof *block);
    if (!block) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu entries", entries);
    memcpy(block, file->data + file->at + (inside ? entries * sizeof *block : 0), entries * sizeof *block);
    fill_mitsuba(*table, block, &h, invert);
    free(block);
    return LQ_OK;
}

/* ======================================================================================
 *                                        Writing
 * ====================================================================================== */

static bool is_warped(const lq_axis *axis, const char *name) {
    return strcmp(axis->name, name) == 0 && axis->size >= 2 && axis->map == LQ_MAP_POWER &&
           axis->exponent == warp;
}

static bool is_no_loss(const lq_axis *axis) {
    return strcmp(axis->name, "tau") == 0 && axis->size == 1 && axis->nodes[0] == 1.0;
}

lq_status lq_mitsuba_check(const lq_stored *what, const lq_axis *axes, int axis_count, lq_error *error) {
    static const char *const names[] = {"mu", "alpha", "eta"};
    if (axis_count != 4 || what->axis_count != 4)
        return lq_fail(error, LQ_BAD_INPUT, "layout mitsuba stores transmission over 4 axes, not %d",
                       axis_count);
    for (int a = 0; a < 3; a++)
        if (!is_warped(&axes[a], names[a]))
            return lq_fail(error, LQ_BAD_INPUT,
                           "layout mitsuba stores %s over 2 nodes or more of map power4; %s has %zu, %s",
                           names[a], axes[a].name, axes[a].size, lq_map_name(axes[a].map));
    if (axes[0].min != 0.0 || axes[0].max != 1.0)
        return lq_fail(error, LQ_BAD_INPUT, "layout mitsuba stores mu from 0 to 1, not %g to %g", axes[0].min,
                       axes[0].max);
    if (axes[2].min < 1.0)
        return lq_fail(error, LQ_BAD_INPUT,
                       "layout mitsuba stores eta >= 1 and adds 1/eta itself; eta starts at %g", axes[2].min);
    if (!is_no_loss(&axes[3]))
        return lq_fail(error, LQ_BAD_INPUT, "layout mitsuba stores tau = 1 alone; it has %zu nodes from %g",
                       axes[3].size, axes[3].min);
    return LQ_OK;
}

static bool same_nodes(const lq_axis *a, const lq_axis *b) {
    bool same = a->size == b->size;
    for (size_t i = 0; same && i < a->size; i++) same = fabs(a->nodes[i] - b->nodes[i]) <= 1e-9;
    return same;
}

static bool inverted_nodes(const lq_axis *a, const lq_axis *b) {
    bool same = a->size == b->size;
    for (size_t i = 0; same && i < a->size; i++)
        same = fabs(a->nodes[i] * b->nodes[a->size - 1 - i] - 1.0) <= 1e-6;
    return same;
}

static lq_status check_parts(const lq_table *outside, const lq_table *inside, const lq_table *diffuse,
                             lq_error *error) {
    static const lq_stored whole = {.layout = LQ_MITSUBA, .kind = "transmission", .axis_count = 4};
    const lq_axis *a = outside->axes, *b = inside->axes, *d = diffuse->axes;
    const lq_status status = lq_mitsuba_check(&whole, a, outside->axis_count, error);
    if (status != LQ_OK) return status;
    if (inside->axis_count != 4 || !same_nodes(&a[0], &b[0]) || !same_nodes(&a[1], &b[1]) ||
        !inverted_nodes(&a[2], &b[2]) || !is_no_loss(&b[3]))
        return lq_fail(error, LQ_BAD_INPUT,
                       "the inside table is not over the same mu and alpha, 1/eta and tau = 1");
    if (diffuse->axis_count != 3 || !same_nodes(&a[2], &d[0]) || !same_nodes(&a[1], &d[1]) ||
        !is_no_loss(&d[2]))
        return lq_fail(error, LQ_BAD_INPUT,
                       "the diffuse table is not over the same eta and alpha, and tau = 1");
    return LQ_OK;
}

static lq_status write_header(const lq_table *outside, lq_output *output, lq_error *error) {
    const lq_axis *mu = &outside->axes[0], *alpha = &outside->axes[1], *eta = &outside->axes[2];
    const uint64_t size[] = {eta->size, alpha->size, mu->size};
    const float range[] = {(float)eta->min, (float)eta->max, (float)alpha->min, (float)alpha->max};
    lq_status status = lq_output_write(output, magic, sizeof magic - 1, error);
    if (status == LQ_OK) status = lq_output_write(output, size, sizeof size, error);
    return status == LQ_OK ? lq_output_write(output, range, sizeof range, error) : status;
}

/* One block: rows of cosines, each followed by its mean. */
static lq_status write_block(const lq_table *table, const lq_table *diffuse, bool invert, lq_output *output,
                             lq_error *error) {
    const size_t mus = table->axes[0].size, alphas = table->axes[1].size, etas = table->axes[2].size;
    lq_status status = LQ_OK;
    for (size_t e = 0; e < etas; e++)
        for (size_t a = 0; status == LQ_OK && a < alphas; a++) {
            const size_t from = invert ? etas - 1 - e : e;
            const double eta = diffuse->axes[0].nodes[e];
            const double inside = (double)diffuse->channels[0][e + etas * a];
            const float mean = (float)(invert ? inside : fmin(eta * eta * inside, 1.0));
            status = lq_output_write(output, table->channels[0] + mus * (a + alphas * from),
                                     mus * sizeof(float), error);
            if (status == LQ_OK) status = lq_output_write(output, &mean, sizeof mean, error);
        }
    return status;
}

lq_status lq_mitsuba_write(const lq_table *outside, const lq_table *inside, const lq_table *diffuse,
                           const char *path, lq_error *error) {
    lq_output *output;
    lq_status status = check_parts(outside, inside, diffuse, error);
    if (status == LQ_OK) status = lq_output_open(&output, path, error);
    if (status != LQ_OK) return status;
    status = write_header(outside, output, error);
    if (status == LQ_OK) status = write_block(outside, diffuse, false, output, error);
    if (status == LQ_OK) status = write_block(inside, diffuse, true, output, error);
    if (status == LQ_OK) return lq_output_commit(output, error);
    lq_output_abandon(output);
    return status;
}
