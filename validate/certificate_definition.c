/* Which definition do the values of a failed table follow? Those of the stored table, or what its factors
 * decode to on a small grid, are compared with every known variant. */
#include "validate/certificate_checks.h"

#include "validate/variants.h"

#include <math.h>
#include <string.h>

/* Nodes of that grid: many along cosines, where definitions differ in shape. */
static size_t grid_size(const char *axis) {
    return strcmp(axis, "mu") == 0 ? 17 : strcmp(axis, "alpha") == 0 ? 9 : 5;
}

static lq_status decode_grid(const lq_certified *certified, lq_table **grid, lq_error *error) {
    const lq_sample_request *r = &certified->certificate.request;
    const lq_stage *last = &r->stages[r->stage_count - 1];
    lq_axis axes[LQ_MAX_AXES] = {{.size = 0}};
    lq_status status = LQ_OK;
    for (int a = 0; status == LQ_OK && a < r->kind->axis_count; a++) {
        const double min = r->domain.min[a], max = r->domain.max[a];
        status = lq_axis_make(&axes[a], r->kind->axes[a].name, min, max,
                              max > min ? grid_size(r->kind->axes[a].name) : 1, LQ_MAP_LINEAR, 1.0, error);
    }
    if (status == LQ_OK)
        status = lq_table_create(grid, axes, r->kind->axis_count, r->kind->channels, r->kind->channel_count,
                                 error);
    for (int a = 0; a < r->kind->axis_count; a++) lq_axis_free(&axes[a]);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < lq_table_entries(*grid); i++) {
        double x[LQ_MAX_AXES] = {0.0};
        size_t left = i;
        for (int a = 0; a < r->kind->axis_count; a++) {
            const lq_axis *axis = &(*grid)->axes[a];
            x[a] = axis->nodes[left % axis->size];
            left /= axis->size;
        }
        for (int c = 0; c < r->kind->channel_count; c++)
            (*grid)->channels[c][i] = (float)last->decode(last->subject, c, x);
    }
    return LQ_OK;
}

lq_status lq_check_definition(lq_certified *certified, lq_error *error) {
    if (!lq_certified_failure(certified) || certified->subject.curve) return LQ_OK; /* a mapping has none */
    const lq_origin *origin = &certified->subject.origin;
    lq_table *grid = NULL;
    lq_variants variants;
    lq_status status = decode_grid(certified, &grid, error);
    if (status == LQ_OK)
        status = lq_variants_try(grid, origin->kind, &origin->settings, NULL, &variants, error);
    if (status == LQ_OK && variants.other)
        lq_check_add(certified, "looks like", variants.list[0].rms, NAN,
                     "%s: rms %.2e from that, %.2e from what it is said to be (%zu variants tried)",
                     variants.list[0].what, variants.list[0].rms, variants.stated, variants.count);
    lq_table_free(grid);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}
