/* layered_measure.c - one stack: every angle of incidence, every side, every model. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stack/spread.h"
#include "system/number.h"
#include "system/status.h"
#include "validate/layered.h"
#include "validate/layered_picture.h"

static const char *const sides[LQ_GONIO_SIDES] = {"reflected", "transmitted"};
static const char *const parts[LQ_PARTS] = {"direct", "rest"};
static const double degree = 3.14159265358979323846 / 180.0;

/* All that one angle of a stack needs; large. */
typedef struct work {
    const lq_layered_request *request;
    const lq_layered_stack *stack;
    double theta, mu;
    int channels;
    lq_gonio gonio;
    lq_stack_light exact[LQ_STACK_CHANNELS * LQ_PARTS];
    double solid[LQ_SLICE_CELLS];
    lq_slice_pair measured, model;
    lq_model_shape shapes[LQ_LAYERED_MODELS]; /* one a model, turned from angle to angle */
    double aimed[LQ_LAYERED_MODELS];          /* at this cosine; 0: not made */
    lq_model_mapping mapping[2];              /* by lq_model_f */
    lq_error *error;
} work;

/* ======================================================================================
 *                                       As JSON
 * ====================================================================================== */

static json_t *lobe_json(const lq_stack_lobe *lobe) {
    return json_pack("{s:o, s:o, s:o, s:o}", "energy", lq_json_number(lobe->energy), "sin2",
                     lq_json_number(lobe->sin2), "mean", lq_json_number(lobe->mean), "across",
                     lq_json_number(lobe->across));
}

static json_t *lobes_json(const work *w, const lq_part_lobes *lobes) {
    json_t *root = json_object();
    for (int part = 0; part < LQ_PARTS; part++) {
        json_t *list = json_array();
        for (int c = 0; c < w->channels; c++) lq_json_append(&list, lobe_json(&(*lobes)[part][c]));
        lq_json_set(&root, parts[part], list);
    }
    return root;
}

/* Whether all light of a side was inside, as model_shape.h counts it. */
static bool inside(const work *w, int side) {
    return side == 1 && w->stack->stack->layer_count > 1;
}

static lq_stack_lobe of_side(const lq_stack_light *light, int side) {
    return side ? light->transmitted : light->reflected;
}

static lq_stack_lobe sum_of(lq_stack_lobe a, lq_stack_lobe b) {
    const double energy = a.energy + b.energy;
    if (!(energy > 0.0)) return (lq_stack_lobe){0.0, 0.0, 0.0, 0.0};
    return (lq_stack_lobe){energy, (a.energy * a.sin2 + b.energy * b.sin2) / energy,
                           (a.energy * a.mean + b.energy * b.mean) / energy,
                           (a.energy * a.across + b.energy * b.across) / energy};
}

static void exact_lobes(const work *w, int side, lq_part_lobes *lobes) {
    for (int c = 0; c < w->channels; c++) {
        const lq_stack_light *light = &w->exact[c * LQ_PARTS];
        (*lobes)[LQ_PART_DIRECT][c] = of_side(&light[LQ_PART_DIRECT], side);
        (*lobes)[LQ_PART_REST][c] = of_side(&light[LQ_PART_REST], side);
        if (!inside(w, side)) continue;
        (*lobes)[LQ_PART_REST][c] = sum_of((*lobes)[LQ_PART_DIRECT][c], (*lobes)[LQ_PART_REST][c]);
        (*lobes)[LQ_PART_DIRECT][c] = (lq_stack_lobe){0.0, 0.0, 0.0, 0.0};
    }
}

/* How many standard errors the energies of the slices are from what is exact, beyond its own estimate. */
static json_t *walked_json(const work *w, int side, const lq_part_lobes *exact) {
    json_t *list = json_array();
    for (int part = 0; part < LQ_PARTS; part++)
        for (int c = 0; c < w->channels; c++) {
            const lq_gonio_part orders = lq_slice_part(side, inside(w, side), part, c);
            double noise;
            const double energy = lq_gonio_energy(&w->gonio, LQ_SLICE_CLASSIC, &orders, &noise);
            const double allowed = w->exact[c * LQ_PARTS].error + w->exact[c * LQ_PARTS + 1].error;
            const double beyond = fmax(fabs(energy - (*exact)[part][c].energy) - allowed, 0.0);
            lq_json_append(&list, lq_json_number(beyond / hypot(noise, 3.0 / (double)w->gonio.samples)));
        }
    return list;
}

static json_t *error_json(const work *w) {
    const lq_slice_error all = lq_slice_compare(&w->model, &w->measured, w->channels, true);
    const lq_slice_error rest = lq_slice_compare(&w->model, &w->measured, w->channels, false);
    return json_pack("{s:o, s:o, s:o, s:o}", "all", lq_json_number(all.rmse), "rest",
                     lq_json_number(rest.rmse), "all_noise", lq_json_number(all.noise), "rest_noise",
                     lq_json_number(rest.noise));
}

/* ======================================================================================
 *                                      One model
 * ====================================================================================== */

void lq_layered_picture(char *path, size_t size, const char *set, const char *stack, double theta, int side,
                        const char *label) {
    lq_print(path, size, "slices/%s-%s-%g-%s-%s.png", set, stack, theta, sides[side],
             label ? label : "measured");
}

static lq_status draw(const work *w, const lq_slice_pair *pair, int side, const char *label) {
    char name[512], path[5000];
    const lq_slice_pair *measured = &w->measured;
    lq_layered_picture(name, sizeof name, w->request->set->name, w->stack->stack->name, w->theta, side,
                       label);
    snprintf(path, sizeof path, "%.4000s/%s", w->request->folder, name);
    return lq_slice_picture(pair, label ? measured : NULL, w->channels, lq_slice_peak(measured, w->channels),
                            path, w->error);
}

static lq_status put_in_cells(work *w, const lq_model_shape *shape, int side, const char *label,
                              json_t **into) {
    lq_part_lobes lobes;
    lq_status status = lq_slice_of_model(shape, w->mu, side, LQ_SLICE_CLASSIC, w->solid, w->request->threads,
                                         &w->model, &lobes, w->error);
    if (status == LQ_OK) status = draw(w, &w->model, side, label);
    if (status != LQ_OK) return status;
    lq_json_set(into, "rmse", error_json(w));
    lq_json_set(into, "lobes", lobes_json(w, &lobes));
    return LQ_OK;
}

static lq_status aim(work *w, size_t i, lq_error *error) {
    lq_shape_query query = w->request->models[i].query;
    query.threads = w->request->threads;
    query.mapping = &w->mapping[query.f];
    if (w->request->models[i].tables) query.source = w->request->source;
    if (w->aimed[i] == w->mu) return LQ_OK;
    if (w->aimed[i] > 0.0) return lq_model_shape_aim(&w->shapes[i], w->mu, error);
    return lq_model_shape_make(&w->shapes[i], w->stack->stack, &query, w->mu, error);
}

/* A model need not take every stack: what it says then stands in its place. LQ_BAD_INPUT: it did. */
static lq_status open_shape(work *w, size_t i, json_t **into) {
    lq_error why = {""};
    const lq_status status = aim(w, i, &why);
    w->aimed[i] = status == LQ_OK ? w->mu : 0.0;
    if (status == LQ_OK) return LQ_OK;
    lq_model_shape_free(&w->shapes[i]);
    w->shapes[i] = (lq_model_shape){.lobes = NULL};
    if (status != LQ_BAD_INPUT)
        return lq_fail(w->error, status, "%s: %.400s", w->request->models[i].label, why.text);
    lq_json_set(into, "refused", lq_json_text(why.text));
    return status;
}

static lq_status measure_model(work *w, size_t i, int side, json_t **list) {
    const char *label = w->request->models[i].label;
    json_t *figures = json_pack("{s:s}", "model", label);
    lq_status status = open_shape(w, i, &figures);
    if (status == LQ_OK) status = put_in_cells(w, &w->shapes[i], side, label, &figures);
    else if (status == LQ_BAD_INPUT) status = LQ_OK;
    lq_json_append(list, figures);
    return status;
}

/* ======================================================================================
 *                                      One angle
 * ====================================================================================== */

static lq_status solve(work *w, size_t paths) {
    const lq_stack_query query = {
        .mu = &w->mu, .mu_count = 1, .paths = paths, .threads = w->request->threads};
    const lq_status status = lq_stack_solve(w->stack->stack, &query, w->exact, NULL, w->error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status; /* its estimate says so */
}

static lq_status measure_side(work *w, int side, json_t **list) {
    const lq_layered_request *r = w->request;
    json_t *models = json_array();
    lq_part_lobes exact;
    exact_lobes(w, side, &exact);
    lq_slice_fold(&w->gonio, side, inside(w, side), LQ_SLICE_CLASSIC, w->solid, &w->measured);
    lq_status status = draw(w, &w->measured, side, NULL);
    for (size_t i = 0; i < r->model_count && status == LQ_OK; i++)
        status = measure_model(w, i, side, &models);
    lq_json_append(list,
                   json_pack("{s:s, s:o, s:o, s:o}", "side", sides[side], "exact", lobes_json(w, &exact),
                             "walk_z", walked_json(w, side, &exact), "models", models));
    return status;
}

static lq_status measure_angle(work *w, json_t **list) {
    const lq_layered_request *r = w->request;
    const lq_stack_query query = {.mu = &w->mu, .mu_count = 1, .threads = r->threads};
    json_t *list_of_sides = json_array();
    lq_status status = solve(w, LQ_PARTS);
    if (status == LQ_OK)
        status = lq_gonio_measure(&w->gonio, w->stack->stack, &query, 1, r->samples, r->seed, NULL, w->error);
    lq_slice_solids(LQ_SLICE_CLASSIC, w->mu, w->solid);
    for (int side = 0; status == LQ_OK && side < w->gonio.sides; side++)
        status = measure_side(w, side, &list_of_sides);
    lq_gonio_free(&w->gonio);
    lq_json_append(list, json_pack("{s:f, s:o}", "theta", w->theta, "sides", list_of_sides));
    return status;
}

/* ======================================================================================
 *                                  A point of a curve
 * ====================================================================================== */

/* Of light that was inside, of the first colour: its energy, and the roughness of a lobe that spreads so. */
static json_t *point_json(const lq_spread *spread, const lq_stack_lobe *lobe) {
    return json_pack("{s:o, s:o}", "energy", lq_json_number(lobe->energy), "alpha",
                     lq_json_number(lq_spread_alpha(spread, 0, lobe->across)));
}

static lq_status model_point(work *w, size_t i, const lq_spread *spread, json_t **list) {
    lq_part_lobes lobes;
    json_t *figures = json_pack("{s:s}", "model", w->request->models[i].label);
    lq_status status = open_shape(w, i, &figures);
    if (status == LQ_OK) {
        status = lq_slice_of_model(&w->shapes[i], w->mu, 0, LQ_SLICE_CLASSIC, w->solid, w->request->threads,
                                   &w->model, &lobes, w->error);
        if (status == LQ_OK) lq_json_set(&figures, "point", point_json(spread, &lobes[LQ_PART_REST][0]));
    } else if (status == LQ_BAD_INPUT) status = LQ_OK;
    lq_json_append(list, figures);
    return status;
}

static lq_status measure_point(work *w, json_t **list) {
    const lq_layered_request *r = w->request;
    lq_spread spread;
    json_t *models = json_array(), *exact = NULL;
    lq_status status = lq_spread_make(&spread, &w->mu, 1, w->error);
    if (status == LQ_OK) status = solve(w, LQ_PARTS);
    lq_slice_solids(LQ_SLICE_CLASSIC, w->mu, w->solid);
    if (status == LQ_OK) exact = point_json(&spread, &w->exact[LQ_PART_REST].reflected);
    for (size_t i = 0; i < r->model_count && status == LQ_OK; i++)
        status = model_point(w, i, &spread, &models);
    lq_spread_free(&spread);
    lq_json_append(list, json_pack("{s:f, s:o, s:o}", "theta", w->theta, "exact", exact ? exact : json_null(),
                                   "models", models));
    return status;
}

/* ======================================================================================
 *                                      One stack
 * ====================================================================================== */

json_t *lq_layered_settings(const lq_layered_request *r, const lq_layered_stack *stack) {
    char *text = NULL;
    if (lq_stack_text(stack->stack, &text, NULL) != LQ_OK) return NULL;
    json_t *thetas = json_array(), *models = json_array();
    for (size_t i = 0; i < r->set->theta_count; i++)
        lq_json_append(&thetas, lq_json_number(r->set->theta[i]));
    for (size_t i = 0; i < r->model_count; i++) lq_json_append(&models, lq_json_text(r->models[i].label));
    json_t *settings =
        json_pack("{s:s, s:s, s:s, s:s, s:f, s:o, s:o, s:I, s:I, s:o, s:s}", "version", LQ_VERSION, "set",
                  r->set->name, "category", stack->category, "base", stack->base, "first", stack->first,
                  "stack", lq_json_text(text), "theta", thetas, "samples", (json_int_t)r->samples, "seed",
                  (json_int_t)r->seed, "models", models, "tables", r->source_sum ? r->source_sum : "");
    free(text);
    return settings;
}

bool lq_layered_fits(json_t *figures, const json_t *settings) {
    return settings && json_equal(json_object_get(figures, "settings"), settings);
}

lq_status lq_layered_measure(const lq_layered_request *r, const lq_layered_stack *stack, json_t **figures,
                             const lq_progress *progress, lq_error *error) {
    const bool curve = strcmp(stack->category, "curves") == 0;
    json_t *angles = json_array();
    work *w = calloc(1, sizeof *w);
    lq_status status = w ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for slices");
    if (status == LQ_OK)
        status = lq_model_mapping_make(&w->mapping[LQ_MODEL_F_EXACT], LQ_MODEL_F_EXACT, error);
    if (status == LQ_OK) status = lq_model_mapping_make(&w->mapping[LQ_MODEL_F_B18], LQ_MODEL_F_B18, error);
    for (size_t i = 0; i < r->set->theta_count && status == LQ_OK; i++) {
        w->request = r;
        w->stack = stack;
        w->theta = r->set->theta[i];
        w->mu = cos(w->theta * degree);
        w->channels = lq_stack_channels(stack->stack);
        w->error = error;
        status = curve ? measure_point(w, &angles) : measure_angle(w, &angles);
        if (status == LQ_OK && progress &&
            !progress->report(progress->user, (double)(i + 1) / (double)r->set->theta_count))
            status = lq_fail(error, LQ_CANCELLED, "stopped");
    }
    for (size_t i = 0; w && i < r->model_count; i++) lq_model_shape_free(&w->shapes[i]);
    free(w);
    *figures = json_pack("{s:s, s:o, s:o}", "name", stack->stack->name, "settings",
                         lq_layered_settings(r, stack), "angles", angles);
    if (status == LQ_OK && !*figures) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    return status;
}

/* ======================================================================================
 *                                       Models
 * ====================================================================================== */

/* How the first lobe is made is said of any model; the rest of B18's alone. */
static bool take_change(lq_layered_model *model, bool varied, const char *word) {
    lq_shape_query *query = &model->query;
    if (strcmp(word, "exact-first") == 0) query->first = LQ_FIRST_EXACT;
    else if (strcmp(word, "scaled-first") == 0) query->first = LQ_FIRST_SCALED;
    else if (varied && strcmp(word, "released") == 0) query->variant = LQ_MODEL_RELEASED;
    else if (varied && strcmp(word, "fit") == 0) query->f = LQ_MODEL_F_B18;
    else if (varied && strcmp(word, "masked") == 0) query->masked = true;
    else if (varied && strcmp(word, "tables") == 0) model->tables = true;
    else return false;
    return true;
}

lq_status lq_layered_model_parse(lq_layered_model *model, const char *label, lq_error *error) {
    char text[64], *rest;
    *model = (lq_layered_model){.query = {.variant = LQ_MODEL_PAPER, .f = LQ_MODEL_F_EXACT}};
    if (strlen(label) >= sizeof text) return lq_fail(error, LQ_BAD_INPUT, "no model '%.40s...'", label);
    memcpy(model->label, label, strlen(label) + 1);
    memcpy(text, label, strlen(label) + 1);
    const char *word = strtok_r(text, "+", &rest);
    lq_status status = lq_model_find(word ? word : "", &model->query.model, error);
    const bool varied = status == LQ_OK && lq_model_kinds[model->query.model].varied;
    while (status == LQ_OK && (word = strtok_r(NULL, "+", &rest)))
        if (!take_change(model, varied, word))
            status =
                lq_fail(error, LQ_BAD_INPUT, "model '%s': '+%s'; accepted: +exact-first, +scaled-first%s",
                        label, word, varied ? ", +released, +fit, +masked, +tables" : "");
    return status;
}
