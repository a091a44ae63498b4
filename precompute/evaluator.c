/* The list of evaluators, and what every computation checks before it starts. */
#include "precompute/evaluator.h"

#include "precompute/kinds.h"
#include "system/status.h"
#include "tables/settings.h"

#include <math.h>
#include <string.h>

const lq_evaluator *lq_evaluator_find(const char *id) {
    static const lq_evaluator *const all[] = {&lq_evaluate_fgd,
                                              &lq_evaluate_albedo,
                                              &lq_evaluate_albedo_average,
                                              &lq_evaluate_dfg,
                                              &lq_evaluate_tir_pass,
                                              &lq_evaluate_tir_loss,
                                              &lq_evaluate_fgd_dielectric,
                                              &lq_evaluate_transmission,
                                              &lq_evaluate_diffuse_transmission,
                                              &lq_evaluate_diffuse_reflection,
                                              &lq_evaluate_variance,
                                              &lq_evaluate_coated_lambertian};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (strcmp(all[i]->id, id) == 0) return all[i];
    return NULL;
}

size_t lq_slice_entries(const lq_job *job, const lq_evaluator *evaluator) {
    size_t entries = 1;
    for (int a = 0; a < job->kind->axis_count; a++)
        if (a != evaluator->slice_axis) entries *= job->size[a];
    return entries;
}

static lq_status check_nodes(const lq_job *job, lq_error *error) {
    for (int a = 0; a < job->kind->axis_count; a++) {
        const lq_axis_info *axis = &job->kind->axes[a];
        for (size_t i = 0; i < job->size[a]; i++) {
            const double x = job->nodes[a][i];
            if (!(x >= axis->lowest && x <= axis->highest))
                return lq_fail(error, LQ_BAD_INPUT, "%s = %g is out of range; accepted: %g to %g (%s)",
                               axis->name, x, axis->lowest, axis->highest, axis->meaning);
        }
    }
    return LQ_OK;
}

static lq_status choose_ndf(lq_job *job, const lq_settings *settings, lq_error *error) {
    job->ndf = settings->opened;
    if (job->ndf) return LQ_OK;
    const lq_status status = lq_ndf_open(&job->ndf, settings->ndf, error);
    job->own = job->ndf;
    return status;
}

/* Every kind is sliced along its roughness: it is what a solve cannot share. */
lq_status lq_job_prepare(const lq_job *job, const lq_evaluator *evaluator, size_t index, lq_error *error) {
    return lq_ndf_prepare(job->ndf, job->nodes[evaluator->slice_axis][index], error);
}

/* The roughness of a kind, along which it is sliced, over what the NDF has of it. */
static lq_status clip_roughness(const lq_kind *kind, const lq_ndf *ndf, lq_axis *axes, lq_error *error) {
    const int axis = lq_evaluator_find(kind->id)->slice_axis;
    const lq_axis_info *info = &kind->axes[axis];
    double low, high;
    lq_ndf_range(ndf, &low, &high);
    if (low <= info->min && high >= info->max) return LQ_OK;
    lq_axis_free(&axes[axis]);
    return lq_axis_make(&axes[axis], info->name, fmax(low, info->min), fmin(high, info->max),
                        low == high ? 1 : info->size, info->map, 0.0, error);
}

lq_status lq_settings_axes(const lq_kind *kind, const lq_settings *settings, lq_axis *axes, lq_error *error) {
    const lq_ndf *own = NULL;
    lq_status status = settings->opened ? LQ_OK : lq_ndf_open(&own, settings->ndf, error);
    if (status != LQ_OK) return status;
    status = lq_kind_axes(kind, axes, error);
    if (status == LQ_OK) {
        status = clip_roughness(kind, own ? own : settings->opened, axes, error);
        for (int a = 0; status != LQ_OK && a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    }
    lq_ndf_close(own);
    return status;
}

static lq_status check_roughness(const lq_job *job, lq_error *error) {
    const int axis = lq_evaluator_find(job->kind->id)->slice_axis;
    for (size_t i = 0; i < job->size[axis]; i++) {
        const lq_status status = lq_ndf_check(job->ndf, job->nodes[axis][i], error);
        if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

void lq_job_free(lq_job *job) {
    lq_ndf_close(job->own);
}

static lq_status check_options(const lq_kind *kind, const lq_settings *settings, lq_error *error) {
    const lq_settings plain = lq_settings_default();
    if (!(kind->takes & LQ_TAKES_SCATTERING) && settings->scattering != plain.scattering)
        return lq_fail(error, LQ_BAD_INPUT, "%s takes no scattering option", kind->id);
    if (!(kind->takes & LQ_TAKES_MASKING) && settings->masking != plain.masking)
        return lq_fail(error, LQ_BAD_INPUT, "%s takes no masking option", kind->id);
    if ((kind->takes & LQ_TAKES_SCATTERING) && settings->scattering == LQ_MULTIPLE &&
        settings->masking == LQ_SEPARABLE)
        return lq_fail(error, LQ_BAD_INPUT,
                       "separable masking has no multiple scattering; accepted: correlated, or single "
                       "scattering");
    return LQ_OK;
}

static lq_status choose_tolerance(lq_job *job, double asked, lq_error *error) {
    job->tolerance = asked > 0.0 ? asked : job->kind->tolerance;
    if (!(asked >= 0.0) || job->tolerance < job->kind->finest_tolerance ||
        job->tolerance > LQ_LOOSEST_TOLERANCE)
        return lq_fail(error, LQ_BAD_INPUT, "tolerance %g cannot be asked of %s; accepted: %g to %g", asked,
                       job->kind->id, job->kind->finest_tolerance, LQ_LOOSEST_TOLERANCE);
    return LQ_OK;
}

lq_status lq_job_make(lq_job *job, const lq_kind *kind, const lq_settings *given, const size_t *size,
                      const double *const *nodes, lq_error *error) {
    lq_settings read;
    const lq_settings *settings = &read;
    *job = (lq_job){.kind = kind};
    lq_status status = lq_settings_read(&read, given, error);
    if (status != LQ_OK) return status;
    *job = (lq_job){.kind = kind, .scattering = settings->scattering, .masking = settings->masking};
    for (int a = 0; a < kind->axis_count; a++) {
        job->size[a] = size[a];
        job->nodes[a] = nodes[a];
    }
    status = check_options(kind, settings, error);
    if (status == LQ_OK) status = choose_ndf(job, settings, error);
    if (status == LQ_OK) status = choose_tolerance(job, settings->tolerance, error);
    if (status == LQ_OK) status = check_nodes(job, error);
    if (status == LQ_OK) status = check_roughness(job, error);
    if (status != LQ_OK) lq_job_free(job);
    return status;
}
