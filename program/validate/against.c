/* against.c - `lacquer validate --against FILE`: one stored or published table by another. */
#include "program/validate/against.h"

#include "program/message.h"
#include "program/output.h"
#include "program/verb.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ======================================================================================
 *                                         Files
 * ====================================================================================== */

static lq_status read_published(lq_table **table, const char *path, const validate_request *request,
                                lq_error *error) {
    return lq_published_read(table, path, (lq_layout)request->layout, request->kind, error);
}

/* A published FILE does not say how it was made: the options do, and what its layout is meant for. */
static lq_status assume_origin(against_job *job, lq_error *error) {
    job->origin.kind = lq_kind_find(job->request->kind, error);
    if (!job->origin.kind) return LQ_BAD_INPUT;
    job->origin.settings = job->request->settings.settings;
    const char *masking = lq_table_fact(job->other, "masking");
    if (masking && strcmp(masking, "separable") == 0) job->origin.settings.masking = LQ_SEPARABLE;
    if (job->origin.settings.tolerance == 0.0) job->origin.settings.tolerance = job->origin.kind->tolerance;
    return LQ_OK;
}

static lq_status same_kind(const against_job *job, lq_error *error) {
    const char *id = lq_table_fact(job->other, "table");
    if (id && strcmp(id, job->origin.kind->id) == 0 &&
        job->other->axis_count == job->origin.kind->axis_count &&
        job->other->channel_count == job->origin.kind->channel_count)
        return LQ_OK;
    snprintf(error->text, sizeof error->text, "%.200s is '%.32s', not '%s'", job->other_name,
             id ? id : "unknown", job->origin.kind->id);
    return LQ_BAD_INPUT;
}

/* An older file may state its tolerance or not. */
static double stated_tolerance(const lq_table *table) {
    const char *text = lq_table_fact(table, "tolerance");
    const double tolerance = text ? strtod(text, NULL) : 0.0;
    return tolerance > 0.0 && tolerance < 1.0 ? tolerance : 0.0;
}

/* Two values in float32 besides. */
static const double rounding = 6e-8;

static lq_status load(against_job *job, lq_error *error) {
    const validate_request *request = job->request;
    lq_status status;
    if (request->axes || request->diagnose) {
        job->other_name = request->file;
        if (request->diagnose)
            status = validate_load_file(request->file, &request->trust, &job->other, &job->origin, error);
        else status = lq_table_read_described(&job->other, request->file, request->axes, error);
        if (status == LQ_OK && request->axes)
            status = lq_origin_of(job->other, &request->trust, &job->origin, error);
    } else if (!request->other) {
        job->other_name = request->file;
        status = read_published(&job->other, request->file, request, error);
        if (status == LQ_OK) status = assume_origin(job, error);
    } else {
        job->other_name = request->other;
        status = validate_load_file(request->file, &request->trust, &job->file, &job->origin, error);
        if (status == LQ_OK)
            status = request->layout >= 0 ? read_published(&job->other, request->other, request, error)
                                          : lq_table_read_exr(&job->other, request->other, error);
    }
    if (status == LQ_OK) status = same_kind(job, error);
    if (status != LQ_OK) return status;
    job->origin.settings.threads = (int)request->threads;
    job->allowance = job->origin.settings.tolerance + rounding;
    if (request->other) job->allowance += stated_tolerance(job->other);
    return LQ_OK;
}

/* ======================================================================================
 *                                      Comparison
 * ====================================================================================== */

static bool same_nodes(const lq_table *a, const lq_table *b) {
    for (int k = 0; k < a->axis_count; k++) {
        const lq_axis *x = &a->axes[k], *y = &b->axes[k];
        if (x->size != y->size || strcmp(x->name, y->name) != 0) return false;
        for (size_t i = 0; i < x->size; i++)
            if (!(fabs(x->nodes[i] - y->nodes[i]) <= 1e-6 * (1.0 + fabs(x->nodes[i])))) return false;
    }
    return true;
}

static lq_drawn entry_at(const lq_table *table, size_t entry) {
    lq_drawn drawn = {.entry = entry};
    for (int a = 0; a < table->axis_count; a++) {
        drawn.index[a] = entry % table->axes[a].size;
        drawn.at[a] = table->axes[a].nodes[drawn.index[a]];
        entry /= table->axes[a].size;
    }
    return drawn;
}

static lq_status finish(against_job *job, int channel, const lq_compared *pairs, const lq_drawn *drawn,
                        lq_error *error) {
    lq_comparison *r = &job->result[channel];
    const lq_status status =
        lq_compare(pairs, job->entries, job->entries * (size_t)job->other->channel_count, r, error);
    if (status != LQ_OK) return status;
    job->worst_pair[channel] = pairs[r->worst];
    job->worst_at[channel] = drawn ? drawn[r->worst] : entry_at(job->other, r->worst);
    return LQ_OK;
}

static lq_status out_of_memory(size_t entries, lq_error *error) {
    snprintf(error->text, sizeof error->text, "no memory to compare %zu entries", entries);
    return LQ_NO_MEMORY;
}

/* All entries, neighbours included. */
static lq_status compare_all(against_job *job, const lq_table *reference, lq_error *error) {
    const size_t count = job->entries = lq_table_entries(job->other);
    lq_compared *pairs = malloc(count * sizeof *pairs);
    if (!pairs) return out_of_memory(count, error);
    lq_status status = LQ_OK;
    job->patterned = true;
    for (int c = 0; status == LQ_OK && c < job->other->channel_count; c++) {
        for (size_t i = 0; i < count; i++)
            pairs[i] = (lq_compared){(double)job->other->channels[c][i], (double)reference->channels[c][i],
                                     job->allowance, 0.0};
        status = finish(job, c, pairs, NULL, error);
        if (status == LQ_OK)
            status = lq_pattern_of(job->other, reference, c, job->allowance, &job->pattern[c], error);
    }
    free(pairs);
    return status;
}

/* What is computed, is computed to a tenth of the tolerance that it judges. */
static lq_settings judging(const against_job *job) {
    lq_settings settings = job->origin.settings;
    settings.tolerance = fmax(0.1 * settings.tolerance, job->origin.kind->finest_tolerance);
    return settings;
}

/* One drawn entry; values of FILE where it has it, else computed. */
static lq_status value_at(const against_job *job, bool stored, const lq_drawn *drawn, double *values,
                          lq_error *error) {
    double estimate;
    for (int c = 0; stored && c < job->other->channel_count; c++)
        values[c] = (double)job->file->channels[c][drawn->entry];
    if (stored) return LQ_OK;
    const lq_settings settings = judging(job);
    const lq_status status = lq_eval(job->origin.kind, &settings, drawn->at, values, &estimate, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

static lq_status fill_pairs(const against_job *job, bool stored, lq_drawn *drawn, lq_compared *pairs,
                            const lq_progress *progress, lq_error *error) {
    const size_t count = job->entries;
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < count; i++) {
        double values[LQ_MAX_CHANNELS];
        drawn[i] = lq_draw_entry(job->other->axes, job->other->axis_count, job->request->seed, i);
        status = value_at(job, stored, &drawn[i], values, error);
        for (int c = 0; status == LQ_OK && c < job->other->channel_count; c++)
            pairs[(size_t)c * count + i] = (lq_compared){(double)job->other->channels[c][drawn[i].entry],
                                                         values[c], job->allowance, 0.0};
        if (status == LQ_OK && !progress->report(progress->user, (double)(i + 1) / (double)count))
            status = lq_fail(error, LQ_CANCELLED, "cancelled");
    }
    return status;
}

/* Entries drawn at random: their neighbours are unknown. */
static lq_status compare_drawn(against_job *job, bool stored, const lq_progress *progress, lq_error *error) {
    const size_t count = job->entries = job->request->points;
    const size_t channels = (size_t)job->other->channel_count;
    lq_drawn *drawn = malloc(count * sizeof *drawn);
    lq_compared *pairs = malloc(channels * count * sizeof *pairs);
    lq_status status = drawn && pairs ? LQ_OK : out_of_memory(count, error);
    if (status == LQ_OK) status = fill_pairs(job, stored, drawn, pairs, progress, error);
    for (size_t c = 0; status == LQ_OK && c < channels; c++)
        status = finish(job, (int)c, pairs + c * count, drawn, error);
    free(pairs);
    free(drawn);
    return status;
}

static lq_status measure(against_job *job, const lq_progress *progress, lq_error *error) {
    const bool stored = job->file && same_nodes(job->file, job->other);
    if (job->request->points_given) return compare_drawn(job, stored, progress, error);
    if (stored) return compare_all(job, job->file, error);
    const lq_settings settings = judging(job);
    const lq_status status =
        lq_precompute(job->origin.kind, &settings, job->other->axes, progress, &job->computed, error);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
    return compare_all(job, job->computed, error);
}

/* ======================================================================================
 *                                        The call
 * ====================================================================================== */

const char *against_complaint(const against_job *job) {
    double worst = 0.0;
    bool explained = true;
    for (int c = 0; c < job->other->channel_count; c++) {
        const lq_verdict verdict = job->pattern[c].verdict;
        worst = fmax(worst, job->result[c].max);
        explained = explained && (job->patterned ? verdict == LQ_AGREES || verdict == LQ_NOISE
                                                 : job->result[c].max <= job->allowance);
    }
    if (job->request->budget > 0.0)
        return worst <= job->request->budget ? NULL : "the difference exceeds the budget";
    return explained ? NULL : "neither the stated tolerances nor independent noise explain the difference";
}

/* Something is wrong: is it another definition? */
static lq_status diagnose(against_job *job, const lq_progress *progress, lq_error *error) {
    bool agree = job->patterned;
    for (int c = 0; c < job->other->channel_count; c++)
        agree = agree && (job->pattern[c].verdict == LQ_AGREES || job->pattern[c].verdict == LQ_SPOTS);
    if (agree || (!job->patterned && !against_complaint(job))) return LQ_OK;
    return lq_variants_try(job->other, job->origin.kind, &job->origin.settings, progress, &job->variants,
                           error);
}

static int report(const against_job *job) {
    if (!job->request->json) against_print_text(job);
    else if (!against_print_json(job)) return CLI_FAILED;
    return against_complaint(job) ? CLI_EXCEEDED : CLI_DONE;
}

/* Of a published FILE alone the options say how it was made; its kind must listen to them. */
static bool settings_suit(const validate_request *request) {
    const bool alone = !request->other && !request->axes && !request->diagnose;
    const lq_kind *kind = alone ? lq_kind_find(request->kind, NULL) : NULL;
    return !kind || cli_settings_suit(&request->given, kind);
}

int validate_against(const validate_request *request) {
    if (!settings_suit(request)) return CLI_FAILED;
    against_job *job = calloc(1, sizeof *job);
    if (!job) return cli_fail("out of memory");
    job->request = request;
    lq_error error = {""};
    lq_status status = load(job, &error);
    if (status == LQ_OK) {
        cli_progress bar;
        cli_progress_begin(&bar, job->origin.kind->id);
        status = measure(job, &bar.progress, &error);
        if (status == LQ_OK) status = diagnose(job, &bar.progress, &error);
        cli_progress_end(&bar);
    }
    const int code = status == LQ_OK ? report(job) : cli_fail_status(status, &error);
    lq_table_free(job->file);
    lq_table_free(job->other);
    lq_table_free(job->computed);
    free(job);
    return code;
}
