/* model_tables.c - B18 sec. 5.1's coefficients and D22's, by lq_eval. */
#include "stack/model_tables.h"

#include <math.h>
#include <string.h>

#include "stack/description.h"
#include "system/status.h"

/* Below this the Jacobian is not asked: light along the horizon has no disc to be projected on. */
static const double HORIZON = 1e-6;

/* Tables are asked for far more than the model is right to: one that is not reached is no reason to stop
 * before it shows in a third digit. */
static const double ENOUGH = 1e-3;

static lq_status compute(const lq_kind *kind, double tolerance, const double *point, double *values,
                         lq_error *error) {
    lq_settings settings = lq_settings_default();
    double estimate = 0.0;
    settings.tolerance = tolerance;
    const lq_status status = lq_eval(kind, &settings, point, values, &estimate, error);
    return status == LQ_NOT_CONVERGED && estimate <= ENOUGH ? LQ_OK : status;
}

static bool recall(const lq_model_memo *memo, const char *id, const double *point, int axes, double *values) {
    for (size_t i = 0; memo && i < memo->count; i++)
        if (strcmp(memo->entry[i].kind, id) == 0 &&
            memcmp(memo->entry[i].point, point, (size_t)axes * sizeof *point) == 0) {
            memcpy(values, memo->entry[i].values, sizeof memo->entry[i].values);
            return true;
        }
    return false;
}

static void remember(lq_model_memo *memo, const char *id, const double *point, int axes,
                     const double *values) {
    if (!memo || memo->count == sizeof memo->entry / sizeof *memo->entry) return;
    const size_t i = memo->count++;
    memo->entry[i].kind = id;
    memcpy(memo->entry[i].point, point, (size_t)axes * sizeof *point);
    memcpy(memo->entry[i].values, values, sizeof memo->entry[i].values);
}

/* All channels of a table: one, or two of `variance`. */
static lq_status look_up(const lq_model_tables *tables, const char *id, const double *point, double *values,
                         lq_error *error) {
    const lq_kind *kind = lq_kind_find(id, error);
    double all[2] = {0.0, 0.0};
    if (!kind) return LQ_BAD_INPUT;
    if (!recall(tables->memo, id, point, kind->axis_count, all)) {
        const lq_model_source *source = tables->source;
        const lq_status status = source ? source->value(source->user, kind, point, all, error)
                                        : compute(kind, tables->tolerance, point, all, error);
        if (status != LQ_OK) return status;
        remember(tables->memo, id, point, kind->axis_count, all);
    }
    memcpy(values, all, (size_t)kind->channel_count * sizeof *values);
    return LQ_OK;
}

double lq_model_lookup_alpha(const lq_model_tables *tables, double arriving, double alpha) {
    if (tables->variant == LQ_MODEL_PAPER) return alpha;
    return lq_model_roughness(tables->mapping, arriving + lq_model_variance(tables->mapping, alpha));
}

lq_status lq_model_pass(const lq_model_tables *tables, lq_model_ray ray, double above, double looked_up,
                        double *pass, lq_error *error) {
    return look_up(tables, "tir-pass", (double[]){ray.cosine, looked_up, above / ray.index}, pass, error);
}

/* ======================================================================================
 *                                      Interfaces
 * ====================================================================================== */

/* Snell, on the mean direction; 0 where it does not refract. */
static double refracted(double cosine, double eta) {
    const double sine2 = (1.0 - cosine) * (1.0 + cosine) / (eta * eta);
    return sine2 < 1.0 ? sqrt(1.0 - sine2) : 0.0;
}

/* Roughness of transmitted light, `eta` n_far / n_near: s alpha, s = |1 - mu_i / (eta mu_t)| / 2 (B18 eq. 10,
 * 13). The released code has all cosines as at normal incidence. */
static double transmitted_variance(const lq_model_tables *tables, double alpha, double eta, double in,
                                   double out) {
    const double tilt = tables->variant == LQ_MODEL_PAPER ? in / fmax(out, HORIZON) : 1.0;
    return lq_model_variance(tables->mapping, 0.5 * alpha * fabs(1.0 - tilt / eta));
}

lq_model_spread lq_model_spread_of(const lq_model_tables *tables, double alpha, lq_model_ray above,
                                   lq_model_ray below) {
    const double eta = below.index / above.index, in = above.cosine, out = below.cosine;
    return (lq_model_spread){lq_model_variance(tables->mapping, alpha),
                             transmitted_variance(tables, alpha, eta, in, out),
                             transmitted_variance(tables, alpha, 1.0 / eta, out, in)};
}

static lq_status energies(const lq_model_tables *tables, double in, double out, double eta, double alpha,
                          double looked_up, lq_model_interface *i, lq_error *error) {
    lq_status status =
        look_up(tables, "fgd-dielectric", (double[]){in, looked_up, eta}, &i->r12.energy, error);
    if (status != LQ_OK || out <= 0.0) return status;
    i->r21.energy = i->r12.energy;
    if (tables->variant == LQ_MODEL_PAPER)
        status = look_up(tables, "fgd-dielectric", (double[]){out, alpha, 1.0 / eta}, &i->r21.energy, error);
    i->t12.energy = 1.0 - i->r12.energy;
    i->t21.energy = 1.0 - i->r21.energy;
    return status;
}

lq_status lq_model_dielectric(const lq_model_tables *tables, lq_model_ray *ray, double n, double alpha,
                              double looked_up, lq_model_interface *i, lq_error *error) {
    const double eta = n / ray->index, in = ray->cosine, out = refracted(in, eta);
    const double jacobian = out > 0.0 ? eta * out / fmax(in, HORIZON) : 1.0;
    const lq_model_spread spread = lq_model_spread_of(tables, alpha, *ray, (lq_model_ray){out, n});
    *i = (lq_model_interface){.j12 = jacobian, .j21 = 1.0 / jacobian};
    i->r12.variance = i->r21.variance = spread.reflected;
    i->t12.variance = spread.down;
    i->t21.variance = spread.up;
    *ray = (lq_model_ray){out, n};
    return energies(tables, in, out, eta, alpha, looked_up, i, error);
}

lq_status lq_model_conductor(const lq_model_tables *tables, lq_model_ray ray, double n, double kappa,
                             double alpha, double looked_up, lq_model_interface *i, lq_error *error) {
    *i = (lq_model_interface){.j12 = 1.0, .j21 = 1.0};
    i->r12.variance = i->r21.variance = lq_model_variance(tables->mapping, alpha);
    return look_up(tables, "fgd", (double[]){ray.cosine, looked_up, n / ray.index, kappa / ray.index},
                   &i->r12.energy, error);
}

/* ======================================================================================
 *                                          Media
 * ====================================================================================== */

/* What is not scattered, e^-T, and what is once, S e^-T, of optical depths T = (sigma_a + sigma_s) h / mu and
 * S = sigma_s h / mu (B18 eq. 15, 22). The second is spread by sigma_g (eq. 24), and both are taken for one
 * lobe as eq. 38 has it. The released code spreads the first, too. */
lq_flow lq_model_medium(const lq_model_tables *tables, const lq_medium *medium, int channel, double cosine) {
    const double direct = pow(lq_medium_transmittance(medium, channel), 1.0 / cosine);
    const double once =
        medium->by_sigma ? medium->sigma_s.value[channel] * medium->depth.value[channel] / cosine : 0.0;
    if (!(once > 0.0)) return (lq_flow){direct, 0.0};
    const double spread = lq_model_phase(tables->mapping, medium->g.value[channel]);
    return (lq_flow){direct * exp(-once) * (1.0 + once),
                     tables->variant == LQ_MODEL_PAPER ? spread * once / (1.0 + once) : spread};
}

/* ======================================================================================
 *                                     Lambertian base
 * ====================================================================================== */

lq_status lq_model_diffuse(const lq_model_tables *tables, const lq_model_coat *coat, double *energy,
                           double *alpha, lq_error *error) {
    double through, out, back, spread[2];
    const double under[] = {coat->eta, coat->alpha, coat->tau};
    lq_status status = look_up(tables, "transmission",
                               (double[]){coat->mu, coat->alpha, coat->eta, coat->tau}, &through, error);
    if (status == LQ_OK) status = look_up(tables, "diffuse-transmission", under, &out, error);
    if (status == LQ_OK) status = look_up(tables, "diffuse-reflection", under, &back, error);
    if (status == LQ_OK) status = look_up(tables, "variance", under, spread, error);
    if (status != LQ_OK) return status;
    *energy = through * coat->rho / (1.0 - coat->rho * back) * out;
    *alpha = spread[1];
    return LQ_OK;
}
