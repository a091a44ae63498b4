/* Table kinds as random walks: one short function a kind. */
#include "validate/walk_kind.h"

#include "tables/status.h"
#include "validate/walk_lobe.h"

#include <math.h>
#include <string.h>

/* The coordinate of the axis called `name`, or `otherwise` where the kind has no such axis. */
static double coordinate(const lq_kind *kind, const double *point, const char *name, double otherwise) {
    for (int i = 0; i < kind->axis_count; i++)
        if (strcmp(kind->axes[i].name, name) == 0) return point[i];
    return otherwise;
}

static lq_status walk_fgd(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values, lq_error *error) {
    walk->fresnel = LQ_WALK_CONDUCTOR;
    if (settings->scattering == LQ_SINGLE) return lq_walk_single(walk, settings->masking, values, error);
    return lq_walk_reflect(walk, values, NULL, 0, error);
}

static lq_status walk_albedo(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                             lq_error *error) {
    return lq_walk_single(walk, settings->masking, values, error);
}

static lq_status walk_albedo_average(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                                     lq_error *error) {
    walk->cosine = true;
    return lq_walk_single(walk, settings->masking, values, error);
}

static lq_status walk_dfg(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values, lq_error *error) {
    walk->f90 = 0.0;
    const lq_status status = lq_walk_single(walk, settings->masking, &values[0], error);
    if (status != LQ_OK) return status;
    walk->f0 = 0.0;
    walk->f90 = 1.0;
    return lq_walk_single(walk, settings->masking, &values[1], error);
}

static lq_status walk_tir_pass(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                               lq_error *error) {
    (void)settings;
    return lq_walk_lobe(walk, LQ_WALK_PASSES, values, error);
}

static lq_status walk_tir_loss(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                               lq_error *error) {
    (void)settings;
    return lq_walk_lobe(walk, LQ_WALK_LOST, values, error);
}

static const struct {
    const char *id;
    lq_status (*run)(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values, lq_error *error);
} walks[] = {
    {"fgd", walk_fgd},
    {"albedo", walk_albedo},
    {"albedo-average", walk_albedo_average},
    {"dfg", walk_dfg},
    {"tir-pass", walk_tir_pass},
    {"tir-loss", walk_tir_loss},
};

enum { WALKS = sizeof walks / sizeof walks[0] };

static int find(const lq_kind *kind) {
    for (int i = 0; i < WALKS; i++)
        if (strcmp(walks[i].id, kind->id) == 0) return i;
    return -1;
}

bool lq_walk_knows(const lq_kind *kind) {
    return find(kind) >= 0;
}

lq_status lq_walk_kind(const lq_kind *kind, const lq_settings *settings, const double *point,
                       const lq_walk_run *run, lq_walk_mean *values, lq_error *error) {
    const int which = find(kind);
    if (which < 0) return lq_fail(error, LQ_BAD_INPUT, "no random walk is known for table '%s'", kind->id);
    lq_walk walk = lq_walk_default();
    walk.ndf = lq_ndf_find(settings->ndf);
    if (!walk.ndf) return lq_fail(error, LQ_BAD_INPUT, "unknown NDF '%s'", settings->ndf);
    walk.mu = coordinate(kind, point, "mu", 1.0);
    walk.alpha = coordinate(kind, point, "alpha", 0.0);
    walk.n = coordinate(kind, point, "n", coordinate(kind, point, "eta", 1.0));
    walk.kappa = coordinate(kind, point, "kappa", 0.0);
    walk.samples = run->samples;
    walk.seed = run->seed;
    walk.purpose = run->purpose;
    walk.threads = run->threads;
    return walks[which].run(&walk, settings, values, error);
}

double lq_walk_noise(lq_walk_mean mean, size_t samples) {
    return hypot(mean.error, 3.0 / (double)samples);
}
