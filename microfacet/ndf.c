/* The NDFs with every formula closed, and Smith's relations between projected areas. */
#include "microfacet/ndf.h"

#include "microfacet/beckmann.h"
#include "microfacet/ggx.h"
#include "system/status.h"

#include <math.h>
#include <string.h>

static const lq_ndf *const builtin[] = {&lq_ggx, &lq_beckmann};

size_t lq_ndf_builtin_count(void) {
    return sizeof builtin / sizeof builtin[0];
}

const lq_ndf *lq_ndf_builtin(size_t i) {
    return i < lq_ndf_builtin_count() ? builtin[i] : NULL;
}

const lq_ndf *lq_ndf_find(const char *id) {
    for (size_t i = 0; i < lq_ndf_builtin_count(); i++)
        if (strcmp(builtin[i]->id, id) == 0) return builtin[i];
    return NULL;
}

/* Room for an alpha that went through a text or a float32. */
static const double same = 1e-6;

lq_status lq_ndf_check(const lq_ndf *ndf, double alpha, lq_error *error) {
    const double low = ndf->alpha_min * (1.0 - same), high = ndf->alpha_max * (1.0 + same);
    if (ndf->alpha_max > 0.0 && ndf->alpha_min == ndf->alpha_max && !(alpha >= low && alpha <= high))
        return lq_fail(error, LQ_BAD_INPUT, "alpha = %g: NDF '%s' has one roughness, alpha = %.9g", alpha,
                       ndf->id, ndf->alpha_min);
    if (ndf->alpha_max > 0.0 && alpha != 0.0 && !(alpha >= low && alpha <= high))
        return lq_fail(error, LQ_BAD_INPUT,
                       "alpha = %g is out of range of NDF '%s'; accepted: %g to %g, and 0 (smooth)", alpha,
                       ndf->id, ndf->alpha_min, ndf->alpha_max);
    return LQ_OK;
}

lq_status lq_ndf_prepare(const lq_ndf *ndf, double alpha, lq_error *error) {
    const lq_status status = lq_ndf_check(ndf, alpha, error);
    return status == LQ_OK && alpha > 0.0 && ndf->prepare ? ndf->prepare(ndf, alpha, error) : status;
}

double lq_area_above(const lq_ndf *ndf, double alpha, double mu, double sin_theta) {
    return mu + ndf->area_below(ndf, alpha, mu, sin_theta);
}

double lq_lambda(const lq_ndf *ndf, double alpha, double mu) {
    if (alpha == 0.0) return 0.0;
    if (mu <= 0.0) return INFINITY;
    return ndf->area_below(ndf, alpha, mu, lq_sine(mu)) / mu;
}

double lq_sine(double mu) {
    return sqrt(fmax((1.0 - mu) * (1.0 + mu), 0.0));
}
