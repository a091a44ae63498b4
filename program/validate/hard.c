/* hard.c - `lacquer validate hard-cases`: every hard case of every kind, and what it must be.
 */
#include "program/validate/validate.h"

#include "program/message.h"
#include "program/output.h"
#include "program/verb.h"
#include "validate/hard_cases.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct hard_report {
    bool json;
    size_t count, failed;
    char group[64];
    json_t *rows;
} hard_report;

static void print_row(hard_report *report, const lq_hard_result *row) {
    if (strcmp(report->group, row->group) != 0) {
        snprintf(report->group, sizeof report->group, "%s", row->group);
        printf("\n%-58s %-23s %-23s\n", row->group, "value", "must be within");
    }
    char value[32], limit[48];
    if (row->least == row->most) snprintf(value, sizeof value, "%.9f", row->least);
    else snprintf(value, sizeof value, "%.6g to %.6g", row->least, row->most);
    if (row->low > 0.0 || (row->low < 0.0 && row->high - row->low < 0.5))
        snprintf(limit, sizeof limit, "%.9f +- %.1e", 0.5 * (row->low + row->high),
                 0.5 * (row->high - row->low));
    else snprintf(limit, sizeof limit, "%g to %g", row->low, row->high);
    printf("  %-56s %-23s %-23s %s\n", row->asked, value, limit, row->passed ? "pass" : "FAIL");
}

static void take_row(void *user, const lq_hard_result *row) {
    hard_report *report = user;
    report->count++;
    report->failed += !row->passed;
    if (!report->json) print_row(report, row);
    else
        lq_json_append(&report->rows,
                       json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:b}", "group", row->group, "asked",
                                 lq_json_text(row->asked), "least", lq_json_number(row->least), "most",
                                 lq_json_number(row->most), "low", lq_json_number(row->low), "high",
                                 lq_json_number(row->high), "passed", row->passed));
}

static bool print_end(const hard_report *report, const char *ndf) {
    if (!report->json) {
        printf("\n%s: %zu of %zu hard cases of %s\n", report->failed ? "FAILED" : "passed",
               report->failed ? report->failed : report->count, report->count, ndf);
        return true;
    }
    json_t *root =
        json_pack("{s:o, s:I, s:I, s:b, s:O}", "ndf", lq_json_text(ndf), "count", (json_int_t)report->count,
                  "failed", (json_int_t)report->failed, "passed", report->failed == 0, "cases", report->rows);
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
}

int validate_hard_cases(const validate_request *request) {
    hard_report report = {.json = request->json, .rows = json_array()};
    cli_progress bar;
    cli_progress_begin(&bar, "hard cases");
    const lq_hard_run run = {.source = {lq_eval, lq_precompute},
                             .ndf = request->settings.settings.ndf,
                             .threads = (int)request->threads,
                             .report = take_row,
                             .user = &report,
                             .progress = &bar.progress};
    lq_error error = {""};
    const lq_status status = lq_hard_cases(&run, &error);
    cli_progress_end(&bar);
    const bool printed = status != LQ_OK || print_end(&report, run.ndf);
    json_decref(report.rows);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    return !printed ? CLI_FAILED : report.failed ? CLI_EXCEEDED : CLI_DONE;
}
