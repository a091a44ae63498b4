/* Normal distribution functions: one descriptor an NDF, and what follows from it by Smith's model.
 *
 * An NDF D(m) is isotropic, lives on the upper hemisphere and is normalised as
 *     integral m_z D(m) dm = 1.
 * Directions are given by their cosine and sine to the macroscopic normal, both, because neither can be
 * recovered from the other without loss where it is near 1.
 *
 * ggx.c, beckmann.c, gtr.c, student_t.c, ndf_file.c and ndf_plugin.c each make one; ndf_open.c makes any of
 * them from what --ndf takes. Those without a closed form of everything rest on profile.h.
 */
#ifndef LACQUER_MICROFACET_NDF_H
#define LACQUER_MICROFACET_NDF_H

#include "lacquer.h"

#include <stddef.h>

struct lq_ndf {
    const char *id;    /* what --ndf takes, complete: opening it again gives the same NDF */
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

    /* ---- NULL or 0 where there is nothing to say ---- */

    /* Make what the functions above need at one roughness; without it they make it on first use, and give
     * NaN where that fails. Any thread may call it. */
    lq_status (*prepare)(const lq_ndf *ndf, double alpha, lq_error *error);
    void (*release)(lq_ndf *ndf);
    double alpha_min, alpha_max; /* besides 0; 0, 0: all of [0,1]; equal: this NDF has one roughness */
    bool pieces;      /* in alpha, or it is not known: values between roughnesses need not be smooth */
    const char *note; /* what was done to the input, on one line */
};

/* The NDFs whose every formula is closed: they need no opening. NULL for any other id. */
size_t lq_ndf_builtin_count(void);
const lq_ndf *lq_ndf_builtin(size_t i);
const lq_ndf *lq_ndf_find(const char *id);

/* LQ_BAD_INPUT where alpha, 0 apart, is outside the range of the NDF. */
lq_status lq_ndf_check(const lq_ndf *ndf, double alpha, lq_error *error);
/* Checks alpha and makes what the NDF needs there, where it can still fail. */
lq_status lq_ndf_prepare(const lq_ndf *ndf, double alpha, lq_error *error);

/* sigma(omega) for omega above the horizon at cosine mu: mu (1 + Lambda(mu)) = mu + sigma(-omega). */
double lq_area_above(const lq_ndf *ndf, double alpha, double mu, double sin_theta);

/* Smith Lambda at cosine mu; infinity at mu = 0 (alpha > 0), 0 at alpha = 0. */
double lq_lambda(const lq_ndf *ndf, double alpha, double mu);

/* sqrt(1 - mu^2) without the cancellation of the literal form. */
double lq_sine(double mu);

#endif
