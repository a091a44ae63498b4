/* The reflectance of a conductor in real arithmetic, without branches: it runs in vector registers.
 * Included by fresnel.c (one material) and kernels_body.h (many).
 *
 * w = p + iq = sqrt(eps - 1 + c^2) has q >= 0, each part taken from the form that does not cancel; the rest
 * is the right-hand side of the formulas at the head of fresnel.c.
 */
#ifndef LACQUER_MICROFACET_FRESNEL_FORMULA_H
#define LACQUER_MICROFACET_FRESNEL_FORMULA_H

#include <math.h>

static inline double lq_conductor_reflectance(double c, double n, double kappa) {
    const double c2 = c * c;
    const double er = (n - kappa) * (n + kappa), ei = 2.0 * n * kappa;
    const double dr = (n - 1.0) * (n + 1.0) - kappa * kappa; /* eps - 1 */
    const double zr = dr + c2, modulus = sqrt(zr * zr + ei * ei);
    const double large = sqrt(0.5 * (modulus + fabs(zr)));
    const double small = large > 0.0 ? 0.5 * ei / large : 0.0;
    const double p = zr >= 0.0 ? large : small, q = zr >= 0.0 ? small : large;
    const double s = (c + p) * (c + p) + q * q;
    const double tr = er * c + p, ti = ei * c + q, t = tr * tr + ti * ti;
    const double gr = (er + 1.0) * c2 - 1.0, gi = ei * c2;
    const double d = dr * dr + ei * ei; /* |eps - 1|^2 */
    const double sum = d / (s * s) + d * (gr * gr + gi * gi) / (t * t);
    /* 0/0 is left where nothing separates the media (0), and at grazing or eps = 0 (1). */
    const double exact = s > 0.0 && t > 0.0 ? (sum < 2.0 ? 0.5 * sum : 1.0) : 1.0;
    return d > 0.0 ? exact : 0.0;
}

#endif
