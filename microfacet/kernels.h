/* The hot loops of this room, built once per instruction set.
 *
 * kernels_body.h holds them; kernels_base.c, kernels_avx2.c and kernels_avx512.c compile it with the flags
 * of their names (CMake sets them by file), and lq_microfacet_kernels() picks the widest the processor
 * runs. One binary serves every x86-64; on other processors the baseline is the only one.
 */
#ifndef LACQUER_MICROFACET_KERNELS_H
#define LACQUER_MICROFACET_KERNELS_H

#include "microfacet/octaves.h"

#include <stddef.h>

/* What the facets of one fan have in common (facets.c). */
typedef struct lq_fan_constants {
    double lambda, lambda2;
    double tilt0;   /* 1 - m_z at psi = 0 */
    double tilt1;   /* growth of 1 - m_z with sin^2(psi/2) */
    double mirror0; /* cos 2d v_z */
    double mirror1; /* sin 2d */
    double sin_v;
} lq_fan_constants;

enum { LQ_LUNE_TERMS = 28 };

typedef struct lq_microfacet_kernels {
    /* lq_fresnel_conductors */
    void (*conductors)(double cos_i, size_t count, const double *n, const double *kappa, double *reflectance);
    /* lq_ndf.density and lq_ndf.areas_below of GGX */
    void (*ggx_density)(double alpha, size_t count, const double *cos2, const double *sin2, double *d);
    void (*ggx_areas_below)(double alpha, size_t count, const double *mu, double *area);
    /* The same of the NDFs that tabulate (profile.h): over b^2 cos^2 + sin^2, and over b + (1 - b) mu. */
    void (*octaves_density)(const lq_octaves *o, size_t count, const double *cos2, const double *sin2,
                            double *d);
    void (*octaves_areas)(const lq_octaves *o, size_t count, const double *mu, double *area);
    /* sin phi - phi cos phi, cos phi = min(cot cosine / sine, 1), by the series of profile.c. */
    void (*lunes)(const double *term, double cot, size_t count, const double *sine, const double *cosine,
                  double *lune);
    /* Azimuth nodes h = chi/2 in [0, pi/2] with weights dh to facets: fills mirror, e_z and cos^2, sin^2 of
     * their tilt, and turns dh into dpsi. */
    void (*place_facets)(const lq_fan_constants *k, size_t count, const double *h, double *dpsi,
                         double *mirror, double *e_z, double *cos2, double *sin2);
} lq_microfacet_kernels;

const lq_microfacet_kernels *lq_microfacet_kernels_get(void);

/* The copies; NULL where the file was compiled without its instruction set. */
const lq_microfacet_kernels *lq_microfacet_kernels_base(void);
const lq_microfacet_kernels *lq_microfacet_kernels_avx2(void);
const lq_microfacet_kernels *lq_microfacet_kernels_avx512(void);

#endif
