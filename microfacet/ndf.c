/* The built-in NDFs and Smith's relations between their projected areas. */
#include "microfacet/ndf.h"

#include "microfacet/ggx.h"

#include <math.h>
#include <string.h>

static const lq_ndf *const builtin[] = {&lq_ggx};

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
