/* Normal distribution functions: one descriptor an NDF, and what follows from it by Smith's model.
 *
 * An NDF D(m) is isotropic, lives on the upper hemisphere and is normalised as
 *     integral m_z D(m) dm = 1.
 * Directions are given by their cosine and sine to the macroscopic normal, both, because neither can be
 * recovered from the other without loss where it is near 1.
 */
#ifndef LACQUER_MICROFACET_NDF_H
#define LACQUER_MICROFACET_NDF_H

#include <stddef.h>

typedef struct lq_ndf lq_ndf;

struct lq_ndf {
    const char *id;    /* what --ndf takes */
    const char *title; /* one line */
    const char *source;
    const void *parameters; /* of this instance, or NULL */

    /* D(m) for `count` normals given by cos^2 and sin^2 of their angle to the z axis; alpha > 0. */
    void (*density)(const lq_ndf *ndf, double alpha, size_t count, const double *cos2, const double *sin2,
                    double *d);

    /* Projected area of the facets that face a direction below the horizon at cosine -mu:
     * sigma(-omega) = mu Lambda(mu), finite at mu = 0. mu in [0,1]; alpha >= 0. */
    double (*area_below)(const lq_ndf *ndf, double alpha, double mu, double sin_theta);

    /* The same for `count` cosines. */
    void (*areas_below)(const lq_ndf *ndf, double alpha, size_t count, const double *mu, double *area);

    /* tan(theta_m) such that the normals within theta_m of the z axis hold the fraction xi in [0,1) of
     * integral m_z D dm. */
    double (*slope_quantile)(const lq_ndf *ndf, double alpha, double xi);
};

/* Built-in NDFs. lq_ndf_find returns NULL for an unknown id. */
size_t lq_ndf_builtin_count(void);
const lq_ndf *lq_ndf_builtin(size_t i);
const lq_ndf *lq_ndf_find(const char *id);

/* sigma(omega) for omega above the horizon at cosine mu: mu (1 + Lambda(mu)) = mu + sigma(-omega). */
double lq_area_above(const lq_ndf *ndf, double alpha, double mu, double sin_theta);

/* Smith Lambda at cosine mu; infinity at mu = 0 (alpha > 0), 0 at alpha = 0. */
double lq_lambda(const lq_ndf *ndf, double alpha, double mu);

/* sqrt(1 - mu^2) without the cancellation of the literal form. */
double lq_sine(double mu);

#endif
