/* layered.c - `lacquer validate layered`: models of layered materials on a set of stacks, stack by stack.
 * What is finished is kept in the report's folder with its settings, and taken up where these are the same.
 */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "pack/contents.h"
#include "pack/model_source.h"
#include "program/beside.h"
#include "program/crew.h"
#include "program/message.h"
#include "program/validate/validate.h"
#include "system/claims.h"
#include "system/output.h"
#include "system/status.h"
#include "validate/layered.h"

static const char *const places[] = {"/../share/lacquer/recipes/layered", "/../../recipes/layered"};

typedef struct layered_job {
    const validate_request *request;
    lq_layered_set set;
    lq_layered_model models[LQ_LAYERED_MODELS];
    lq_layered_request asked;
    lq_pack pack;
    lq_model_source source;
    char source_sum[9];
    json_t *figures;
    size_t kept, done;
    const char *current;
    cli_progress bar;
    lq_progress part; /* of one stack, within all of them */
} layered_job;

/* ======================================================================================
 *                                     What is asked
 * ====================================================================================== */

static lq_status open_set(layered_job *job, lq_error *error) {
    char folder[PATH_MAX] = "", path[PATH_MAX + 80];
    const char *named = job->request->set ? job->request->set : "ba19";
    if (strchr(named, '/') || strchr(named, '.')) return lq_layered_set_read(&job->set, named, error);
    if (cli_beside(places, 2, R_OK | X_OK, folder, sizeof folder)) {
        snprintf(path, sizeof path, "%s/%.60s.json", folder, named);
        if (access(path, R_OK) == 0) return lq_layered_set_read(&job->set, path, error);
    }
    return lq_fail(error, LQ_BAD_INPUT,
                   "no set '%.60s'; accepted: ba19, b18, d22, or a JSON file (with a . or / in its name)",
                   named);
}

static lq_status add_model(layered_job *job, const char *label, lq_error *error) {
    if (job->asked.model_count == LQ_LAYERED_MODELS) {
        return lq_fail(error, LQ_BAD_INPUT, "--model: more than %d models", LQ_LAYERED_MODELS);
    }
    for (size_t i = 0; i < job->asked.model_count; i++)
        if (strcmp(job->models[i].label, label) == 0) {
            return lq_fail(error, LQ_BAD_INPUT, "--model: '%.40s' twice", label);
        }
    const lq_status status = lq_layered_model_parse(&job->models[job->asked.model_count], label, error);
    job->asked.model_count += status == LQ_OK;
    return status;
}

/* Those named; otherwise all there are, as they are by default. */
static lq_status open_models(layered_job *job, lq_error *error) {
    const char *at = job->request->models;
    lq_status status = LQ_OK;
    for (int i = 0; !at && i < LQ_MODELS && status == LQ_OK; i++)
        status = add_model(job, lq_model_names[i], error);
    while (at && status == LQ_OK) {
        char label[80];
        const size_t length = strcspn(at, ",");
        snprintf(label, sizeof label, "%.*s", (int)(length < 79 ? length : 79), at);
        status = add_model(job, label, error);
        at = at[length] ? at + length + 1 : NULL;
    }
    return status;
}

/* A pack is known by its manifest, which has the checksums of its files. */
static lq_status open_tables(layered_job *job, lq_error *error) {
    const char *folder = job->request->tables;
    bool wanted = false;
    for (size_t i = 0; i < job->asked.model_count; i++) wanted |= job->models[i].tables;
    if (wanted != (folder != NULL)) {
        return lq_fail(error, LQ_BAD_INPUT, "%s",
                       folder ? "--tables has no effect where no model is named with +tables"
                              : "--model: '+tables' of which pack? accepted: with --tables DIR");
    }
    if (!folder) return LQ_OK;
    const lq_status status = lq_pack_read(&job->pack, folder, error);
    if (status != LQ_OK) return status;
    if (!lq_contents_checksum(folder, "manifest.json", job->source_sum)) {
        return lq_fail(error, LQ_IO, "%.300s: its manifest cannot be read", folder);
    }
    job->source = lq_pack_source(&job->pack);
    job->asked.source = &job->source;
    job->asked.source_sum = job->source_sum;
    return LQ_OK;
}

static lq_status open_folders(const layered_job *job, lq_error *error) {
    static const char *const below[] = {"", "/finished", "/slices"};
    char path[PATH_MAX];
    lq_status status = LQ_OK;
    for (int i = 0; i < 3 && status == LQ_OK; i++) {
        if (snprintf(path, sizeof path, "%s%s", job->asked.folder, below[i]) >= 4000) {
            return lq_fail(error, LQ_BAD_INPUT, "the name of the report's folder is too long");
        }
        status = lq_output_folder(path, error);
    }
    return status;
}

static lq_status prepare(layered_job *job, lq_error *error) {
    const validate_request *request = job->request;
    job->asked = (lq_layered_request){.set = &job->set,
                                      .models = job->models,
                                      .samples = request->samples,
                                      .seed = request->seed,
                                      .threads = (int)request->threads,
                                      .folder = request->certify.report};
    if (!request->certify.report) {
        return lq_fail(error, LQ_BAD_INPUT,
                       "no folder; usage: lacquer validate layered --report DIR [--set SET]");
    }
    lq_status status = open_set(job, error);
    if (status == LQ_OK) status = open_models(job, error);
    if (status == LQ_OK) status = open_tables(job, error);
    if (status == LQ_OK) status = open_folders(job, error);
    return status;
}

/* ======================================================================================
 *                                   Stack by stack
 * ====================================================================================== */

static bool report_part(void *user, double fraction) {
    layered_job *job = user;
    const double all = (double)job->set.count;
    return job->bar.progress.report(job->bar.progress.user, ((double)job->done + fraction) / all);
}

static void name_of(const layered_job *job, const lq_layered_stack *stack, char *path, size_t size) {
    snprintf(path, size, "%.4000s/finished/%s-%s.json", job->asked.folder, job->set.name, stack->stack->name);
}

/* NULL: there are none, or they are of other settings. */
static json_t *take_finished(layered_job *job, const lq_layered_stack *stack) {
    char path[5000];
    json_t *figures = NULL, *settings = lq_layered_settings(&job->asked, stack);
    name_of(job, stack, path, sizeof path);
    const bool there = access(path, R_OK) == 0 && lq_json_read(&figures, path, NULL) == LQ_OK;
    const bool fits = there && lq_layered_fits(figures, settings);
    json_decref(settings);
    if (fits) return figures;
    if (there) json_decref(figures);
    return NULL;
}

/* As text, and read from it: figures that were kept and those made now are alike to the last bit. */
static lq_status keep(const layered_job *job, const lq_layered_stack *stack, json_t **figures,
                      lq_error *error) {
    char path[5000];
    char *text = lq_json_dump(*figures, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
    *figures = NULL;
    name_of(job, stack, path, sizeof path);
    if (!text) {
        return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    }
    lq_status status = lq_output_save(path, text, strlen(text), error);
    if (status == LQ_OK) status = lq_json_parse(figures, path, text, strlen(text), error);
    free(text);
    return status;
}

static lq_status run_stack(layered_job *job, size_t i, lq_error *error) {
    const lq_layered_stack *stack = &job->set.stacks[i];
    json_t *figures = take_finished(job, stack);
    lq_status status = LQ_OK;
    job->kept += figures != NULL;
    if (!figures) {
        status = lq_layered_measure(&job->asked, stack, &figures, &job->part, error);
        if (status == LQ_OK) status = keep(job, stack, &figures, error);
    }
    if (status == LQ_OK) lq_json_append(&job->figures, figures);
    else json_decref(figures);
    job->done = i + 1;
    return status;
}

/* Each stack by one of several processes; they are all finished when all have met. */
static lq_status share_out(layered_job *job, lq_error *error) {
    const lq_crew *crew = cli_crew();
    char folder[5000];
    snprintf(folder, sizeof folder, "%.4000s/finished", job->asked.folder);
    if (cli_leads()) lq_claims_clear(folder);
    lq_status status = crew->meet(crew->user, LQ_OK, error);
    for (size_t i = 0; i < job->set.count && status == LQ_OK; i++)
        if (lq_claim(folder, crew, i)) status = run_stack(job, i, error);
    if (status != LQ_OK) lq_claims_stop(folder, crew);
    status = crew->meet(crew->user, status, error);
    if (cli_leads()) lq_claims_clear(folder);
    json_decref(job->figures);
    job->figures = json_array();
    return status;
}

static lq_status run_all(layered_job *job, lq_error *error) {
    cli_progress_begin(&job->bar, job->set.name);
    job->part = (lq_progress){.report = report_part, .user = job};
    job->figures = json_array();
    lq_status status = cli_crew() ? share_out(job, error) : LQ_OK;
    const size_t count = cli_leads() ? job->set.count : 0; /* the first reads them, and reports */
    for (size_t i = 0; i < count && status == LQ_OK; i++) status = run_stack(job, i, error);
    cli_progress_end(&job->bar);
    return status;
}

int validate_layered(const validate_request *request) {
    layered_job *job = calloc(1, sizeof *job);
    if (!job) return cli_fail("out of memory");
    job->request = request;
    lq_error error = {""};
    lq_status status = prepare(job, &error);
    if (status == LQ_OK) status = run_all(job, &error);
    if (status == LQ_OK && cli_leads()) status = lq_layered_report(&job->asked, job->figures, &error);
    else json_decref(job->figures);
    if (status == LQ_OK && cli_crew())
        printf("%zu stacks of the set %s, by %d processes; %s/index.html\n", job->set.count, job->set.name,
               cli_crew()->size, job->asked.folder);
    else if (status == LQ_OK)
        printf("%zu stacks of the set %s, %zu of them from before; %s/index.html\n", job->set.count,
               job->set.name, job->kept, job->asked.folder);
    const int code = status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
    lq_layered_set_free(&job->set);
    lq_pack_free(&job->pack);
    free(job);
    return code;
}
