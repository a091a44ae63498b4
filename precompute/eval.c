/* lq_eval: an evaluator over one point. */
#include "precompute/evaluator.h"
#include "system/status.h"

lq_status lq_eval(const lq_kind *kind, const lq_settings *settings, const double *point, double *values,
                  double *estimate, lq_error *error) {
    const lq_evaluator *evaluator = lq_evaluator_find(kind->id);
    size_t size[LQ_MAX_AXES];
    const double *nodes[LQ_MAX_AXES];
    double *channels[LQ_MAX_CHANNELS];
    for (int a = 0; a < kind->axis_count; a++) {
        size[a] = 1;
        nodes[a] = point + a;
    }
    for (int c = 0; c < kind->channel_count; c++) channels[c] = values + c;
    lq_job job;
    lq_status status = lq_job_make(&job, kind, settings, size, nodes, error);
    if (status != LQ_OK) return status;
    void *state = NULL;
    if (evaluator->prepare) status = evaluator->prepare(&job, &state, error);
    if (status == LQ_OK) status = lq_job_prepare(&job, evaluator, 0, error);
    if (status == LQ_OK) status = evaluator->slice(&job, state, 0, channels, estimate, error);
    if (evaluator->release) evaluator->release(state);
    lq_job_free(&job);
    if (status == LQ_OK && *estimate > job.tolerance)
        return lq_fail(error, LQ_NOT_CONVERGED, "error estimate %.2g is above the tolerance %.2g", *estimate,
                       job.tolerance);
    return status;
}
