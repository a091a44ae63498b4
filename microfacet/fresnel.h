/* Fresnel reflectance of a smooth interface, unpolarised, exact. */
#ifndef LACQUER_MICROFACET_FRESNEL_H
#define LACQUER_MICROFACET_FRESNEL_H

/* Dielectric. cos_i in [0,1]: cosine of incidence; eta = n_far / n_near > 0, either side of 1.
 * Returns the reflectance in [0,1]; where cos_t is not NULL it gets the cosine of refraction,
 * 0 under total internal reflection. R = 0 exactly at eta = 1. */
double lq_fresnel_dielectric(double cos_i, double eta, double *cos_t);

/* Conductor. cos_i in [0,1]; n + i kappa: complex index relative to the medium above, n, kappa >= 0.
 * kappa = 0 gives the dielectric reflectance of eta = n, total internal reflection included. */
double lq_fresnel_conductor(double cos_i, double n, double kappa);

/* Where the reflectance of n + i kappa is not smooth: it has a branch point at the complex incidence
 * angle theta* with cos^2 theta* = 1 - (n + i kappa)^2. Gives the real and imaginary part (>= 0) of
 * the one nearest to [0, pi/2]; a zero imaginary part is a kink on the axis, the critical angle. */
void lq_fresnel_branch(double n, double kappa, double *angle, double *distance);

#endif
