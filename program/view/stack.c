/* stack.c - a stack as pictures: where its light goes, by path, and which way, over the cosine of incidence.
 */
#include "program/view/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "program/light.h"
#include "program/message.h"
#include "program/progress.h"
#include "system/status.h"

/* Paths shown apart; what the last one may hold before there are more. */
enum { COSINES = 49, PATHS_MAX = 6 };
static const double LAST_PATH = 0.01;

/* What lq_stack_solve gives, and how it lies. */
typedef struct solved {
    const lq_stack *stack;
    lq_axis mu;
    size_t paths;
    int channels;
    lq_stack_light *light;
} solved;

static const char *const channel_names[LQ_STACK_CHANNELS] = {"red", "green", "blue"};

static const lq_stack_lobe *lobe_of(const solved *s, size_t m, int channel, size_t path, bool transmitted) {
    const lq_stack_light *light = &s->light[(m * (size_t)s->channels + (size_t)channel) * s->paths + path];
    return transmitted ? &light->transmitted : &light->reflected;
}

/* One number of a lobe; NaN where there is no light. */
typedef double lobe_number(const lq_stack_lobe *lobe);

static double energy(const lq_stack_lobe *lobe) {
    return lobe->energy;
}

static double direction(const lq_stack_lobe *lobe) {
    return lobe->energy > 0.0 ? lobe->mean : NAN;
}

static double spread(const lq_stack_lobe *lobe) {
    return lobe->energy > 0.0 ? sqrt(fmax(lobe->sin2 - lobe->mean * lobe->mean, 0.0)) : NAN;
}

/* ======================================================================================
 *                                         Panels
 * ====================================================================================== */

/* A chart of one number of every path, and what is on it besides. */
typedef struct chart {
    lq_panel_form form;
    const char *title, *caption, *quantity;
    lobe_number *number;
    bool transmitted, mirror; /* mirror: a curve of where a mirror sends the light */
} chart;

static void name_series(const solved *s, char names[PATHS_MAX + 1][40], const char *series[PATHS_MAX + 1]) {
    for (size_t p = 0; p < s->paths; p++) {
        const bool last = p + 1 == s->paths;
        if (p == 0) snprintf(names[p], sizeof names[p], "met once");
        else snprintf(names[p], sizeof names[p], last ? "%zu or more" : "%zu times", p + 1);
        series[p] = names[p];
    }
    series[s->paths] = "mirror";
}

static lq_status add_chart(lq_figure *figure, const solved *s, int channel, const chart *what,
                           lq_error *error) {
    static const double whole[2] = {0.0, 1.0};
    char names[PATHS_MAX + 1][40], title[96];
    const char *series[PATHS_MAX + 1];
    float values[(PATHS_MAX + 1) * COSINES];
    name_series(s, names, series);
    for (size_t p = 0; p < s->paths; p++)
        for (size_t m = 0; m < COSINES; m++)
            values[p * COSINES + m] = (float)what->number(lobe_of(s, m, channel, p, what->transmitted));
    for (size_t m = 0; m < COSINES; m++)
        values[s->paths * COSINES + m] = (float)sqrt(1.0 - s->mu.nodes[m] * s->mu.nodes[m]);
    snprintf(title, sizeof title, "%s%s%s", what->title, s->channels > 1 ? ", " : "",
             s->channels > 1 ? channel_names[channel] : "");
    const lq_panel_parts parts = {.form = what->form,
                                  .title = title,
                                  .caption = what->caption,
                                  .quantity = what->quantity,
                                  .x = &s->mu,
                                  .series_count = s->paths + what->mirror,
                                  .series = series,
                                  .values = values,
                                  .range = what->form == LQ_PANEL_AREAS ? whole : NULL,
                                  .ordered = true,
                                  .reference = what->mirror};
    return lq_figure_add(figure, &parts, error);
}

static bool is_opaque(const solved *s) {
    return s->stack->layers[s->stack->layer_count - 1].type != LQ_LAYER_DIELECTRIC;
}

/* Energies of every channel; then, as they hardly differ between channels, moments of the first. */
static lq_status add_charts(lq_figure *figure, const solved *s, lq_error *error) {
    static const chart energies[] = {{LQ_PANEL_AREAS, "reflected", "by how often light met the first surface",
                                      "share of the light", energy, false, false},
                                     {LQ_PANEL_AREAS, "transmitted",
                                      "by how often light met the first surface", "share of the light",
                                      energy, true, false}};
    static const chart moments[] = {{LQ_PANEL_LINES, "direction of reflected light",
                                     "E[sin theta cos phi], a mirror's is sin theta_i", "mean", direction,
                                     false, true},
                                    {LQ_PANEL_LINES, "spread of reflected light",
                                     "sqrt(E[sin^2 theta] - mean^2)", "spread", spread, false, false}};
    lq_status status = LQ_OK;
    for (int side = 0; side < (is_opaque(s) ? 1 : 2); side++)
        for (int c = 0; status == LQ_OK && c < s->channels; c++)
            status = add_chart(figure, s, c, &energies[side], error);
    for (size_t i = 0; status == LQ_OK && i < sizeof moments / sizeof *moments; i++)
        status = add_chart(figure, s, 0, &moments[i], error);
    return status;
}

/* ======================================================================================
 *                                         Light
 * ====================================================================================== */

static lq_status solve(solved *s, const view_request *request, const lq_progress *progress, lq_error *error) {
    lq_stack_query query = {.mu = s->mu.nodes,
                            .mu_count = COSINES,
                            .tolerance = request->tolerance,
                            .threads = (int)request->threads};
    lq_status status = lq_stack_count_paths(s->stack, &query, LAST_PATH, &s->paths, error);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
    if (s->paths > PATHS_MAX) s->paths = PATHS_MAX;
    query.paths = s->paths;
    s->light = calloc(COSINES * (size_t)s->channels * s->paths, sizeof *s->light);
    if (!s->light) return lq_fail(error, LQ_NO_MEMORY, "no memory for the light of a stack");
    return lq_stack_solve(s->stack, &query, s->light, progress, error);
}

static lq_status describe_stack(const solved *s, const char *name, lq_figure **figure, lq_error *error) {
    char *text = NULL;
    double worst = 0.0;
    char estimate[32];
    for (size_t i = 0; i < COSINES * (size_t)s->channels * s->paths; i++)
        worst = fmax(worst, s->light[i].error);
    snprintf(estimate, sizeof estimate, "%.1e", worst);
    lq_status status = lq_stack_text(s->stack, &text, error);
    if (status == LQ_OK)
        status = lq_figure_create(figure, s->stack->name[0] ? s->stack->name : name, text, error);
    if (status == LQ_OK) status = lq_figure_tell(*figure, "error-estimate", estimate, error);
    free(text);
    return status;
}

lq_status view_stack(const view_request *request, const lq_stack *stack, lq_figure **figure,
                     lq_error *error) {
    solved s = {.stack = stack, .channels = lq_stack_channels(stack)};
    cli_progress bar;
    lq_status status = lq_axis_make(&s.mu, "mu", 0.0, 1.0, COSINES, LQ_MAP_SQRT, 0.0, error);
    if (status != LQ_OK) return status;
    cli_progress_begin(&bar, "view");
    status = solve(&s, request, &bar.progress, error);
    cli_progress_end(&bar);
    const bool shown = status == LQ_OK || status == LQ_NOT_CONVERGED;
    lq_status made = shown ? describe_stack(&s, request->input, figure, error) : status;
    if (made == LQ_OK) made = add_charts(*figure, &s, error);
    free(s.light);
    lq_axis_free(&s.mu);
    return made == LQ_OK ? status : made;
}
