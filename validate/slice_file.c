/* slice_file.c - a slice as a table and as a picture. */
#include "validate/slice_file.h"

#include <math.h>
#include <stdlib.h>

#include "picture/draw.h"
#include "system/number.h"
#include "system/status.h"

static const char *const sides[LQ_GONIO_SIDES] = {"reflected", "transmitted"};
static const char *const orders[LQ_GONIO_ORDERS] = {"met the first interface once", "met it twice",
                                                    "met it more often"};

static lq_status make_angle(lq_axis *axis, const char *name, double from, size_t count, lq_error *error) {
    return lq_axis_make(axis, name, from + 0.5, from + (double)count - 0.5, count, LQ_MAP_LINEAR, 0.0, error);
}

/* ======================================================================================
 *                                         EXR
 * ====================================================================================== */

/* Tables have their first axis fastest, slices their last. */
static void turn(const float *cells, float *nodes) {
    for (size_t t = 0; t < LQ_SLICE_THETA; t++)
        for (size_t p = 0; p < LQ_SLICE_PHI; p++) nodes[p * LQ_SLICE_THETA + t] = cells[t * LQ_SLICE_PHI + p];
}

static lq_status create(lq_table **table, int channels, lq_error *error) {
    static const char *const one[] = {"value", "noise"};
    static const char *const three[] = {"value.r", "value.g", "value.b", "noise.r", "noise.g", "noise.b"};
    lq_axis axes[3] = {0};
    lq_status status = make_angle(&axes[0], "theta", 0.0, LQ_SLICE_THETA, error);
    if (status == LQ_OK) status = make_angle(&axes[1], "phi", 0.0, LQ_SLICE_PHI, error);
    if (status == LQ_OK)
        status =
            lq_axis_make(&axes[2], "order", 1.0, LQ_GONIO_ORDERS, LQ_GONIO_ORDERS, LQ_MAP_LINEAR, 0.0, error);
    if (status == LQ_OK)
        status = lq_table_create(table, axes, 3, channels > 1 ? three : one, 2 * channels, error);
    for (int i = 0; i < 3; i++) lq_axis_free(&axes[i]);
    return status;
}

static lq_status tell(lq_table *table, const lq_gonio *g, const lq_slice_label *label, lq_error *error) {
    char mu[32], samples[32], seed[32];
    lq_print(mu, sizeof mu, "%.17g", g->mu);
    lq_print(samples, sizeof samples, "%zu", g->samples);
    lq_print(seed, sizeof seed, "%llu", (unsigned long long)label->seed);
    const lq_fact facts[] = {{(char *)"slice", (char *)lq_slice_layout_names[label->layout]},
                             {(char *)"side", (char *)sides[label->side]},
                             {(char *)"stack", (char *)label->stack},
                             {(char *)"interfaces", (char *)label->interfaces},
                             {(char *)"from", (char *)label->from},
                             {(char *)"mu", mu},
                             {(char *)"samples", samples},
                             {(char *)"seed", seed},
                             {(char *)"version", (char *)LQ_VERSION}};
    lq_status status = LQ_OK;
    for (size_t i = 0; i < sizeof facts / sizeof *facts && status == LQ_OK; i++)
        status = lq_table_set_fact(table, facts[i].key, facts[i].value, error);
    return status;
}

static void fill(lq_table *table, const lq_gonio *g, const lq_slice_label *label, const double *solid,
                 float *cells) {
    for (int order = 0; order < LQ_GONIO_ORDERS; order++)
        for (int c = 0; c < g->channels; c++) {
            const lq_gonio_part part = {label->side, order, order, c};
            const size_t at = (size_t)order * LQ_SLICE_CELLS;
            lq_gonio_slice(g, label->layout, &part, solid, cells, NULL);
            turn(cells, table->channels[c] + at);
            lq_gonio_slice(g, label->layout, &part, solid, NULL, cells);
            turn(cells, table->channels[g->channels + c] + at);
        }
}

lq_status lq_slice_write_exr(const lq_gonio *g, const lq_slice_label *label, const char *path,
                             lq_error *error) {
    lq_table *table = NULL;
    double *solid = malloc(LQ_SLICE_CELLS * sizeof *solid);
    float *cells = malloc(LQ_SLICE_CELLS * sizeof *cells);
    lq_status status =
        solid && cells ? create(&table, g->channels, error) : lq_fail(error, LQ_NO_MEMORY, "out of memory");
    if (status == LQ_OK) {
        lq_slice_solids(label->layout, g->mu, solid);
        fill(table, g, label, solid, cells);
        status = tell(table, g, label, error);
    }
    if (status == LQ_OK) status = lq_table_write_exr(table, path, error);
    lq_table_free(table);
    free(cells);
    free(solid);
    return status;
}

/* ======================================================================================
 *                                         PNG
 * ====================================================================================== */

typedef struct picture {
    const lq_gonio *gonio;
    const lq_slice_label *label;
    double solid[LQ_SLICE_CELLS];
    float cells[LQ_SLICE_CELLS], mean[LQ_SLICE_CELLS];
    lq_figure *figure;
    lq_axis theta, phi;
    double range[2]; /* of the logarithms, the same for all */
} picture;

/* Means over the colours, of the value or of the noise (whose colours share rays: not less than that). */
static void average(picture *p, int from, int to, bool noise) {
    const lq_gonio *g = p->gonio;
    for (size_t i = 0; i < LQ_SLICE_CELLS; i++) p->mean[i] = 0.0F;
    for (int c = 0; c < g->channels; c++) {
        const lq_gonio_part part = {p->label->side, from, to, c};
        lq_gonio_slice(g, p->label->layout, &part, p->solid, noise ? NULL : p->cells,
                       noise ? p->cells : NULL);
        for (size_t i = 0; i < LQ_SLICE_CELLS; i++) p->mean[i] += p->cells[i] / (float)g->channels;
    }
}

/* Four decades below the brightest cell. */
static void set_range(picture *p) {
    enum { DECADES = 4 };
    float most = 0.0F;
    average(p, 0, LQ_GONIO_ORDERS - 1, false);
    for (size_t i = 0; i < LQ_SLICE_CELLS; i++) most = fmaxf(most, p->mean[i]);
    p->range[1] = most > 0.0F ? log10((double)most) : 0.0;
    p->range[0] = p->range[1] - DECADES;
}

/* The mirror's direction to the middle; where no light was counted, what the scale ends with. */
static void rolled_logarithm(picture *p) {
    for (size_t i = 0; i < LQ_SLICE_CELLS; i++) {
        const size_t phi = (i % LQ_SLICE_PHI + LQ_SLICE_PHI / 2) % LQ_SLICE_PHI;
        const float value = p->mean[i / LQ_SLICE_PHI * LQ_SLICE_PHI + phi];
        p->cells[i] = value > 0.0F ? log10f(value) : (float)p->range[0];
    }
}

static lq_status add(picture *p, const char *title, int from, int to, bool noise, lq_error *error) {
    average(p, from, to, noise);
    rolled_logarithm(p);
    const bool half = p->label->layout == LQ_SLICE_HALF;
    const lq_panel_parts parts = {.form = LQ_PANEL_MAP,
                                  .title = title,
                                  .caption = half ? "degrees, of the half vector; f cos theta_o of the light"
                                                  : "degrees; f cos theta_o",
                                  .quantity = "log10",
                                  .x = &p->phi,
                                  .y = &p->theta,
                                  .values = p->cells,
                                  .range = p->range};
    return lq_figure_add(p->figure, &parts, error);
}

static lq_status compose(picture *p, lq_error *error) {
    char title[256], subtitle[256];
    lq_print(title, sizeof title, "%s, %s light", p->label->name, sides[p->label->side]);
    lq_print(subtitle, sizeof subtitle, "light at mu = %g from %s, interfaces %s, %zu walks, seed %llu",
             p->gonio->mu, p->label->from, p->label->interfaces, p->gonio->samples,
             (unsigned long long)p->label->seed);
    lq_status status = lq_figure_create(&p->figure, title, subtitle, error);
    if (status == LQ_OK) status = make_angle(&p->theta, "theta", 0.0, LQ_SLICE_THETA, error);
    if (status == LQ_OK) status = make_angle(&p->phi, "phi", -0.5 * LQ_SLICE_PHI, LQ_SLICE_PHI, error);
    if (status != LQ_OK) return status;
    lq_slice_solids(p->label->layout, p->gonio->mu, p->solid);
    set_range(p);
    status = add(p, "all light", 0, LQ_GONIO_ORDERS - 1, false, error);
    if (status == LQ_OK) status = add(p, "its noise", 0, LQ_GONIO_ORDERS - 1, true, error);
    for (int i = 0; i < LQ_GONIO_ORDERS && status == LQ_OK; i++)
        status = add(p, orders[i], i, i, false, error);
    return status;
}

lq_status lq_slice_write_png(const lq_gonio *g, const lq_slice_label *label, const char *path,
                             lq_error *error) {
    picture *p = calloc(1, sizeof *p);
    if (!p) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    p->gonio = g;
    p->label = label;
    lq_status status = compose(p, error);
    if (status == LQ_OK) status = lq_draw_write(p->figure, LQ_IMAGE_PNG, path, error);
    lq_axis_free(&p->theta);
    lq_axis_free(&p->phi);
    lq_figure_free(p->figure);
    free(p);
    return status;
}
