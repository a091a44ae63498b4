/* A certificate from a subject: domain, sample, search, and the list of judgements. */
#include "validate/certificate_checks.h"

#include "precompute/evaluator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void lq_check_budget(lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const double values[LQ_NORMS] = {c->max, c->total.p99, c->total.rms, c->total.mean};
    for (int n = 0; n < LQ_NORMS; n++) {
        const double bound = certified->budget.bound[n];
        char name[40], at[160] = "";
        if (!(bound > 0.0)) continue;
        snprintf(name, sizeof name, "budget %s", lq_norm_name((lq_norm)n));
        if (n == LQ_NORM_MAX) {
            const bool searched = c->found.error >= c->total.max;
            const size_t axes = (size_t)c->request.kind->axis_count;
            lq_point_text(c->request.kind, searched ? c->found.at : c->at + c->total.worst % c->points * axes,
                          at, sizeof at);
            lq_check_add(certified, name, values[n], bound, "at %s", at);
        } else if (n == LQ_NORM_P99) {
            lq_check_add(certified, name, values[n], bound, "%s with 95 %% confidence",
                         c->total.p99_limit <= bound ? "met" : "not settled");
        } else {
            lq_check_add(certified, name, values[n], bound, NULL);
        }
    }
}

/* Of a pack: every container holds the same texels. */
static void check_files(lq_certified *certified) {
    const lq_subject *s = &certified->subject;
    if (s->files == 0) return;
    lq_check_add(certified, "files as made", (double)s->altered, 0.0, "of %zu, by their checksums%s%s",
                 s->files, s->altered ? "; first: " : "", s->altered ? s->suspect : "");
    lq_check_add(certified, "files agree", (double)s->differing, 0.0,
                 "texels that are not the same in all%s%s", s->differing ? "; first in " : "",
                 s->differing ? s->suspect : "");
}

/* ----------------------------------------------------------------------------------- the whole */

/* Kinds whose every value needs a solve get fewer points. */
static size_t choose_points(const lq_judging *options, const lq_kind *kind) {
    if (options->points > 0) return options->points;
    bool shares = false;
    const int slice = lq_block_slice_axis(kind);
    for (int a = 0; a < kind->axis_count; a++) shares |= a != slice;
    return shares ? LQ_CERTIFICATE_POINTS : LQ_CERTIFICATE_SOLVES;
}

/* A fraction of the least bound: the solver's own error must not matter. */
static double choose_tolerance(const lq_judging *options, const lq_kind *kind) {
    double tolerance = 1e-4;
    if (options->tolerance > 0.0) return options->tolerance;
    for (int n = 0; n < LQ_NORMS; n++)
        if (options->rule.budget.bound[n] > 0.0)
            tolerance = fmin(tolerance, 0.05 * options->rule.budget.bound[n]);
    return fmax(tolerance, kind->finest_tolerance);
}

lq_status lq_certified_make(lq_certified *certified, const lq_judging *options, const lq_progress *progress,
                            lq_error *error) {
    const lq_subject *subject = &certified->subject;
    const lq_kind *kind = subject->origin.kind;
    lq_sample_request request = {.kind = kind,
                                 .settings = subject->origin.settings,
                                 .curve = subject->curve,
                                 .relative = subject->relative,
                                 .domain = lq_subject_domain(subject),
                                 .points = choose_points(options, kind),
                                 .starts = LQ_CERTIFICATE_STARTS,
                                 .seed = options->seed,
                                 .threads = options->threads};
    request.stage_count = lq_subject_stages(subject, request.stages);
    request.settings.tolerance = choose_tolerance(options, kind);
    request.settings.threads = options->threads;
    certified->budget = options->rule.budget;
    lq_status status = lq_domain_cut(&request.domain, kind, &options->rule, error);
    if (status == LQ_OK) status = lq_sample(&request, progress, &certified->certificate, error);
    if (status != LQ_OK) return status;
    lq_check_budget(certified);
    check_files(certified);
    lq_check_physics(certified);
    status = lq_check_bands(certified, error);
    if (status == LQ_OK) status = lq_check_texels(certified, error);
    if (status == LQ_OK) status = lq_check_stored(certified, error);
    if (status == LQ_OK) lq_check_sampling(certified);
    return status == LQ_OK ? lq_check_definition(certified, error) : status;
}

void lq_certified_free(lq_certified *certified) {
    lq_sampled_free(&certified->certificate);
    lq_subject_free(&certified->subject);
    free(certified->checks);
    certified->checks = NULL;
    certified->check_count = certified->check_room = 0;
}
