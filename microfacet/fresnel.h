/* Fresnel reflectance of a smooth interface, unpolarised, exact. */
#ifndef LACQUER_MICROFACET_FRESNEL_H
#define LACQUER_MICROFACET_FRESNEL_H

#include <stddef.h>

/* Dielectric. cos_i in [0,1]: cosine of incidence; eta = n_far / n_near > 0, either side of 1.
 * Returns the reflectance in [0,1]; where cos_t is not NULL it gets the cosine of refraction,
 * 0 under total internal reflection. R = 0 exactly at eta = 1. */
double lq_fresnel_dielectric(double cos_i, double eta, double *cos_t);

/* Conductor. cos_i in [0,1]; n + i kappa: complex index relative to the medium above, n, kappa >= 0.
 * kappa = 0 gives the dielectric reflectance of eta = n, total internal reflection included. */
double lq_fresnel_conductor(double cos_i, double n, double kappa);

/* The same for `count` materials at one cosine of incidence. */
void lq_fresnel_conductors(double cos_i, size_t count, const double *n, const double *kappa,
                           double *reflectance);

/* A complex angle of incidence where a reflectance is not analytic: it limits how wide a panel of
 * quadrature around it may be. `distance` 0 is a kink on the real axis: the critical angle. */
typedef struct lq_fresnel_singularity {
    double angle;    /* the nearest angle in [0, pi/2] */
    double distance; /* from there to the singularity */
} lq_fresnel_singularity;

/* The two that matter for n + i kappa: the branch point cos^2 = 1 - eps of the refracted ray, and the pole
 * of r_p at cos = -1 / sqrt(1 + eps), eps = (n + i kappa)^2. */
void lq_fresnel_singularities(double n, double kappa, lq_fresnel_singularity found[2]);

#endif
