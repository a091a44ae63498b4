/* shape_lobe.c - GGX from differences of directions, so that a narrow lobe keeps its digits. */
#include "stack/shape_lobe.h"

#include <math.h>

#include "system/status.h"

/* Of an albedo: what sums over cells show is more. */
static const double ENOUGH = 1e-5;
static const double PI = 3.14159265358979323846;

lq_incidence lq_incidence_of(double mu) {
    const double cosine = fmin(fmax(mu, LQ_SHAPE_LEAST_MU), 1.0);
    return (lq_incidence){cosine, sqrt((1.0 - cosine) * (1.0 + cosine))};
}

double lq_lobe_density(lq_incidence from, double alpha, double x, double y, double z) {
    const double a2 = alpha * alpha, in = from.cosine, along = x - from.sine, up = z + in;
    const double tan2 = (along * along + y * y) / (up * up), widened = a2 + tan2;
    const double d = a2 * (1.0 + tan2) * (1.0 + tan2) / (PI * widened * widened);
    const double si = sqrt(a2 + (1.0 - a2) * in * in), so = sqrt(a2 + (1.0 - a2) * z * z);
    return d * z / (2.0 * (z * si + in * so));
}

/* Slopes stretched by each roughness; masking by the roughness in the direction of travel (docs/theory.md).
 */
double lq_lobe_turned_density(lq_incidence from, const lq_turned_ggx *ggx, double x, double y, double z) {
    const double in = from.cosine, dx = x - from.sine, up = z + in, c = ggx->cosine, s = ggx->sine;
    const double hx = (dx * c + y * s) / (up * ggx->x), hy = (y * c - dx * s) / (up * ggx->y);
    const double tan2 = (dx * dx + y * y) / (up * up), stretched = 1.0 + hx * hx + hy * hy;
    const double d = (1.0 + tan2) * (1.0 + tan2) / (PI * ggx->x * ggx->y * stretched * stretched);
    const double ix = ggx->x * from.sine * c, iy = ggx->y * from.sine * s;
    const double ox = ggx->x * (x * c + y * s), oy = ggx->y * (y * c - x * s);
    const double si = sqrt(in * in + ix * ix + iy * iy), so = sqrt(z * z + ox * ox + oy * oy);
    return d * z / (2.0 * (z * si + in * so));
}

lq_status lq_lobe_albedo(double mu, double alpha, double *value, lq_error *error) {
    const lq_kind *kind = lq_kind_find("albedo", error);
    lq_settings settings = lq_settings_default();
    double estimate;
    settings.tolerance = ENOUGH;
    if (!kind) return LQ_BAD_INPUT;
    const lq_status status = lq_eval(kind, &settings, (double[]){mu, alpha}, value, &estimate, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* cos 2 theta_d is the cosine between both directions. */
double lq_incidence_half(lq_incidence from, double x, double z) {
    return sqrt(fmin(fmax(0.5 * (1.0 - from.sine * x + from.cosine * z), 0.0), 1.0));
}
