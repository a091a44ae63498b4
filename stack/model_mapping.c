/* model_mapping.c - f and its inverse, exact or as B18 fitted it, finite at the pole. */
#include "stack/model_mapping.h"

#include <math.h>

#include "fit/phase.h"
#include "microfacet/lobe.h"

static const double POLE = 1e100, EXPONENT = 1.1;

lq_status lq_model_mapping_make(lq_model_mapping *mapping, lq_model_f f, lq_error *error) {
    lq_error unread = {""};
    mapping->f = f;
    return f == LQ_MODEL_F_EXACT ? lq_curve_make(&mapping->curve, lq_ndf_find("ggx"), error ? error : &unread)
                                 : LQ_OK;
}

double lq_model_variance(const lq_model_mapping *mapping, double alpha) {
    if (alpha >= 1.0) return POLE;
    if (mapping->f == LQ_MODEL_F_EXACT) return fmin(lq_curve_f(&mapping->curve, alpha), POLE);
    const double power = pow(alpha, EXPONENT);
    return fmin(power / (1.0 - power), POLE);
}

double lq_model_phase(const lq_model_mapping *mapping, double g) {
    if (mapping->f == LQ_MODEL_F_B18) return pow((1.0 - g) / g, 0.8) / (1.0 + g);
    return lq_model_variance(mapping, lq_lobe_roughness(mapping->curve.ndf, lq_phase_variance(g, NULL)));
}

double lq_model_roughness(const lq_model_mapping *mapping, double variance) {
    if (!(variance < POLE)) return 1.0;
    if (mapping->f == LQ_MODEL_F_EXACT) return lq_curve_inverse(&mapping->curve, variance);
    return pow(variance / (1.0 + variance), 1.0 / EXPONENT);
}
