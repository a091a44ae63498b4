/* figure.c - panels: copies of what they show, and the scale they show it on. */
#include "picture/figure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/text.h"
#include "system/status.h"
#include "tables/facts.h"

static lq_status no_memory(lq_error *error) {
    return lq_fail(error, LQ_NO_MEMORY, "no memory for a picture");
}

lq_status lq_figure_create(lq_figure **figure, const char *title, const char *subtitle, lq_error *error) {
    *figure = calloc(1, sizeof **figure);
    if (!*figure) return no_memory(error);
    (*figure)->title = lq_text_clean(title);
    (*figure)->subtitle = lq_text_clean(subtitle ? subtitle : "");
    if ((*figure)->title && (*figure)->subtitle) return LQ_OK;
    lq_figure_free(*figure);
    *figure = NULL;
    return no_memory(error);
}

static void free_panel(lq_panel *panel) {
    free(panel->title);
    free(panel->caption);
    free(panel->quantity);
    lq_axis_free(&panel->x);
    lq_axis_free(&panel->y);
    for (size_t i = 0; i < LQ_PANEL_SERIES; i++) free(panel->series[i]);
    free(panel->values);
}

void lq_figure_free(lq_figure *figure) {
    if (!figure) return;
    for (size_t i = 0; i < figure->panel_count; i++) free_panel(&figure->panels[i]);
    free(figure->panels);
    lq_facts_free(figure->facts, figure->fact_count);
    free(figure->title);
    free(figure->subtitle);
    free(figure);
}

lq_status lq_figure_tell(lq_figure *figure, const char *key, const char *value, lq_error *error) {
    char *clean = lq_text_clean(value);
    if (!clean) return no_memory(error);
    const lq_status status = lq_facts_set(&figure->facts, &figure->fact_count, key, clean, error);
    free(clean);
    return status;
}

/* ======================================================================================
 *                                       The scale
 * ====================================================================================== */

/* Room around what does not differ, so that it can be divided by. */
static void widen(double range[2]) {
    if (!(range[0] <= range[1])) range[0] = 0.0, range[1] = 1.0; /* nothing is finite */
    const double least = fmax(1e-6 * fmax(fabs(range[0]), fabs(range[1])), 1e-30);
    if (range[1] - range[0] >= least) return;
    range[0] -= 0.5 * least;
    range[1] += 0.5 * least;
}

void lq_panel_range(lq_panel_form form, const float *values, size_t count, double range[2], bool *is_signed) {
    range[0] = form == LQ_PANEL_AREAS ? 0.0 : INFINITY;
    range[1] = form == LQ_PANEL_AREAS ? 0.0 : -INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) continue;
        range[0] = fmin(range[0], (double)values[i]);
        range[1] = fmax(range[1], (double)values[i]);
    }
    *is_signed = form == LQ_PANEL_MAP && range[0] < 0.0 && range[1] > 0.0;
    if (*is_signed) {
        range[1] = fmax(range[1], -range[0]);
        range[0] = -range[1];
    }
    widen(range);
}

/* Tops of the piles, one a column. */
static float *pile(const lq_panel *panel) {
    float *sums = calloc(panel->x.size, sizeof *sums);
    for (size_t i = 0; sums && i < panel->series_count * panel->x.size; i++)
        sums[i % panel->x.size] += panel->values[i];
    return sums;
}

static lq_status set_range(lq_panel *panel, const double *given, lq_error *error) {
    double range[2];
    if (panel->form == LQ_PANEL_AREAS) {
        float *sums = pile(panel);
        if (!sums) return no_memory(error);
        lq_panel_range(panel->form, sums, panel->x.size, range, &panel->is_signed);
        free(sums);
    } else
        lq_panel_range(panel->form, panel->values, panel->x.size * lq_panel_rows(panel), range,
                       &panel->is_signed);
    if (given) panel->is_signed = panel->is_signed && given[0] == -given[1];
    panel->low = given ? given[0] : range[0];
    panel->high = given ? given[1] : range[1];
    return LQ_OK;
}

/* ======================================================================================
 *                                         Panels
 * ====================================================================================== */

size_t lq_panel_rows(const lq_panel *panel) {
    return panel->form == LQ_PANEL_MAP ? panel->y.size : panel->series_count;
}

static bool copy_texts(lq_panel *panel, const lq_panel_parts *parts) {
    panel->title = lq_text_clean(parts->title);
    panel->caption = lq_text_clean(parts->caption ? parts->caption : "");
    panel->quantity = lq_text_clean(parts->quantity);
    bool fine = panel->title && panel->caption && panel->quantity;
    for (size_t i = 0; parts->form != LQ_PANEL_MAP && i < panel->series_count; i++)
        fine = (panel->series[i] = lq_text_clean(parts->series[i])) && fine;
    return fine;
}

static lq_status copy_values(lq_panel *panel, const lq_panel_parts *parts, lq_error *error) {
    lq_status status = lq_axis_copy(&panel->x, parts->x, error);
    if (status == LQ_OK && parts->form == LQ_PANEL_MAP) status = lq_axis_copy(&panel->y, parts->y, error);
    if (status != LQ_OK) return status;
    const size_t count = panel->x.size * lq_panel_rows(panel);
    panel->values = malloc(count * sizeof *panel->values);
    if (!panel->values) return no_memory(error);
    memcpy(panel->values, parts->values, count * sizeof *panel->values);
    return set_range(panel, parts->range, error);
}

lq_status lq_figure_add(lq_figure *figure, const lq_panel_parts *parts, lq_error *error) {
    if (figure->panel_count == LQ_FIGURE_PANELS || parts->series_count > LQ_PANEL_SERIES)
        return lq_fail(error, LQ_BAD_INPUT,
                       "a picture of %zu panels and %zu series; accepted: up to %d and %d",
                       figure->panel_count + 1, parts->series_count, LQ_FIGURE_PANELS, LQ_PANEL_SERIES);
    lq_panel *grown = realloc(figure->panels, (figure->panel_count + 1) * sizeof *grown);
    if (!grown) return no_memory(error);
    figure->panels = grown;
    lq_panel *panel = &grown[figure->panel_count];
    *panel = (lq_panel){.form = parts->form,
                        .series_count = parts->series_count,
                        .ordered = parts->ordered,
                        .reference = parts->reference};
    if (parts->form == LQ_PANEL_MAP) panel->series_count = 1;
    figure->panel_count++;
    return copy_texts(panel, parts) ? copy_values(panel, parts, error) : no_memory(error);
}
