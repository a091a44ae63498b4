/* make_table.c - the tables of a pack: computed or found in the cache, factored, measured. */
#include "pack/cache.h"
#include "pack/fit_texels.h"
#include "pack/make.h"
#include "pack/mapping.h"
#include "pca/factors.h"
#include "pca/measure.h"
#include "system/draft.h"
#include "system/status.h"
#include "tables/facts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------- tables and their checks */

/* All that determines a table: the program, the kind, the settings and every node. NULL: out of memory. */
static char *write_key(const lq_making *r, const lq_recipe_table *t, const char *what) {
    lq_draft draft = {.text = NULL};
    FILE *out = lq_draft_open(&draft);
    if (!out) return NULL;
    fprintf(out, "%s %s %s ndf=%s tolerance=%.17g scattering=%d masking=%d", r->build, what, t->kind->id,
            t->settings.ndf, t->settings.tolerance, (int)t->settings.scattering, (int)t->settings.masking);
    for (int a = 0; a < t->kind->axis_count; a++) {
        fprintf(out, " %s=", t->axes[a].name);
        for (size_t i = 0; i < t->axes[a].size; i++) fprintf(out, "%.17g,", t->axes[a].nodes[i]);
    }
    return lq_draft_close(&draft, out) ? draft.text : NULL;
}

/* One thing to obtain: a table (points 0), or exact values to measure or to search against. */
typedef struct want {
    const char *what; /* "check", in the label of the progress bar; NULL: the table */
    size_t points, seed;
} want;

/* Whether it is measured where solves are shared: of factors, whose points should be many, and of
 * dielectrics, whose solves are slow. */
static bool on_grid(const lq_recipe_table *t) {
    return t->factored || (t->kind->interface && strcmp(t->kind->interface, "dielectric") == 0);
}

static lq_status compute(const lq_making *r, const lq_recipe_table *t, const want *w,
                         const lq_settings *settings, lq_table **table, lq_error *error) {
    lq_step step;
    char label[64];
    snprintf(label, sizeof label, w->what ? "%s, %s" : "%s", t->name, w->what);
    lq_step_begin(&step, &r->watch, label);
    const bool mapping = lq_is_mapping(t->kind);
    lq_status status =
        mapping && !w->points ? lq_mapping_table(t->kind, settings, t->axes, table, error)
        : mapping             ? lq_mapping_exact(t->kind, settings, t->axes, w->points, table, error)
        : !w->points          ? lq_precompute(t->kind, settings, t->axes, &step.progress, table, error)
        : on_grid(t) ? lq_measure_exact_grid(t->kind, settings, t->axes, w->points, w->seed, &step.progress,
                                             table, error)
                     : lq_measure_exact(t->kind, settings, t->axes, w->points, &step.progress, table, error);
    lq_step_end(&step);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status; /* the measured error says what it comes to */
}

/* Storing makes a folder of its own: who ends the process waits until that is gone. */
static lq_status store(const lq_making *r, const char *key, lq_table *table, lq_factored *factored,
                       lq_error *error) {
    lq_watch_hold(&r->watch, true);
    lq_status status = table ? lq_cache_store(r->cache, key, table, error)
                             : lq_cache_store_factored(r->cache, key, factored, error);
    lq_watch_hold(&r->watch, false);
    if (status == LQ_OK) status = lq_watch_go_on(&r->watch);
    return status;
}

/* A cache that cannot be written costs time, not the pack: said once. */
static lq_status go_without(lq_making *r, lq_status status, const lq_error *error) {
    if (status != LQ_IO) return status;
    char line[LQ_MESSAGE_SIZE + 32];
    snprintf(line, sizeof line, "%s; going on without", error->text);
    lq_watch_note(&r->watch, line);
    *r->cache = '\0';
    return LQ_OK;
}

/* The axes that it has to have. */
static lq_status axes_of(const lq_recipe_table *t, const want *w, lq_axis *axes, int *count) {
    const bool mapping = lq_is_mapping(t->kind), grid = on_grid(t) && !mapping;
    *count = grid ? t->kind->axis_count : 1;
    return grid      ? lq_measure_grid_axes(t->axes, *count, w->points, w->seed, axes, NULL)
           : mapping ? lq_mapping_exact_axis(t->axes, w->points, axes, NULL)
                     : lq_measure_axis(w->points, axes, NULL);
}

/* In the cache; NULL: it is not there. */
static lq_table *find(const lq_making *r, const char *key, const lq_recipe_table *t, const want *w) {
    lq_axis axes[LQ_MAX_AXES] = {0};
    int count;
    if (!w->points) return lq_cache_find(r->cache, key, t->axes, t->kind->axis_count);
    if (axes_of(t, w, axes, &count) != LQ_OK) return NULL;
    lq_table *found = lq_cache_find(r->cache, key, axes, count);
    for (int a = 0; a < count; a++) lq_axis_free(&axes[a]);
    return found;
}

/* From the cache, or computed and put there. */
static lq_status obtain(lq_making *r, const lq_recipe_table *t, const want *w, lq_table **table,
                        lq_error *error) {
    char what[64];
    if (!w->points) snprintf(what, sizeof what, "table");
    else if (on_grid(t)) snprintf(what, sizeof what, "grid-%zu-%zu", w->points, w->seed);
    else snprintf(what, sizeof what, "points-%zu", w->points);
    char *key = write_key(r, t, what);
    if (!key) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    lq_settings settings = t->settings;
    settings.threads = r->threads;
    lq_status status = LQ_OK;
    *table = *r->cache ? find(r, key, t, w) : NULL;
    if (!*table) {
        status = compute(r, t, w, &settings, table, error);
        if (status == LQ_OK && *r->cache) status = go_without(r, store(r, key, *table, NULL, error), error);
    }
    free(key);
    return status;
}

/* ---------------------------------------------------------------------------------------- factors */

enum { CHECK_SEED = 2, SEARCH_SEED = 1 };

/* A search aims below its budget: the check, at other points, finds larger errors. */
static const double MARGIN = 0.75;

/* What a search measures against: other points than the check. `user` is a table of them over all axes. */
static lq_status search_values(void *user, const double *min, const double *max, lq_table **values,
                               lq_error *error) {
    return lq_nodes_within(user, min, max, values, error);
}

static lq_status factor(lq_making *r, lq_packed *packed, lq_error *error) {
    const lq_recipe_table *t = packed->from;
    const bool searches = t->pca_budget > 0.0 || t->pca_bytes > 0;
    const want search = {"search", t->points, SEARCH_SEED};
    lq_pca_goal goal = {sizeof goal, t->pca_norm, MARGIN * t->pca_budget, t->pca_bytes, search_values, NULL};
    lq_table *exact = NULL;
    lq_pca_try *tries = NULL;
    size_t count = 0;
    lq_step step;
    char label[64];
    lq_status status = searches ? obtain(r, t, &search, &exact, error) : LQ_OK;
    if (status != LQ_OK) return status;
    goal.user = exact;
    snprintf(label, sizeof label, "%s, pca", t->name);
    lq_step_begin(&step, &r->watch, label);
    status = searches ? lq_pca_search(packed->table, t->channel, &t->pca, &goal, &step.progress,
                                      &packed->factored, &tries, &count, error)
                      : lq_pca(packed->table, t->channel, &t->pca, &step.progress, &packed->factored, error);
    lq_step_end(&step);
    free(tries);
    lq_table_free(exact);
    if (status == LQ_NOT_CONVERGED) status = LQ_OK; /* the measured error says so */
    return status == LQ_OK ? lq_factored_set_fact(packed->factored, "pca", t->pca_text, error) : status;
}

/* The factors, and the table where they or a binary need it. */
static lq_status obtain_factors(lq_making *r, lq_packed *packed, lq_error *error) {
    const lq_recipe_table *t = packed->from;
    const want whole = {0};
    char what[LQ_PCA_TEXT + 64];
    bool binary = false;
    lq_status status = LQ_OK;
    snprintf(what, sizeof what, "factors-%zu %s", t->points, t->pca_text);
    char *key = write_key(r, t, what);
    if (!key) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    for (int l = 0; l < LQ_LAYOUTS; l++) binary = binary || t->layouts[l];
    packed->factored = *r->cache ? lq_cache_find_factored(r->cache, key, t->axes, t->kind->axis_count) : NULL;
    if (!packed->factored || binary) status = obtain(r, t, &whole, &packed->table, error);
    if (status == LQ_OK && !packed->factored) {
        status = factor(r, packed, error);
        if (status == LQ_OK && *r->cache)
            status = go_without(r, store(r, key, NULL, packed->factored, error), error);
    }
    free(key);
    return status;
}

/* ------------------------------------------------------------------------------------------ a table */

/* Texels that are fitted to what lies between the table's nodes, too; a fact says how far they are from them.
 */
static lq_status fit(lq_making *r, lq_packed *packed, lq_error *error) {
    const int axes = packed->from->kind->axis_count;
    lq_recipe_table finer = *packed->from;
    const want whole = {0};
    lq_table *samples = NULL;
    double moved = 0.0;
    memset(finer.axes, 0, sizeof finer.axes);
    lq_status status = lq_fit_axes(packed->from->axes, axes, finer.axes, error);
    if (status == LQ_OK) status = obtain(r, &finer, &whole, &samples, error);
    if (status == LQ_OK) status = lq_fit_texels(packed->table, samples, LQ_MEASURE_FROM, &moved, error);
    if (status == LQ_OK) status = lq_table_set_number(packed->table, "fit", moved, error);
    for (int a = 0; a < axes; a++) lq_axis_free(&finer.axes[a]);
    lq_table_free(samples);
    return status;
}

static lq_status make_texture(lq_making *r, lq_packed *packed, lq_error *error) {
    const lq_recipe_table *t = packed->from;
    const want whole = {0}, check = {"check", t->points, CHECK_SEED};
    lq_table *exact = NULL;
    lq_status status = obtain(r, t, &whole, &packed->table, error);
    if (status == LQ_OK && t->fit) status = fit(r, packed, error);
    if (status == LQ_OK) status = lq_texture_make(&packed->texture, packed->table, t->name, error);
    if (status == LQ_OK) status = obtain(r, t, &check, &exact, error);
    if (status == LQ_OK)
        status = lq_measure_texture(&packed->texture, t->axes, t->kind->axis_count, exact,
                                    lq_is_mapping(t->kind), &packed->measure, error);
    lq_table_free(exact);
    return status;
}

static lq_status make_factors(lq_making *r, lq_packed *packed, lq_error *error) {
    const lq_recipe_table *t = packed->from;
    const want check = {"check", t->points, CHECK_SEED};
    lq_table *exact = NULL;
    lq_status status = obtain_factors(r, packed, error);
    if (status == LQ_OK) status = lq_factored_layout(&packed->factors, packed->factored, t->name, error);
    if (status == LQ_OK) status = obtain(r, t, &check, &exact, error);
    if (status == LQ_OK)
        status = lq_measure_factored(packed->factored, t->channel, exact, lq_is_mapping(t->kind),
                                     &packed->measure, error);
    lq_table_free(exact);
    return status;
}

lq_status lq_make_table(lq_making *r, lq_packed *packed, lq_error *error) {
    return packed->from->factored ? make_factors(r, packed, error) : make_texture(r, packed, error);
}
