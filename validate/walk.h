/* Random walks on the Smith microsurface (H16): the independent check of every solver in this project.
 *
 * They share the NDF and the Fresnel code with the solvers and nothing else. Samples come from
 * counter-based streams, so a result depends on the seed and the number of samples, never on the threads.
 * All energies are flux fractions.
 */
#ifndef LACQUER_VALIDATE_WALK_H
#define LACQUER_VALIDATE_WALK_H

#include "lacquer.h"
#include "microfacet/ndf.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum lq_walk_fresnel {
    LQ_WALK_CONDUCTOR,  /* complex index n + i kappa */
    LQ_WALK_DIELECTRIC, /* n is eta = n_far / n_near */
    LQ_WALK_SCHLICK     /* f0 + (f90 - f0)(1 - cos)^5; f0 = f90: a constant */
} lq_walk_fresnel;

typedef struct lq_walk {
    const lq_ndf *ndf;
    double alpha; /* [0,1]; 0 is the smooth interface, without microsurface */
    lq_walk_fresnel fresnel;
    double n, kappa;
    double f0, f90;
    double mu;   /* cosine of incidence in [0,1] */
    bool cosine; /* instead of mu: cosine-weighted incidence over the hemisphere */
    /* Two-sided walk: transmittance at normal incidence of the media on the near and the far side. A path
     * at cosine c costs tau^(1/c): on the way in and out on the near side, on the way out on the far side.
     * T01(tau) is near 1, far tau; T10 and R10 of the base (cosine set, eta from below) near tau, far 1. */
    double tau_near, tau_far;
    bool once;  /* two-sided walk: what would meet a second facet is lost */
    double rho; /* lq_walk_coated: albedo of the base */
    size_t samples;
    uint64_t seed, purpose; /* walks that must not share random numbers differ in one of them */
    int threads;            /* 0: one per core */
} lq_walk;

typedef struct lq_walk_mean {
    double mean;
    double error; /* standard error of the mean; 0 where the value is known exactly */
} lq_walk_mean;

enum { LQ_WALK_MAX_ORDERS = 32 };
#define LQ_WALK_MAX_SAMPLES 1000000000000u /* a week of one core */

/* GGX at alpha 0.5 and mu 1, F = 1, no absorption, 100000 samples, seed 1. */
lq_walk lq_walk_default(void);

/* LQ_BAD_INPUT and a message where anything above is out of range; every walk below calls it. */
lq_status lq_walk_check(const lq_walk *walk, lq_error *error);

/* Reflection only, weight F per hit: FGD-infinity of a conductor. `orders` (NULL or `order_count` of
 * them, at most LQ_WALK_MAX_ORDERS) gets the energy that leaves after exactly 1, 2, ... hits. */
lq_status lq_walk_reflect(const lq_walk *walk, lq_walk_mean *energy, lq_walk_mean *orders, size_t order_count,
                          lq_error *error);

/* One hit, then masking: integral F D_v G dm over the facets. */
lq_status lq_walk_single(const lq_walk *walk, lq_masking masking, lq_walk_mean *energy, lq_error *error);

typedef struct lq_walk_sides {
    lq_walk_mean reflected, transmitted; /* leaves on the near, on the far side */
    /* Flux-weighted mean of sin^2 of the direction, in the medium it leaves into. */
    lq_walk_mean reflected_sin2, transmitted_sin2;
} lq_walk_sides;

/* Reflects or refracts at each hit; fresnel must be LQ_WALK_DIELECTRIC. Every sample conserves energy. */
lq_status lq_walk_two_sided(const lq_walk *walk, lq_walk_sides *sides, lq_error *error);

/* A Lambertian base of albedo rho under the interface, with a medium of transmittance tau_far between: light
 * is followed through every bounce between the two (D22 sec. 3.1). `albedo` is all that leaves on the near
 * side. */
lq_status lq_walk_coated(const lq_walk *walk, lq_walk_mean *albedo, lq_error *error);

#endif
