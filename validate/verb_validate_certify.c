/* verb_validate_certify.c - `lacquer validate` with a certificate, of one table or factor file. */
#include "validate/verb_validate_certify.h"

#include "cli/message.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "validate/report.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool accept(lq_status status, const lq_error *error) {
    if (status != LQ_OK) cli_message("%s", error->text);
    return status == LQ_OK;
}

bool certify_take_budget(certify_request *request, const char *value) {
    lq_error error = {""};
    request->wanted = true;
    if (!strchr(value, '=') && access(value, F_OK) == 0)
        return accept(lq_budgets_read(&request->budgets, value, &error), &error);
    request->budgets = (lq_budgets){.count = 1};
    return accept(lq_budget_parse(&request->budgets.rules[0].budget, value, &error), &error);
}

bool certify_take(certify_request *request, int id, const char *value) {
    lq_error error = {""};
    request->wanted = true;
    switch (id) {
    case CERTIFY_ON:
        return accept(lq_ranges_parse(&request->domain, value, &error), &error);
    case CERTIFY_TABLE:
        request->table = value;
        break;
    case CERTIFY_JUNIT:
        request->junit = value;
        return cli_output_check(value);
    case CERTIFY_REPORT:
        request->report = value;
        break;
    default:
        break;
    }
    return true;
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

static lq_status make(const certify_request *request, lq_certified *certified, lq_error *error) {
    lq_status status = lq_subject_read(&certified->subject, request->path, error);
    if (status == LQ_OK && request->table)
        status = certified->subject.factored
                     ? lq_subject_add_table(&certified->subject, request->table, error)
                     : LQ_BAD_INPUT;
    if (status == LQ_BAD_INPUT && !error->text[0])
        snprintf(error->text, sizeof error->text, "--table needs a factor file; '%.200s' is a table",
                 request->path);
    if (status != LQ_OK) return status;
    const char *kind = certified->subject.origin.kind->id;
    const lq_certify_options options = {.rule = rule_for(request, certified->subject.name, kind),
                                        .points = request->points,
                                        .tolerance = request->tolerance,
                                        .seed = request->seed,
                                        .threads = request->threads};
    cli_progress bar;
    cli_progress_begin(&bar, kind);
    status = lq_certified_make(certified, &options, &bar.progress, error);
    cli_progress_end(&bar);
    return status;
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

int validate_certify(const certify_request *request) {
    lq_certified *certified = calloc(1, sizeof *certified);
    if (!certified) return cli_fail("out of memory");
    lq_error error = {""};
    const lq_status status = make(request, certified, &error);
    const int code = status == LQ_OK ? report(request, certified, 1) : cli_fail_status(status, &error);
    lq_certified_free(certified);
    free(certified);
    return code;
}
