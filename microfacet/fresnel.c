/* Fresnel reflectance, in forms that do not cancel when the two media are nearly alike.
 *
 * With eps the squared relative index, c the cosine of incidence and w = sqrt(eps - 1 + c^2):
 *     r_s = (c - w)/(c + w)         = (1 - eps) / (c + w)^2
 *     r_p = (eps c - w)/(eps c + w) = (eps - 1) ((eps + 1) c^2 - 1) / (eps c + w)^2
 * The right-hand forms follow from multiplying by the conjugate sum; eps - 1 is formed from the
 * index as (n - 1)(n + 1), so that eta -> 1 keeps full relative accuracy.
 */
#include "microfacet/fresnel.h"

#include "microfacet/fresnel_formula.h"
#include "microfacet/kernels.h"

#include <complex.h>
#include <math.h>

double lq_fresnel_dielectric(double cos_i, double eta, double *cos_t) {
    const double eps_minus_1 = (eta - 1.0) * (eta + 1.0);
    const double eps = eta * eta;
    const double w2 = eps_minus_1 + cos_i * cos_i;
    if (cos_t) *cos_t = w2 > 0.0 ? fmin(sqrt(w2) / eta, 1.0) : 0.0;
    if (eps_minus_1 == 0.0) return 0.0;
    if (w2 <= 0.0 || cos_i <= 0.0) return 1.0;
    const double w = sqrt(w2);
    const double sum_s = cos_i + w;
    const double sum_p = eps * cos_i + w;
    const double r_s = eps_minus_1 / (sum_s * sum_s);
    const double r_p = eps_minus_1 * ((eps + 1.0) * cos_i * cos_i - 1.0) / (sum_p * sum_p);
    return fmin(0.5 * (r_s * r_s + r_p * r_p), 1.0);
}

double lq_fresnel_conductor(double cos_i, double n, double kappa) {
    return lq_conductor_reflectance(cos_i, n, kappa);
}

void lq_fresnel_conductors(double cos_i, size_t count, const double *n, const double *kappa,
                           double *reflectance) {
    lq_microfacet_kernels_get()->conductors(cos_i, count, n, kappa, reflectance);
}

/* Distance of the complex angle acos(z) to [0, pi/2], and the nearest point there. */
static lq_fresnel_singularity nearest_angle(double complex z) {
    const double complex theta = cacos(z);
    lq_fresnel_singularity found;
    found.angle = fmin(fmax(creal(theta), 0.0), 1.5707963267948966);
    found.distance = hypot(cimag(theta), creal(theta) - found.angle);
    return found;
}

void lq_fresnel_singularities(double n, double kappa, lq_fresnel_singularity found[2]) {
    const double complex eps_minus_1 = __builtin_complex((n - 1.0) * (n + 1.0) - kappa * kappa,
                                                         2.0 * n * kappa); /* CMPLX, where clang has none */
    const double complex eps_plus_1 = eps_minus_1 + 2.0;
    found[0] = nearest_angle(csqrt(-eps_minus_1));
    found[1] = nearest_angle(eps_plus_1 != 0.0 ? -1.0 / csqrt(eps_plus_1) : -2.0);
}
