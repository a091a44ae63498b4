/* mitsuba_file.c - the three tables of a Mitsuba transmittance file, computed and written in one go. */
#include <math.h>
#include <stdlib.h>

#include "microfacet/gauss.h"
#include "system/number.h"
#include "system/status.h"

enum { MU, ALPHA, ETA, TAU, AXES };
enum { OUTSIDE, INSIDE, AT_MEANS, PARTS };

lq_status lq_mitsuba_axes(lq_axis *axes, lq_error *error) {
    static const char *const nodes[AXES] = {"0:1:64:power4", "0:1:32:power4", "1:4:32:power4", "1"};
    static const char *const names[AXES] = {"mu", "alpha", "eta", "tau"};
    lq_status status = LQ_OK;
    for (int a = 0; status == LQ_OK && a < AXES; a++) {
        lq_axis_free(&axes[a]);
        status = lq_axis_parse(&axes[a], names[a], nodes[a], error);
    }
    return status;
}

/* Cosines mu = w^4 at Gauss nodes w, which crowd at grazing, where energies turn over cosines of alpha. */
enum { MEAN_NODES = 32 };

static lq_status make_mean_axis(lq_axis *axis, const lq_gauss *rule, lq_error *error) {
    double mu[MEAN_NODES];
    for (int i = 0; i < MEAN_NODES; i++) mu[i] = pow(rule->node[i], 4.0);
    return lq_axis_make_custom(axis, "mu", mu, MEAN_NODES, error);
}

static lq_status make_inside_axis(lq_axis *axis, const lq_axis *eta, lq_error *error) {
    double *nodes = malloc(eta->size * sizeof *nodes);
    if (!nodes) return lq_fail(error, LQ_NO_MEMORY, "no memory for an axis of %zu nodes", eta->size);
    for (size_t i = 0; i < eta->size; i++) nodes[i] = 1.0 / eta->nodes[eta->size - 1 - i];
    const lq_status status = lq_axis_make_custom(axis, "eta", nodes, eta->size, error);
    free(nodes);
    return status;
}

/* T10 = mean of T01 / eta^2, by reciprocity: seen from outside nothing has a critical angle. */
static lq_status take_means(const lq_table *at, const lq_gauss *rule, lq_table **means, lq_error *error) {
    const char *channel = "transmission";
    const lq_axis axes[] = {at->axes[ETA], at->axes[ALPHA], at->axes[TAU]};
    const lq_status status = lq_table_create(means, axes, 3, &channel, 1, error);
    const size_t etas = axes[0].size, alphas = axes[1].size;
    for (size_t e = 0; status == LQ_OK && e < etas; e++)
        for (size_t a = 0; a < alphas; a++) {
            const float *row = at->channels[0] + MEAN_NODES * (a + alphas * e);
            double sum = 0.0;
            for (int i = 0; i < MEAN_NODES; i++) /* 2 mu dmu = 8 w^7 dw */
                sum += rule->weight[i] * 8.0 * pow(rule->node[i], 7.0) * (double)row[i];
            (*means)->channels[0][e + etas * a] = (float)(sum / (axes[0].nodes[e] * axes[0].nodes[e]));
        }
    return status;
}

/* Progress of one part among all. */
typedef struct share {
    const lq_progress *whole;
    int part;
} share;

static bool report_share(void *user, double fraction) {
    const share *s = user;
    return s->whole->report(s->whole->user, (s->part + fraction) / PARTS);
}

static lq_status compute_part(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes, int part,
                              const lq_progress *progress, lq_table **table, double *estimate,
                              lq_error *error) {
    share mine = {progress, part};
    const lq_progress shared = {report_share, &mine};
    const lq_status status =
        lq_precompute(kind, settings, axes, progress && progress->report ? &shared : NULL, table, error);
    const char *fact = *table ? lq_table_fact(*table, "error") : NULL;
    *estimate = fmax(*estimate, fact ? lq_strtod(fact, NULL) : 0.0);
    return status;
}

static bool holds(lq_status status) {
    return status == LQ_OK || status == LQ_NOT_CONVERGED;
}

/* `over` says where each part is computed; LQ_NOT_CONVERGED: all are there, some above the tolerance. */
static lq_status compute_parts(const lq_settings *settings, const lq_axis over[PARTS][AXES],
                               const lq_progress *progress, lq_table **parts, double *estimate,
                               lq_error *error) {
    const lq_kind *kind = lq_kind_find("transmission", error);
    lq_status worst = kind ? LQ_OK : LQ_BAD_INPUT;
    *estimate = 0.0;
    for (int p = 0; holds(worst) && p < PARTS; p++) {
        const lq_status status =
            compute_part(kind, settings, over[p], p, progress, &parts[p], estimate, error);
        if (status != LQ_OK) worst = status;
    }
    return worst;
}

static lq_status write_parts(lq_table *const *parts, const lq_gauss *rule, const char *path, size_t *entries,
                             lq_error *error) {
    lq_table *means = NULL;
    lq_status status = take_means(parts[AT_MEANS], rule, &means, error);
    if (status == LQ_OK) status = lq_mitsuba_write(parts[OUTSIDE], parts[INSIDE], means, path, error);
    if (status == LQ_OK)
        *entries =
            lq_table_entries(parts[OUTSIDE]) + lq_table_entries(parts[INSIDE]) + 2 * lq_table_entries(means);
    lq_table_free(means);
    return status;
}

lq_status lq_mitsuba_precompute(const lq_settings *settings, const lq_axis *axes, const lq_progress *progress,
                                const char *path, size_t *entries, double *estimate, lq_error *error) {
    lq_table *parts[PARTS] = {NULL};
    lq_axis inside = {.size = 0}, cosines = {.size = 0};
    lq_gauss rule;
    lq_gauss_make(&rule, MEAN_NODES);
    lq_status status = make_inside_axis(&inside, &axes[ETA], error), written = LQ_OK;
    if (status == LQ_OK) status = make_mean_axis(&cosines, &rule, error);
    const lq_axis over[PARTS][AXES] = {
        [OUTSIDE] = {axes[MU], axes[ALPHA], axes[ETA], axes[TAU]},
        [INSIDE] = {axes[MU], axes[ALPHA], inside, axes[TAU]},
        [AT_MEANS] = {cosines, axes[ALPHA], axes[ETA], axes[TAU]},
    };
    if (status == LQ_OK) status = compute_parts(settings, over, progress, parts, estimate, error);
    if (holds(status)) written = write_parts(parts, &rule, path, entries, error);
    for (int p = 0; p < PARTS; p++) lq_table_free(parts[p]);
    lq_axis_free(&inside);
    lq_axis_free(&cosines);
    return written == LQ_OK ? status : written;
}
