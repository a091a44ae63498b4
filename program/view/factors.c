/* factors.c - a factored table as pictures: what its bases are, before they are multiplied and summed. */
#include "program/view/view.h"

#include <stdio.h>
#include <string.h>

#include "pca/factors.h"

/* Planes of one factor that are shown one by one. */
enum { PLANES_MAX = 24 };

static lq_status add_plane(lq_figure *figure, const lq_factor *factor, size_t base, const char *title,
                           lq_error *error) {
    char caption[64];
    snprintf(caption, sizeof caption, "base %zu of %zu", base + 1, factor->base_count);
    const lq_panel_parts parts = {.form = LQ_PANEL_MAP,
                                  .title = title,
                                  .caption = caption,
                                  .quantity = "factor",
                                  .x = &factor->axes[0].texels,
                                  .y = &factor->axes[1].texels,
                                  .values = factor->data + base * lq_factor_texels(factor)};
    return lq_figure_add(figure, &parts, error);
}

static lq_status add_lines(lq_figure *figure, const lq_factor *factor, const char *title, lq_error *error) {
    const size_t count = factor->base_count < LQ_PANEL_SERIES ? factor->base_count : LQ_PANEL_SERIES;
    char names[LQ_PANEL_SERIES][24], caption[64];
    const char *series[LQ_PANEL_SERIES];
    for (size_t i = 0; i < count; i++) {
        snprintf(names[i], sizeof names[i], "base %zu", i + 1);
        series[i] = names[i];
    }
    snprintf(caption, sizeof caption, "%zu of %zu lines", count, factor->base_count);
    const lq_panel_parts parts = {.form = LQ_PANEL_LINES,
                                  .title = title,
                                  .caption = caption,
                                  .quantity = "factor",
                                  .x = &factor->axes[0].texels,
                                  .series_count = count,
                                  .series = series,
                                  .values = factor->data};
    return lq_figure_add(figure, &parts, error);
}

static lq_status add_factor(lq_figure *figure, const lq_factor *factor, const char *title, lq_error *error) {
    if (factor->axis_count == 1) return add_lines(figure, factor, title, error);
    lq_status status = LQ_OK;
    for (size_t b = 0; status == LQ_OK && b < factor->base_count && b < PLANES_MAX; b++)
        status = add_plane(figure, factor, b, title, error);
    return status;
}

/* "piece 1: eta 1.1 to 1.5, ..." where there are several. */
static void name_piece(const lq_factored *factored, int p, char *text, size_t size) {
    const lq_piece *piece = &factored->pieces[p];
    size_t used = 0;
    text[0] = '\0';
    if (factored->piece_count == 1) return;
    for (int a = 0; a < factored->axis_count && used < size; a++)
        if (piece->min[a] > factored->axes[a].min || piece->max[a] < factored->axes[a].max)
            used += (size_t)snprintf(text + used, size - used, ", %s %.4g to %.4g", factored->axes[a].name,
                                     piece->min[a], piece->max[a]);
}

lq_status view_add_factors(lq_figure *figure, const lq_factored *factored, const char *name,
                           lq_error *error) {
    lq_status status = LQ_OK;
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; status == LQ_OK && f < factored->pieces[p].factor_count; f++) {
            char title[LQ_MESSAGE_SIZE], piece[LQ_MESSAGE_SIZE / 2];
            name_piece(factored, p, piece, sizeof piece);
            snprintf(title, sizeof title, "%s%sfactor %d_%d%s", name, *name ? " " : "", p, f, piece);
            status = add_factor(figure, &factored->pieces[p].factors[f], title, error);
        }
    return status;
}

/* "222 bytes, 3 textures; max error 1e-3, rms 2e-4". */
static void describe(const lq_factored *factored, const char *name, char *text, size_t size) {
    const char *max = lq_factored_fact(factored, "pca-max"), *rms = lq_factored_fact(factored, "pca-rms");
    int factors = 0;
    for (int p = 0; p < factored->piece_count; p++) factors += factored->pieces[p].factor_count;
    snprintf(text, size, "%s · %d factors, %zu bytes%s%s%s%s", name, factors, lq_factored_bytes(factored),
             max ? ", largest error " : "", max ? max : "", rms ? ", rms " : "", rms ? rms : "");
}

lq_status view_factors(const lq_factored *factored, const char *name, lq_figure **figure, lq_error *error) {
    char text[LQ_MESSAGE_SIZE];
    describe(factored, name, text, sizeof text);
    const lq_status status = view_begin(factored->facts, factored->fact_count, name, text, figure, error);
    return status == LQ_OK ? view_add_factors(*figure, factored, "", error) : status;
}
