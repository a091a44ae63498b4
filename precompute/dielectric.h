/* Both sides of a rough dielectric, all orders of scattering, without noise.
 *
 * Two media meet at a microsurface; side 0 is where the light of interest comes from, side 1 the other. Each
 * side has its own frame with z away from the surface, in which the facets look the same and the other medium
 * has the relative index eta_s: eta, or 1 / eta. Let E_s(u, omega) be what a ray at depth u (depth.h) that
 * travels in omega on side s is worth in the end, given a reward for every direction in which it may leave
 * either side, and C_s(u, omega) the same just before it meets a facet:
 *
 *     C_s(u, omega) = sum over facets of D_omega(m) [ F E_s(u, omega_r) + (1 - F) E_(1-s)(1 - u, omega_t) ]
 *
 * E follows from C by travel. The pair is collocated in depth and cosine and iterated: every pass adds one
 * hit. The rows of the facet operator add up to 1, so that what leaves on one side and what leaves on the
 * other add up to 1 to rounding at any resolution. At the cosines that are asked for, one more facet integral
 * is taken (a Nystroem step): it carries the critical angle of the first hit exactly.
 */
#ifndef LACQUER_PRECOMPUTE_DIELECTRIC_H
#define LACQUER_PRECOMPUTE_DIELECTRIC_H

#include "lacquer.h"
#include "microfacet/ndf.h"

#include <stdbool.h>

/* Cosines below this are taken for it, in two-sided scattering. Light that enters along the horizon meets the
 * surface at its very top, and what is refracted there leaves again with a chance that goes like mu^Lambda_o,
 * which for a direction near the zenith (Lambda_o ~ 0) stays 1 down to cosines no number format holds: from
 * here to 1e-300 energies drift by some 1e-3 (up to 6e-3 from the denser side at alpha = 0.05), and further
 * beyond. */
#define LQ_GRAZING 1e-6

/* Relative indices this close to 1 are 1: an axis that ought to hit it does so to rounding only. */
#define LQ_MATCHED 1e-12

/* A question to both sides: what is light from `side` at each cosine worth, if leaving side s at cosine mu is
 * rewarded with tau_s^(1/mu)? `reward_side` is the side that pays, the other pays nothing; `taus` as below.
 */
typedef struct lq_question {
    int side;        /* 0 or 1: where the light comes from, at `mu` */
    int reward_side; /* 0 or 1 */
    lq_scattering scattering;
    const double *mu;
    size_t mu_count;
    const double *tau; /* transmittances of the reward; {1} counts energy */
    size_t tau_count;
    double *answer; /* [t * mu_count + m] */
} lq_question;

enum { LQ_DIELECTRIC_LEVELS = 7, LQ_DIELECTRIC_BANDS = 16 };

/* What all interfaces of one roughness share: nodes, depths and travel, made when a level is first asked for.
 */
typedef struct lq_rough_level lq_rough_level;

typedef struct lq_rough {
    const lq_ndf *ndf;
    double alpha;
    lq_rough_level *levels[LQ_DIELECTRIC_BANDS][LQ_DIELECTRIC_LEVELS];
} lq_rough;

lq_rough lq_rough_start(const lq_ndf *ndf, double alpha);
void lq_rough_free(lq_rough *rough);

/* Is the answer known in closed form: smooth, or matched media? */
bool lq_dielectric_is_closed(const lq_rough *rough, double eta);

/* Do the media match so nearly that the solver is not asked, but the limit is (lq_similar)? */
bool lq_dielectric_is_matched(const lq_rough *rough, double eta);

/* Does light meet a dozen facets or more on its way across? The coarsest levels do not resolve that. */
bool lq_dielectric_is_nearly_matched(const lq_rough *rough, double eta);

/* Light at the critical cosine mu_c = sqrt(2 |eta - 1|) meets some N = alpha / mu_c facets on its way across,
 * each of which turns it by next to nothing. For many of them the surface is a smooth gradient of the index,
 * total reflection begins at mu_c as if it were flat but nothing is reflected in part, and what departs from
 * that is a function of mu / mu_c over N, but for the step itself, whose width is mu_c / sqrt(N). (Random
 * walks at N = 32, 100 and 707: within a fifth.) */
typedef struct lq_similar {
    double eta;      /* the interface with LQ_SIMILAR_FACETS to take it from; 0 where there is no need */
    bool denser;     /* light comes from the denser side */
    double facets;   /* N */
    double critical; /* mu_c */
} lq_similar;

#define LQ_SIMILAR_FACETS 32.0

lq_similar lq_dielectric_similar(const lq_rough *rough, double eta);

/* From this index on all of them are solved alike: neither in closed form nor as nearly matched media. */
double lq_dielectric_regular_from(const lq_rough *rough);

/* Answer `count` questions about one interface, eta = n_1 / n_0 > 0, at one level of resolution.
 * LQ_NOT_CONVERGED: this level is too fine for so grazing rays, and its answers are void; coarser ones hold.
 */
lq_status lq_dielectric_answer(lq_rough *rough, double eta, int level, const lq_question *questions,
                               size_t count, lq_error *error);

#endif
