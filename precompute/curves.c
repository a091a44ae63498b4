/* Fresnel curves and the choice of a small basis of them. */
#include "precompute/curves.h"

#include "microfacet/fresnel.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>

static const double half_pi = 1.57079632679489661923;

void lq_curves_at(const lq_curves *curves, double cos_d, double *values) {
    values[0] = 1.0;
    if (curves->count == 1) return;
    if (curves->family == LQ_CURVES_SCHLICK) {
        const double c = 1.0 - cos_d, c2 = c * c;
        values[1] = 1.0 - c2 * c2 * c;
        return;
    }
    lq_fresnel_conductors(cos_d, (size_t)curves->count - 1, curves->n + 1, curves->kappa + 1, values + 1);
    for (int k = 1; k < curves->count; k++) values[k] = 1.0 - values[k];
}

void lq_curves_none(lq_curves *curves) {
    curves->family = LQ_CURVES_CONDUCTOR;
    curves->count = 1;
    lq_panels_start(&curves->panels, 0.0, half_pi);
}

void lq_curves_schlick(lq_curves *curves) {
    lq_curves_none(curves);
    curves->family = LQ_CURVES_SCHLICK;
    curves->count = 2;
}

/* ------------------------------------------------------------------------------- panels */

/* Below this distance from the real axis a singularity is a kink: a break point with mapped ends. */
static const double kink = 1e-7;

/* Is the panel wider than the distance of some singularity allows? A panel of half-width h converges like
 * (s + sqrt(1 + s^2))^(-2 points), s = distance / h; s >= 1 gives 2.4 at worst. */
static bool too_wide(const lq_panels *panels, int p, const lq_fresnel_singularity *all, int count) {
    const double from = panels->at[p], to = panels->at[p + 1];
    const double half = 0.5 * (to - from), centre = 0.5 * (from + to);
    for (int i = 0; i < count; i++) {
        const double along = fmax(fabs(all[i].angle - centre) - half, 0.0);
        const bool at_end = all[i].distance < kink && along < kink;
        if (!at_end && hypot(along, all[i].distance) < half) return true;
    }
    return false;
}

/* Bisect until every panel suits every singularity. */
static void resolve(lq_panels *panels, const lq_fresnel_singularity *all, int count) {
    for (int i = 0; i < count; i++)
        if (all[i].distance < kink) lq_panels_add(panels, all[i].angle, true);
    for (int p = 0; p + 1 < panels->count;) {
        const double width = panels->at[p + 1] - panels->at[p];
        if (width > 1e-8 && panels->count < LQ_PANELS_MAX / 2 && too_wide(panels, p, all, count))
            lq_panels_add(panels, panels->at[p] + 0.5 * width, false);
        else p++;
    }
}

void lq_fresnel_panels(lq_panels *panels, const double *n, const double *kappa, int count) {
    lq_fresnel_singularity all[2 * LQ_CURVES_MAX];
    for (int k = 0; k < count; k++) lq_fresnel_singularities(n[k], kappa[k], all + 2 * k);
    lq_panels_start(panels, 0.0, half_pi);
    resolve(panels, all, 2 * count);
}

/* The first curve is the constant 1. */
static void make_panels(lq_curves *curves) {
    lq_fresnel_panels(&curves->panels, curves->n + 1, curves->kappa + 1, curves->count - 1);
}

void lq_curves_conductor(lq_curves *curves, double n, double kappa) {
    lq_curves_none(curves);
    curves->count = 2;
    curves->n[1] = n;
    curves->kappa[1] = kappa;
    make_panels(curves);
}

/* -------------------------------------------------------------------------------- basis */

/* Cosines at which the curves are compared: even in angle, crowded towards grazing (nearly matched indices
 * change there) and around every critical angle. */
enum { EVEN = 320, GRAZING = 64, AROUND = 10, SAMPLES_MAX = 1024 };

typedef struct samples {
    size_t count;
    double cosine[SAMPLES_MAX];
} samples;

static void sample_angle(samples *s, double angle) {
    if (angle >= 0.0 && angle < half_pi && s->count < SAMPLES_MAX) s->cosine[s->count++] = cos(angle);
}

static void sample_around_branch(samples *s, double n, double kappa) {
    lq_fresnel_singularity found[2];
    lq_fresnel_singularities(n, kappa, found);
    if (n >= 1.0 || found[0].distance > 0.02) return;
    double step = fmax(found[0].distance, 1e-4);
    for (int i = 0; i < AROUND / 2; i++, step *= 3.0) {
        sample_angle(s, found[0].angle - step);
        sample_angle(s, found[0].angle + step);
    }
}

static void choose_samples(samples *s, const double *n, const double *kappa, size_t count) {
    s->count = 0;
    for (int i = 0; i < EVEN; i++) sample_angle(s, half_pi * i / EVEN);
    for (int i = 0; i < GRAZING; i++) sample_angle(s, half_pi - 0.05 * pow(0.8, i));
    for (size_t m = 0; m < count; m++) sample_around_branch(s, n[m], kappa[m]);
}

/* State of the cross approximation: residual[m * samples + i], and of each step its pivot material. The
 * factors of step k are kept as `row` (the residual curve of its pivot, scaled to 1 at the pivot cosine) and,
 * in `column`, the residual of every material at that cosine. */
typedef struct cross {
    size_t materials, samples;
    double *residual;
    double *row; /* one at a time */
    double *column[LQ_CURVES_MAX];
    size_t pivot[LQ_CURVES_MAX];
} cross;

static double largest(const cross *x, size_t *material, size_t *sample) {
    double most = 0.0;
    for (size_t m = 0; m < x->materials; m++)
        for (size_t i = 0; i < x->samples; i++) {
            const double r = fabs(x->residual[m * x->samples + i]);
            if (r > most) {
                most = r;
                *material = m;
                *sample = i;
            }
        }
    return most;
}

/* Take the pivot's residual curve out of every material. */
static void eliminate(cross *x, int k, size_t material, size_t sample) {
    const double *source = x->residual + material * x->samples;
    const double scale = 1.0 / source[sample];
    for (size_t i = 0; i < x->samples; i++) x->row[i] = source[i] * scale;
    for (size_t m = 0; m < x->materials; m++) {
        double *r = x->residual + m * x->samples;
        const double c = x->column[k][m] = r[sample];
        for (size_t i = 0; i < x->samples; i++) r[i] -= c * x->row[i];
        r[sample] = 0.0;
    }
    x->pivot[k] = material;
}

/* Express every material in the pivot curves themselves. The elimination wrote material m as
 * sum_k column_k[m] / column_k[pivot_k] * (residual curve of pivot k); for the pivots that is unit lower
 * triangular, so c follows by back substitution from the last pivot to the first. */
static void solve_coefficients(const cross *x, int rank, double *coefficients) {
    for (size_t m = 0; m < x->materials; m++) {
        double *c = coefficients + m * LQ_CURVES_MAX;
        c[0] = 0.0;
        for (int k = rank - 1; k >= 0; k--) {
            double value = x->column[k][m];
            for (int l = k + 1; l < rank; l++) value -= c[1 + l] * x->column[k][x->pivot[l]];
            c[1 + k] = value / x->column[k][x->pivot[k]];
        }
    }
}

static void fill_absorptances(cross *x, const samples *s, const double *n, const double *kappa) {
    for (size_t m = 0; m < x->materials; m++)
        for (size_t i = 0; i < x->samples; i++)
            x->residual[m * x->samples + i] = 1.0 - lq_fresnel_conductor(s->cosine[i], n[m], kappa[m]);
}

static void cross_free(cross *x) {
    for (int k = 0; k < LQ_CURVES_MAX; k++) free(x->column[k]);
    free(x->row);
    free(x->residual);
}

/* The pivots, most important first; returns their number, or -1 without memory. */
static int choose_pivots(cross *x, double accuracy, double *missed) {
    for (int k = 0;; k++) {
        size_t material = 0, sample = 0;
        *missed = largest(x, &material, &sample);
        if (*missed <= accuracy || k + 1 == LQ_CURVES_MAX) return k;
        x->column[k] = malloc(x->materials * sizeof(double));
        if (!x->column[k]) return -1;
        eliminate(x, k, material, sample);
    }
}

lq_status lq_curves_basis(lq_curves *curves, const double *n, const double *kappa, size_t count,
                          double accuracy, double *coefficients, double *missed, lq_error *error) {
    samples *s = malloc(sizeof *s);
    cross x = {.materials = count};
    int rank = -1;
    if (s) {
        choose_samples(s, n, kappa, count);
        x.samples = s->count;
        x.residual = malloc(count * s->count * sizeof(double));
        x.row = malloc(s->count * sizeof(double));
    }
    if (x.residual && x.row) {
        fill_absorptances(&x, s, n, kappa);
        rank = choose_pivots(&x, accuracy, missed);
    }
    if (rank >= 0) {
        solve_coefficients(&x, rank, coefficients);
        lq_curves_none(curves);
        curves->count = rank + 1;
        for (int k = 0; k < rank; k++) {
            curves->n[k + 1] = n[x.pivot[k]];
            curves->kappa[k + 1] = kappa[x.pivot[k]];
        }
        make_panels(curves);
    }
    cross_free(&x);
    free(s);
    return rank < 0 ? lq_fail(error, LQ_NO_MEMORY, "no memory for the Fresnel curves of %zu materials", count)
                    : LQ_OK;
}
