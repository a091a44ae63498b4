/* The exact values that a family is fitted to. */
#include "fit/bounce.h"
#include "fit/phase.h"
#include "fit/transmission.h"
#include "microfacet/lobe.h"
#include "program/fit/fit.h"
#include "program/message.h"

#include <math.h>
#include <stdlib.h>

static bool room(fit_job *job, size_t count) {
    job->x = calloc(count * LQ_FAMILY_COORDINATES, sizeof *job->x);
    job->y = calloc(count, sizeof *job->y);
    if (job->x && job->y) return true;
    cli_message("no memory for %zu points", count);
    return false;
}

static void add(fit_job *job, double y, double x0, double x1, double x2, double x3) {
    const double x[LQ_FAMILY_COORDINATES] = {x0, x1, x2, x3};
    for (size_t k = 0; k < LQ_FAMILY_COORDINATES; k++) job->x[job->count * LQ_FAMILY_COORDINATES + k] = x[k];
    job->y[job->count++] = y;
}

/* Logarithmic in alpha, linear in g. */
static double spread(const fit_request *request, size_t i) {
    const double t = (double)i / (double)(request->points - 1);
    if (request->mapping == LQ_MAP_HG) return request->low + t * (request->high - request->low);
    return request->low * pow(request->high / request->low, t);
}

static double value_at(const fit_job *job, double at) {
    double variance;
    switch (job->request.mapping) {
    case LQ_MAP_VARIANCE:
        return lq_curve_f(&job->curve, at);
    case LQ_MAP_HG:
        return lq_curve_f(&job->curve, lq_lobe_roughness(job->ndf, lq_phase_variance(at, NULL)));
    default: {
        const double fourth = lq_lobe_fourth_moment(job->ndf, at, &variance);
        return fourth / (variance * variance);
    }
    }
}

/* Incidences that B18's chain meets: at most a tenth of the facets reflects totally. */
static bool transmit(fit_job *job) {
    static const double etas[] = {1.0 / 2.0, 1.0 / 1.5, 1.0 / 1.33, 1.0 / 1.2, 1.2, 1.33, 1.5, 2.0};
    static const double cosines[] = {1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2};
    enum { ETAS = 8, COSINES = 9, ALPHAS = 8 };
    if (!room(job, ETAS * COSINES * ALPHAS)) return false;
    for (int e = 0; e < ETAS; e++)
        for (int m = 0; m < COSINES; m++)
            for (int a = 0; a < ALPHAS; a++) {
                double ratio, passed;
                const double alpha =
                    job->request.low * pow(job->request.high / job->request.low, a / (ALPHAS - 1.0));
                const double v = lq_transmitted_variance(job->ndf, alpha, etas[e], cosines[m], &passed, NULL);
                lq_transmission_scale(etas[e], cosines[m], &ratio);
                if (passed < 0.9 || !isfinite(ratio)) continue;
                add(job, lq_lobe_roughness(job->ndf, v), alpha, 1.0 / etas[e], cosines[m], ratio);
            }
    return true;
}

bool fit_measure(fit_job *job) {
    const fit_request *request = &job->request;
    lq_error error = {""};
    if (request->mapping == LQ_MAP_VARIANCE || request->mapping == LQ_MAP_HG) {
        const lq_status status = lq_curve_make(&job->curve, job->ndf, &error);
        if (status != LQ_OK) return cli_fail_status(status, &error), false;
    }
    /* The default range ends where f does. */
    if (request->mapping == LQ_MAP_VARIANCE && request->pole_ends_range)
        job->request.high = fmin(request->high, 0.9 * job->curve.pole);
    if (request->mapping == LQ_MAP_TRANSMISSION) return transmit(job);
    if (!room(job, request->points)) return false;
    for (size_t i = 0; i < request->points; i++) {
        const double at = spread(request, i), value = value_at(job, at);
        if (!isfinite(log(value))) {
            cli_message("--range: the %s curve of NDF %s is %g at %g; choose a range without it",
                        lq_mapping_name(request->mapping), lq_ndf_text(job->ndf), value, at);
            return false;
        }
        add(job, value, at, 0.0, 0.0, 0.0);
    }
    return true;
}

fit_errors fit_errors_of(const fit_job *job, int family, const double *p) {
    fit_errors errors = {0};
    for (size_t i = 0; i < job->count; i++) {
        const double *x = job->x + i * LQ_FAMILY_COORDINATES;
        const double off = lq_family_value(family, p, x) / job->y[i] - 1.0;
        errors.rms += off * off / (double)job->count;
        if (fabs(off) <= errors.max) continue;
        errors.max = fabs(off);
        errors.max_at = x[0];
    }
    errors.rms = sqrt(errors.rms);
    return errors;
}
