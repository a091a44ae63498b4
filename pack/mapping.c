/* mapping.c - f, its inverse and sigma_g, exact, from the curve of an NDF. */
#include "pack/mapping.h"

#include "fit/curve.h"
#include "fit/phase.h"
#include "microfacet/lobe.h"
#include "system/number.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const lq_kind mappings[] = {
    {.id = "f",
     .title = "roughness into the variance in which bounces add",
     .quantity = "f(phi(alpha)) = 2 f(alpha), f ~ E[sin^2 theta] at 0, phi: the roughness of two bounces",
     .source = "B18 sec. 4.1, App. A",
     .axis_count = 1,
     .axes = {{"alpha", "roughness, the slope scale of the NDF", 1e-4, 0.97, 0.02, 0.9, 256, LQ_MAP_LINEAR}},
     .channel_count = 1,
     .channels = {"f"},
     .value_max = INFINITY},
    {.id = "f-inverse",
     .title = "roughness of a sum of variances",
     .quantity = "alpha with f(alpha) = f",
     .source = "B18 sec. 4.1, App. A",
     .axis_count = 1,
     .axes = {{"f", "sum of f", 1e-6, 1e9, 1e-3, 1000.0, 256, LQ_MAP_LINEAR}},
     .channel_count = 1,
     .channels = {"alpha"},
     .value_max = 1.0},
    {.id = "sigma-g",
     .title = "Henyey-Greenstein's g into the variance in which bounces add",
     .quantity = "f(alpha) of the lobe with E[sin^2 theta] of the phase function's forward hemisphere",
     .source = "B18 eq. 21",
     .axis_count = 1,
     .axes = {{"g", "mean cosine of the phase function", 0.02, 0.999, 0.1, 0.99, 256, LQ_MAP_LINEAR}},
     .channel_count = 1,
     .channels = {"sigma"},
     .value_max = INFINITY}};

enum { MAPPINGS = sizeof mappings / sizeof *mappings };

const lq_kind *lq_mapping_find(const char *id, lq_error *error) {
    for (size_t i = 0; i < MAPPINGS; i++)
        if (strcmp(mappings[i].id, id) == 0) return &mappings[i];
    lq_fail(error, LQ_BAD_INPUT, "unknown mapping '%s'; accepted: f, f-inverse, sigma-g", id);
    return NULL;
}

bool lq_is_mapping(const lq_kind *kind) {
    for (size_t i = 0; i < MAPPINGS; i++)
        if (kind == &mappings[i]) return true;
    return false;
}

double lq_mapping_value(const lq_kind *kind, const lq_curve *curve, double x) {
    if (kind == &mappings[0]) return lq_curve_f(curve, x);
    if (kind == &mappings[1]) return lq_curve_inverse(curve, x);
    return lq_curve_f(curve, lq_lobe_roughness(curve->ndf, lq_phase_variance(x, NULL)));
}

static lq_status fill(const lq_kind *kind, const lq_curve *curve, lq_table *table, lq_error *error) {
    const lq_axis *axis = &table->axes[0];
    for (size_t i = 0; i < axis->size; i++) {
        const double value = lq_mapping_value(kind, curve, axis->nodes[i]);
        if (!isfinite(value))
            return lq_fail(error, LQ_BAD_INPUT,
                           "%s: %g at %s = %g; accepted are values below the pole of f, alpha = %.4g for %s",
                           kind->id, value, axis->name, axis->nodes[i], curve->pole, lq_ndf_text(curve->ndf));
        table->channels[0][i] = (float)value;
    }
    return LQ_OK;
}

static lq_status set_facts(const lq_kind *kind, const lq_curve *curve, lq_table *table, lq_error *error) {
    char accuracy[32];
    lq_print(accuracy, sizeof accuracy, "%.1e", curve->accuracy);
    const struct {
        const char *key, *value;
    } facts[] = {{"mapping", kind->id},       {"title", kind->title},           {"quantity", kind->quantity},
                 {"source", kind->source},    {"ndf", lq_ndf_text(curve->ndf)}, {"version", LQ_VERSION},
                 {"curve-accuracy", accuracy}};
    lq_status status = LQ_OK;
    for (size_t i = 0; i < sizeof facts / sizeof *facts && status == LQ_OK; i++)
        status = lq_table_set_fact(table, facts[i].key, facts[i].value, error);
    return status;
}

lq_status lq_mapping_table(const lq_kind *kind, const lq_settings *settings, const lq_axis *axis,
                           lq_table **table, lq_error *error) {
    const lq_ndf *ndf;
    lq_curve *curve = malloc(sizeof *curve);
    *table = NULL;
    if (!curve) return lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", kind->id);
    lq_status status = lq_ndf_open(&ndf, settings->ndf, error);
    if (status != LQ_OK) return free(curve), status;
    status = lq_curve_make(curve, ndf, error);
    if (status == LQ_OK) status = lq_table_create(table, axis, 1, kind->channels, 1, error);
    if (status == LQ_OK) status = fill(kind, curve, *table, error);
    if (status == LQ_OK) status = set_facts(kind, curve, *table, error);
    if (status != LQ_OK) lq_table_free(*table), *table = NULL;
    lq_ndf_close(ndf);
    free(curve);
    return status;
}

lq_status lq_mapping_exact_axis(const lq_axis *axis, size_t points, lq_axis *finer, lq_error *error) {
    return lq_axis_make(finer, axis->name, axis->min, axis->max, points, LQ_MAP_POWER, axis->exponent, error);
}

lq_status lq_mapping_exact(const lq_kind *kind, const lq_settings *settings, const lq_axis *axis,
                           size_t points, lq_table **table, lq_error *error) {
    lq_axis finer;
    *table = NULL;
    lq_status status = lq_mapping_exact_axis(axis, points, &finer, error);
    if (status == LQ_OK) status = lq_mapping_table(kind, settings, &finer, table, error);
    lq_axis_free(&finer);
    return status;
}
