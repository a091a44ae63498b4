/* What an NDF without closed forms tabulates, once per roughness and on first use.
 *
 * Two tables on the octave grid of octaves.h, both cheaper to read than GGX is to evaluate:
 *  - D over q = b^2 cos^2 + sin^2, b the power of two at or below alpha: q is about b^2 in the core, and
 *    dq = (1 - b^2) d(sin^2), so that integral m_z D = pi / (1 - b^2) integral D dq is exact for the cubics:
 *    the normalisation, and the distribution that slope_quantile inverts;
 *  - sigma(-omega) over z = b + (1 - b) mu: a function of mu that changes over mu ~ alpha, without a square
 *    root anywhere.
 * An NDF with D in closed form uses the second alone. Look-ups from any thread; what is tabulated depends on
 * alpha only, not on who asked first.
 */
#ifndef LACQUER_MICROFACET_PROFILE_H
#define LACQUER_MICROFACET_PROFILE_H

#include "microfacet/ndf.h"
#include "microfacet/octaves.h"

#include <stdatomic.h>

typedef struct lq_areas {
    lq_octaves over; /* z */
} lq_areas;

typedef struct lq_profile {
    double alpha, scale; /* `scale` is b */
    lq_octaves density;  /* over q; no cells where the NDF has its own */
    double *beyond;      /* of integral m_z D, what lies beyond the start of each cell, and 0 */
    double factor;       /* that normalised D */
    double worst;        /* a theta, in degrees, at which D is negative or not finite; -1: none */
    _Atomic(lq_areas *) areas;
    struct lq_profile *next;
} lq_profile;

enum { LQ_PROFILE_BUCKETS = 256 };

/* The part that such NDFs share; the NDF is its first member, its `parameters` the whole. */
typedef struct lq_profiled {
    lq_ndf ndf;
    /* D in any scale, where the density is to be tabulated; otherwise NULL. */
    void (*shape)(const struct lq_profiled *of, double alpha, size_t count, const double *cos2,
                  const double *sin2, double *d);
    /* Projected area in closed form, to fill the table from; NULL: quadrature over D. */
    double (*exact_area)(const struct lq_profiled *of, double alpha, double mu, double sin_theta);
    _Atomic(lq_profile *) buckets[LQ_PROFILE_BUCKETS];
} lq_profiled;

void lq_profiled_free(lq_profiled *of);

/* The profile of one roughness; NULL: no memory. */
const lq_profile *lq_profiled_at(const lq_profiled *of, double alpha);

/* Members of lq_ndf. The quantile and the density need `shape`. */
void lq_profiled_density(const lq_ndf *ndf, double alpha, size_t count, const double *cos2,
                         const double *sin2, double *d);
double lq_profiled_area_below(const lq_ndf *ndf, double alpha, double mu, double sin_theta);
void lq_profiled_areas_below(const lq_ndf *ndf, double alpha, size_t count, const double *mu, double *area);
double lq_profiled_quantile(const lq_ndf *ndf, double alpha, double xi);
lq_status lq_profiled_prepare(const lq_ndf *ndf, double alpha, lq_error *error);

/* Projected area from D by quadrature, for any NDF: integral over the facets that face -omega,
 *     sigma(-omega) = 2 s integral D sin^2 (sin phi - phi cos phi) dtheta,  cos phi = mu / (s tan theta). */
double lq_area_by_quadrature(const lq_ndf *ndf, double alpha, double mu, double sin_theta);

#endif
