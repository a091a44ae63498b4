/* shape_lobe.h - one GGX lobe as a density of directions, as shaders evaluate it: D G2 / (4 mu_i) with
 * height-correlated masking. */
#ifndef LACQUER_STACK_SHAPE_LOBE_H
#define LACQUER_STACK_SHAPE_LOBE_H

#include "lacquer.h"

/* Light along the horizon is that just above it, as tables have it. */
#define LQ_SHAPE_LEAST_MU 1e-6

/* Light that arrives from (-sine, 0, cosine). */
typedef struct lq_incidence {
    double cosine, sine;
} lq_incidence;

lq_incidence lq_incidence_of(double mu);

/* D G2 / (4 mu_i), the BRDF times the cosine, at an outgoing direction above the horizon. */
double lq_lobe_density(lq_incidence from, double alpha, double x, double y, double z);

/* A GGX of two roughnesses, whose first axis is turned by an angle from the plane of incidence. */
typedef struct lq_turned_ggx {
    double x, y;         /* roughnesses */
    double cosine, sine; /* of that angle */
} lq_turned_ggx;

double lq_lobe_turned_density(lq_incidence from, const lq_turned_ggx *ggx, double x, double y, double z);

/* Its energy: the directional albedo of the microsurface with F = 1. */
lq_status lq_lobe_albedo(double mu, double alpha, double *albedo, lq_error *error);

/* Cosine between light and half vector of light and outgoing direction. */
double lq_incidence_half(lq_incidence from, double x, double z);

#endif
