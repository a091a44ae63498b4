/* certify.c - `lacquer validate` with a certificate, of a table, a factor file or a folder of
 * them. */
#include "program/validate/certify.h"

#include "pack/measure.h"
#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/progress.h"
#include "program/validate/materials.h"
#include "validate/certificate_pack.h"
#include "validate/report.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool accept(lq_status status, const lq_error *error) {
    if (status != LQ_OK) cli_message("%s", error->text);
    return status == LQ_OK;
}

bool certify_take_budget(certify_request *request, const char *value) {
    lq_error error = {""};
    request->wanted = request->has_budget = true;
    if (!strchr(value, '=') && access(value, F_OK) == 0)
        return accept(lq_budgets_read(&request->budgets, value, &error), &error);
    request->budgets = (lq_budgets){.count = 1};
    return accept(lq_budget_parse(&request->budgets.rules[0].budget, value, &error), &error);
}

bool certify_take_domain(certify_request *request, const char *value) {
    lq_error error = {""};
    return accept(lq_ranges_parse(&request->domain, value, &error), &error);
}

/* The rule for one table; --on goes before the file's ranges. */
static lq_rule rule_for(const certify_request *request, const char *name, const char *kind) {
    lq_rule rule = *lq_budgets_rule(&request->budgets, name, kind);
    if (request->domain.range_count > 0) {
        rule.range_count = request->domain.range_count;
        memcpy(rule.ranges, request->domain.ranges, sizeof rule.ranges);
    }
    return rule;
}

/* The subject is read. `own`: the budget it came with, for where the request has none. */
static lq_status make(const certify_request *request, const lq_rule *own, lq_certified *certified,
                      lq_error *error) {
    const char *kind = certified->subject.origin.kind->id;
    lq_rule rule = rule_for(request, certified->subject.name, kind);
    if (own && !request->has_budget) rule.budget = own->budget;
    if (own && rule.range_count == 0) {
        rule.range_count = own->range_count;
        memcpy(rule.ranges, own->ranges, sizeof rule.ranges);
    }
    const lq_certify_options options = {.rule = rule,
                                        .points = request->points,
                                        .tolerance = request->tolerance,
                                        .seed = request->seed,
                                        .threads = request->threads};
    cli_progress bar;
    cli_progress_begin(&bar, certified->subject.name);
    const lq_status status = lq_certified_make(certified, &options, &bar.progress, error);
    cli_progress_end(&bar);
    return status;
}

static lq_status make_file(const certify_request *request, const char *path, lq_certified *certified,
                           lq_error *error) {
    lq_status status = lq_subject_read(&certified->subject, path, &request->trust, error);
    if (status == LQ_OK && request->table)
        status = certified->subject.factored
                     ? lq_subject_add_table(&certified->subject, request->table, &request->trust, error)
                     : LQ_BAD_INPUT;
    if (status == LQ_BAD_INPUT && !error->text[0])
        snprintf(error->text, sizeof error->text, "--table needs a factor file; '%.200s' is a table", path);
    return status == LQ_OK ? make(request, NULL, certified, error) : status;
}

/* Everything that was asked for, from one list; the exit code. */
static int report(const certify_request *request, const lq_certified *list, size_t count) {
    lq_error error = {""};
    lq_status status = LQ_OK;
    bool failed = false;
    for (size_t i = 0; i < count; i++) {
        if (!request->json) certify_print_text(&list[i]);
        failed |= lq_certified_failure(&list[i]) != NULL;
    }
    if (request->json) {
        char *text = NULL;
        status = lq_report_json(list, count, &text, &error);
        if (status == LQ_OK) printf("%s\n", text);
        free(text);
    }
    if (status == LQ_OK && request->junit) status = lq_report_junit(list, count, request->junit, &error);
    if (status == LQ_OK && request->report) status = lq_report_html(list, count, request->report, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    return failed ? CLI_EXCEEDED : CLI_DONE;
}

/* ======================================================================================
 *                                        Folders
 * ====================================================================================== */

static int is_archive(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return length > 4 && strcmp(entry->d_name + length - 4, ".exr") == 0 && entry->d_name[0] != '.';
}

static bool is_folder(const char *path) {
    struct stat facts;
    return stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
}

/* Every table of the folder, and what they owe each other. */
static lq_status make_folder(const certify_request *request, lq_certified **list, size_t *count,
                             lq_error *error) {
    struct dirent **entries;
    const int found = scandir(request->path, &entries, is_archive, alphasort);
    lq_status status = LQ_OK;
    *list = found > 0 ? calloc((size_t)found, sizeof **list) : NULL;
    if (!*list) {
        snprintf(error->text, sizeof error->text,
                 "no table in the folder '%.300s'; accepted: EXR files of "
                 "lacquer precompute and lacquer pca",
                 request->path);
        status = LQ_BAD_INPUT;
    }
    for (int i = 0; i < found; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", request->path, entries[i]->d_name);
        if (status == LQ_OK) status = make_file(request, path, &(*list)[(*count)++], error);
        free(entries[i]);
    }
    if (found >= 0) free(entries);
    if (status == LQ_OK) lq_check_pack(*list, *count);
    return status;
}

/* What the manifest promises: errors within the budget, for mu, alpha and tau from LQ_MEASURE_FROM up. */
static lq_rule promise(const lq_shipped *shipped) {
    static const char *const bounded[] = {"mu", "alpha", "tau"};
    lq_rule rule = {.range_count = 0};
    if (isfinite(shipped->p99)) rule.budget.bound[LQ_NORM_P99] = shipped->p99;
    if (isfinite(shipped->max)) rule.budget.bound[LQ_NORM_MAX] = shipped->max;
    for (size_t i = 0; i < 3; i++) {
        lq_range *range = &rule.ranges[rule.range_count++];
        *range = (lq_range){.min = LQ_MEASURE_FROM, .max = 1.0};
        snprintf(range->axis, sizeof range->axis, "%s", bounded[i]);
    }
    return rule;
}

/* What the factors of a pack were made from, where they are factors. */
static lq_status make_table(const lq_shipped *shipped, lq_certified *certified, lq_error *error) {
    lq_subject *s = &certified->subject;
    cli_progress bar;
    char label[300];
    if (!s->factored || shipped->axes[0].size == 0) return LQ_OK;
    snprintf(label, sizeof label, "%s, its table", s->name);
    cli_progress_begin(&bar, label);
    const lq_status status = lq_subject_make_table(s, shipped->axes, &bar.progress, error);
    cli_progress_end(&bar);
    return status;
}

/* The materials first: their lines stand above those of the tables. */
static lq_status make_pack(const certify_request *request, lq_certified **list, size_t *count, bool *exceeded,
                           lq_error *error) {
    lq_pack pack;
    lq_status status = lq_pack_read(&pack, request->path, error);
    if (status != LQ_OK) return status;
    status = validate_materials(request, &pack, exceeded, error);
    *list = calloc(pack.count, sizeof **list);
    if (!*list) status = LQ_NO_MEMORY;
    for (size_t i = 0; i < pack.count && status == LQ_OK; i++) {
        const lq_rule own = promise(&pack.tables[i]);
        lq_certified *certified = &(*list)[(*count)++];
        status = lq_subject_ship(&certified->subject, &pack.tables[i], &request->trust, error);
        if (status == LQ_OK && request->parts) status = make_table(&pack.tables[i], certified, error);
        if (status == LQ_OK) status = make(request, &own, certified, error);
    }
    lq_pack_free(&pack);
    if (status == LQ_OK) lq_check_pack(*list, *count);
    return status;
}

bool certify_takes_alone(const char *path) {
    return is_folder(path);
}

int validate_certify(const certify_request *request) {
    lq_certified *list = NULL;
    size_t count = 0;
    bool exceeded = false;
    lq_error error = {""};
    lq_status status;
    if (is_folder(request->path) && request->table) {
        return cli_fail("--table needs a factor file; '%s' is a folder", request->path);
    } else if (is_folder(request->path) && lq_pack_found(request->path)) {
        status = make_pack(request, &list, &count, &exceeded, &error);
    } else if (is_folder(request->path)) {
        status = make_folder(request, &list, &count, &error);
    } else {
        list = calloc(1, sizeof *list);
        if (!list) return cli_fail("out of memory");
        count = 1;
        status = make_file(request, request->path, list, &error);
    }
    const int code = status == LQ_OK ? report(request, list, count) : cli_fail_status(status, &error);
    for (size_t i = 0; i < count; i++) lq_certified_free(&list[i]);
    free(list);
    return code == CLI_DONE && exceeded ? CLI_EXCEEDED : code;
}
