/* Fresnel reflectance, in forms that do not cancel when the two media are nearly alike.
 *
 * With eps the squared relative index, c the cosine of incidence and w = sqrt(eps - 1 + c^2):
 *     r_s = (c - w)/(c + w)         = (1 - eps) / (c + w)^2
 *     r_p = (eps c - w)/(eps c + w) = (eps - 1) ((eps + 1) c^2 - 1) / (eps c + w)^2
 * The right-hand forms follow from multiplying by the conjugate sum; eps - 1 is formed from the
 * index as (n - 1)(n + 1), so that eta -> 1 keeps full relative accuracy.
 */
#include "microfacet/fresnel.h"

#include <complex.h>
#include <math.h>
#include <stddef.h>

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

static double squared_modulus(double complex z) {
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

double lq_fresnel_conductor(double cos_i, double n, double kappa) {
    if (kappa == 0.0 && n > 0.0) return lq_fresnel_dielectric(cos_i, n, NULL);
    const double complex eps = CMPLX((n - kappa) * (n + kappa), 2.0 * n * kappa);
    /* eps = 0 and eps < 0 real reflect everything; a grazing ray is reflected by any material. */
    if (n == 0.0 || cos_i <= 0.0) return 1.0;
    const double complex eps_minus_1 = CMPLX((n - 1.0) * (n + 1.0) - kappa * kappa, 2.0 * n * kappa);
    const double c2 = cos_i * cos_i;
    const double complex w = csqrt(eps_minus_1 + c2);
    const double s = squared_modulus(cos_i + w);
    const double p = squared_modulus(eps * cos_i + w);
    const double e = squared_modulus(eps_minus_1);
    const double r_s = e / (s * s);
    const double r_p = e * squared_modulus((eps + 1.0) * c2 - 1.0) / (p * p);
    return fmin(0.5 * (r_s + r_p), 1.0);
}

void lq_fresnel_branch(double n, double kappa, double *angle, double *distance) {
    const double complex one_minus_eps = CMPLX((1.0 - n) * (1.0 + n) + kappa * kappa, -2.0 * n * kappa);
    const double complex theta = cacos(csqrt(one_minus_eps));
    *angle = fmin(fmax(creal(theta), 0.0), 1.5707963267948966);
    const double outside = creal(theta) - *angle;
    *distance = hypot(cimag(theta), outside);
}
