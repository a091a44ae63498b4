/* certificate_material.c - the judgement of a material: its norms within their bounds. */
#include "validate/certificate_material.h"

#include <math.h>
#include <stdio.h>

#include "system/number.h"

lq_check lq_material_check(const lq_certified_material *material, lq_norm norm) {
    const double values[LQ_NORMS] = {[LQ_NORM_MAX] = material->measure.max,
                                     [LQ_NORM_P99] = material->measure.p99,
                                     [LQ_NORM_RMS] = material->measure.rms};
    const double bound = material->budget.bound[norm];
    const bool bounded = bound > 0.0 && isfinite(bound);
    lq_check check = {.value = values[norm], .limit = bounded ? bound : NAN};
    char at[160];
    check.outcome = !bounded ? LQ_NOTED : values[norm] <= bound ? LQ_PASSED : LQ_FAILED;
    snprintf(check.name, sizeof check.name, "budget %s", lq_norm_name(norm));
    lq_material_worst(material, at, sizeof at);
    if (norm == LQ_NORM_MAX) snprintf(check.detail, sizeof check.detail, "at %s", at);
    return check;
}

const char *lq_material_failure(const lq_certified_material *material) {
    for (int n = 0; n < LQ_MATERIAL_NORMS; n++)
        if (lq_material_check(material, (lq_norm)n).outcome == LQ_FAILED) return lq_norm_name((lq_norm)n);
    return NULL;
}

void lq_material_worst(const lq_certified_material *material, char *text, size_t size) {
    size_t used = (size_t)lq_print(text, size, "mu=%.3g", material->measure.worst[0]);
    for (int r = 0; r < material->range_count && used < size; r++)
        used += (size_t)lq_print(text + used, size - used, " %s=%.3g", material->ranges[r],
                                 material->measure.worst[1 + r]);
}
