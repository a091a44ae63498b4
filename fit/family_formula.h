/* The parametric families, written once: family.c compiles them for double, the C++ file for Ceres' automatic
 * derivatives. No include guard: FAMILY_FUNCTION says what a function begins with, REAL is its number.
 *
 * x[] is the point, p[] the coefficients. */

/* t^b / (1 - t^b): B18 sec. 4.1 with the exponent freed. */
FAMILY_FUNCTION REAL family_rational(const REAL *p, const double *x) {
    const REAL t = exp(p[1] * log(x[0]));
    return p[0] * t / (1.0 - t);
}

/* a (exp(b w^c) - 1)^(2/(c d)), w = u^d / (1 - u^d), u = (1 + e) alpha / (sqrt(alpha) + e). The exponent is 2
 * at 0 and falls slowly from there, as the logarithm of heavy tails makes it; the pole is essential: f grows
 * faster than any power. */
FAMILY_FUNCTION REAL family_exponential(const REAL *p, const double *x) {
    const REAL u = (1.0 + p[4]) * x[0] / (sqrt(x[0]) + p[4]);
    const REAL t = exp(p[3] * log(u));
    const REAL w = exp(p[2] * log(t / (1.0 - t)));
    return p[0] * exp(2.0 / (p[2] * p[3]) * log(expm1(p[1] * w)));
}

/* a ((1 - g) / g)^b / (1 + c g): B18 eq. 21. */
FAMILY_FUNCTION REAL family_phase(const REAL *p, const double *x) {
    return p[0] * exp(p[1] * log((1.0 - x[0]) / x[0])) / (1.0 + p[2] * x[0]);
}

/* a (exp(b w^c) - 1)^(1/(c d)), w = u^d / (1 - u^d), u = (1 + e) h / (1 + e h), h = 1 - g: as h at g = 1, the
 * pole at g = 0. */
FAMILY_FUNCTION REAL family_phase_exponential(const REAL *p, const double *x) {
    const double h = 1.0 - x[0];
    const REAL u = (1.0 + p[4]) * h / (1.0 + p[4] * h);
    const REAL t = exp(p[3] * log(u));
    const REAL w = exp(p[2] * log(t / (1.0 - t)));
    return p[0] * exp(1.0 / (p[2] * p[3]) * log(expm1(p[1] * w)));
}

/* alpha a |1 - b r|, r = eta12 mu_i / mu_t: B18 eq. 10 with both constants freed. x: alpha, eta12, mu_i, r.
 */
FAMILY_FUNCTION REAL family_slope(const REAL *p, const double *x) {
    const REAL s = 1.0 - p[1] * x[3];
    return x[0] * p[0] * (s < 0.0 ? -s : s);
}

/* a |1 - eta12|^b m^c alpha^(1 - d - e (1 - m)), m the cosine in the thinner medium. */
FAMILY_FUNCTION REAL family_powers(const REAL *p, const double *x) {
    const double gap = x[1] < 1.0 ? 1.0 - x[1] : x[1] - 1.0, m = x[1] < 1.0 ? x[2] : x[1] * x[2] / x[3];
    return p[0] * exp(p[1] * log(gap) + p[2] * log(m) + (1.0 - p[3] - p[4] * (1.0 - m)) * log(x[0]));
}

/* Kurtosis a alpha^-b: a tail that falls like a power. */
FAMILY_FUNCTION REAL family_power(const REAL *p, const double *x) {
    return p[0] * exp(-p[1] * log(x[0]));
}

/* a + b (alpha^-c - 1)^d: a at alpha = 1, infinite at 0. */
FAMILY_FUNCTION REAL family_tail(const REAL *p, const double *x) {
    return p[0] + p[1] * exp(p[3] * log(expm1(-p[2] * log(x[0]))));
}

FAMILY_FUNCTION REAL family_of(int family, const REAL *p, const double *x) {
    switch (family) {
    case LQ_FAMILY_RATIONAL:
        return family_rational(p, x);
    case LQ_FAMILY_EXPONENTIAL:
        return family_exponential(p, x);
    case LQ_FAMILY_PHASE:
        return family_phase(p, x);
    case LQ_FAMILY_PHASE_EXPONENTIAL:
        return family_phase_exponential(p, x);
    case LQ_FAMILY_SLOPE:
        return family_slope(p, x);
    case LQ_FAMILY_POWERS:
        return family_powers(p, x);
    case LQ_FAMILY_POWER:
        return family_power(p, x);
    default:
        return family_tail(p, x);
    }
}
