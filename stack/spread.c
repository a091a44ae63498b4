/* spread.c - visible normals of GGX by their projection onto a disc, summed over rings and sectors. */
#include "stack/spread.h"

#include <math.h>
#include <stdlib.h>

#include "system/status.h"

enum { RINGS = 32, SECTORS = 24, ALPHAS = 33 };

static double alpha_of(size_t i) {
    const double root = (double)i / (ALPHAS - 1);
    return root * root;
}

/* `along` the projected direction away from the light, and across it. */
typedef struct direction {
    double along, across, up;
} direction;

/* One visible normal of light from (sin, 0, mu), scaled by alpha to the hemisphere where visible normals are
 * a disc seen from the side (the density's invariance to stretching). The reflected direction. */
static direction reflect_at(double mu, double sine, double alpha, double radius, double angle) {
    const double x = alpha * sine, length = sqrt(x * x + mu * mu), nx = x / length, nz = mu / length;
    const double across_disc = radius * sin(angle), straight = radius * cos(angle);
    /* Half of the disc is cut by the horizon of the stretched hemisphere, and so squeezed. */
    const double half = 0.5 * (1.0 + nz);
    const double up = (1.0 - half) * sqrt(1.0 - across_disc * across_disc) + half * straight;
    const double out = sqrt(fmax(1.0 - across_disc * across_disc - up * up, 0.0));
    const double hx = alpha * (-nz * up + nx * out), hy = alpha * across_disc;
    const double hz = fmax(nx * up + nz * out, 0.0), scale = 1.0 / sqrt(hx * hx + hy * hy + hz * hz);
    const double dot = (sine * hx + mu * hz) * scale;
    return (direction){sine - 2.0 * dot * hx * scale, 2.0 * dot * hy * scale, 2.0 * dot * hz * scale - mu};
}

static double lambda_of(double mu, double alpha) {
    const double tangent = (1.0 - mu * mu) / (mu * mu);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tangent) - 1.0);
}

lq_stack_lobe lq_spread_lobe(double mu, double alpha) {
    const double pi = 3.14159265358979323846, from = fmax(mu, 1e-6),
                 sine = sqrt(fmax(1.0 - from * from, 0.0));
    const double shadow = 1.0 + lambda_of(from, alpha);
    double energy = 0.0, sin2 = 0.0, mean = 0.0, across = 0.0;
    for (int r = 0; r < RINGS; r++)
        for (int s = 0; s < SECTORS; s++) {
            /* Rings crowd towards the edge, where the long tail of slopes is. */
            const double t = 1.0 - (r + 0.5) / RINGS, weight = t * t;
            const double radius = sqrt(1.0 - t * t * t), angle = pi * (s + 0.5) / SECTORS;
            const direction out = reflect_at(from, sine, alpha, radius, angle);
            if (out.up <= 0.0) continue;
            const double passes = weight * shadow / (shadow + lambda_of(out.up, alpha));
            energy += passes;
            sin2 += passes * (out.along * out.along + out.across * out.across);
            mean += passes * out.along;
            across += passes * out.across * out.across;
        }
    if (!(energy > 0.0)) return (lq_stack_lobe){.energy = 1.0};
    if (sine == 0.0) mean = 0.0; /* but for rounding */
    return (lq_stack_lobe){1.0, sin2 / energy, mean / energy, across / energy};
}

double lq_spread_across(double mu, double alpha) {
    return lq_spread_lobe(mu, alpha).across;
}

lq_status lq_spread_make(lq_spread *spread, const double *mu, size_t count, lq_error *error) {
    *spread = (lq_spread){count, malloc((count * ALPHAS + 1) * sizeof(double))};
    if (!spread->across) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", count);
    for (size_t i = 0; i < count * ALPHAS; i++)
        spread->across[i] = lq_spread_across(mu[i / ALPHAS], alpha_of(i % ALPHAS));
    return LQ_OK;
}

void lq_spread_free(lq_spread *spread) {
    free(spread->across);
    *spread = (lq_spread){0};
}

double lq_spread_alpha(const lq_spread *spread, size_t m, double across) {
    const double *row = spread->across + m * ALPHAS;
    size_t above = 1;
    while (above < ALPHAS && row[above] < across) above++;
    if (above == ALPHAS) return 1.0;
    /* Spread grows nearly like a power of alpha: straight in the root of both. */
    const double low = sqrt(row[above - 1]), high = sqrt(row[above]), at = sqrt(fmax(across, 0.0));
    const double share = fmin(fmax((at - low) / (high - low), 0.0), 1.0);
    return alpha_of(above - 1) + share * (alpha_of(above) - alpha_of(above - 1));
}

lq_status lq_spread_alpha_at(double mu, double across, double *alpha, lq_error *error) {
    lq_spread spread = {0};
    const lq_status status = lq_spread_make(&spread, &mu, 1, error);
    if (status == LQ_OK) *alpha = lq_spread_alpha(&spread, 0, across);
    lq_spread_free(&spread);
    return status;
}
