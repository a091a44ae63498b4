/* Table kinds as random walks: one short function a kind. */
#include "validate/walk_kind.h"

#include "microfacet/lobe.h"
#include "system/status.h"
#include "tables/settings.h"
#include "validate/walk_lobe.h"

#include <math.h>
#include <string.h>

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

/* Two-sided scattering takes cosines below this for it: light that enters exactly along the horizon meets the
 * surface at its very top, and energies approach that limit only over many decades of mu. */
static const double grazing = 1e-4;

/* Both sides at the cosine looked up, or for the light of a diffuse base where walk->cosine says so. */
static lq_status walk_sides(lq_walk *walk, lq_walk_sides *sides, lq_error *error) {
    walk->fresnel = LQ_WALK_DIELECTRIC;
    if (walk->alpha > 0.0) walk->mu = fmax(walk->mu, grazing);
    return lq_walk_two_sided(walk, sides, error);
}

/* Of one hit, the walk above the surface does: it weighs by masking, where that of both sides counts who gets
 * away. */
static lq_status walk_fgd_dielectric(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                                     lq_error *error) {
    if (settings->scattering == LQ_SINGLE) {
        walk->fresnel = LQ_WALK_DIELECTRIC;
        return lq_walk_single(walk, LQ_CORRELATED, values, error);
    }
    lq_walk_sides sides;
    const lq_status status = walk_sides(walk, &sides, error);
    if (status == LQ_OK) values[0] = sides.reflected;
    return status;
}

static lq_status walk_transmission(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                                   lq_error *error) {
    walk->once = settings->scattering == LQ_SINGLE;
    lq_walk_sides sides;
    const lq_status status = walk_sides(walk, &sides, error);
    if (status == LQ_OK) values[0] = sides.transmitted;
    return status;
}

/* Light of the base goes up through the coating first: the coating is its near side. */
static lq_status walk_base(lq_walk *walk, lq_walk_sides *sides, lq_error *error) {
    walk->cosine = true;
    walk->n = 1.0 / walk->n;
    walk->tau_near = walk->tau_far;
    walk->tau_far = 1.0;
    return walk_sides(walk, sides, error);
}

static lq_status walk_diffuse_transmission(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                                           lq_error *error) {
    (void)settings;
    lq_walk_sides sides;
    const lq_status status = walk_base(walk, &sides, error);
    if (status == LQ_OK) values[0] = sides.transmitted;
    return status;
}

static lq_status walk_diffuse_reflection(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                                         lq_error *error) {
    (void)settings;
    lq_walk_sides sides;
    const lq_status status = walk_base(walk, &sides, error);
    if (status == LQ_OK) values[0] = sides.reflected;
    return status;
}

/* The second channel is a function of the first; its error goes by the slope of that. */
static lq_status walk_variance(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                               lq_error *error) {
    (void)settings;
    lq_walk_sides sides;
    const lq_status status = walk_base(walk, &sides, error);
    if (status != LQ_OK) return status;
    const lq_walk_mean spread = sides.transmitted_sin2;
    const double step = 1e-4;
    const double slope = (lq_lobe_roughness(walk->ndf, spread.mean + step) -
                          lq_lobe_roughness(walk->ndf, spread.mean - step)) /
                         (2.0 * step);
    values[0] = spread;
    values[1] = (lq_walk_mean){lq_lobe_roughness(walk->ndf, spread.mean), slope * spread.error};
    return status;
}

static lq_status walk_coated(lq_walk *walk, const lq_settings *settings, lq_walk_mean *values,
                             lq_error *error) {
    (void)settings;
    walk->fresnel = LQ_WALK_DIELECTRIC;
    if (walk->alpha > 0.0) walk->mu = fmax(walk->mu, grazing);
    return lq_walk_coated(walk, values, error);
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
    {"fgd-dielectric", walk_fgd_dielectric},
    {"transmission", walk_transmission},
    {"diffuse-transmission", walk_diffuse_transmission},
    {"diffuse-reflection", walk_diffuse_reflection},
    {"variance", walk_variance},
    {"coated-lambertian", walk_coated},
};

enum { WALKS = sizeof walks / sizeof walks[0] };

static int find(const lq_kind *kind) {
    for (int i = 0; i < WALKS; i++)
        if (strcmp(walks[i].id, kind->id) == 0) return i;
    return -1;
}

double lq_kind_coordinate(const lq_kind *kind, const double *point, const char *name, double otherwise) {
    for (int i = 0; i < kind->axis_count; i++)
        if (strcmp(kind->axes[i].name, name) == 0) return point[i];
    return otherwise;
}

bool lq_walk_knows(const lq_kind *kind) {
    return find(kind) >= 0;
}

lq_status lq_walk_kind(const lq_kind *kind, const lq_settings *settings, const double *point,
                       const lq_walk_run *run, lq_walk_mean *values, lq_error *error) {
    const int which = find(kind);
    if (which < 0) return lq_fail(error, LQ_BAD_INPUT, "no random walk is known for table '%s'", kind->id);
    lq_walk walk = lq_walk_default();
    const lq_ndf *own = NULL;
    lq_status status = settings->opened ? LQ_OK : lq_ndf_open(&own, settings->ndf, error);
    if (status != LQ_OK) return status;
    walk.ndf = own ? own : settings->opened;
    walk.mu = lq_kind_coordinate(kind, point, "mu", 1.0);
    walk.alpha = lq_kind_coordinate(kind, point, "alpha", 0.0);
    walk.n = lq_kind_coordinate(kind, point, "n", lq_kind_coordinate(kind, point, "eta", 1.0));
    walk.kappa = lq_kind_coordinate(kind, point, "kappa", 0.0);
    walk.tau_far = lq_kind_coordinate(kind, point, "tau", 1.0);
    walk.rho = lq_kind_coordinate(kind, point, "rho", 0.0);
    walk.samples = run->samples;
    walk.seed = run->seed;
    walk.purpose = run->purpose;
    walk.threads = run->threads;
    status = lq_ndf_prepare(walk.ndf, walk.alpha, error);
    if (status == LQ_OK) status = walks[which].run(&walk, settings, values, error);
    lq_ndf_close(own);
    return status;
}

double lq_walk_noise(lq_walk_mean mean, size_t samples) {
    return hypot(mean.error, 3.0 / (double)samples);
}

lq_status lq_eval_walk(const lq_kind *kind, const lq_settings *settings, const double *point, size_t samples,
                       unsigned long long seed, double *values, double *noise, lq_error *error) {
    lq_settings s;
    lq_walk_mean means[LQ_MAX_CHANNELS];
    lq_status status = lq_settings_read(&s, settings, error);
    const lq_walk_run run = {.samples = samples, .seed = seed, .threads = s.threads};
    if (status == LQ_OK) status = lq_walk_kind(kind, &s, point, &run, means, error);
    for (int c = 0; c < kind->channel_count && status == LQ_OK; c++) {
        values[c] = means[c].mean;
        noise[c] = lq_walk_noise(means[c], samples);
    }
    return status;
}
