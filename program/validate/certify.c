/* certify.c - `lacquer validate` with a certificate, of a table, a factor file or a folder of
 * them. */
#include "program/validate/certify.h"

#include "program/date.h"
#include "program/message.h"
#include "program/progress.h"

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
    request->wanted = request->asked.has_budget = true;
    if (!strchr(value, '=') && access(value, F_OK) == 0)
        return accept(lq_budgets_read(&request->asked.budgets, value, &error), &error);
    request->asked.budgets = (lq_budgets){.count = 1};
    return accept(lq_budget_parse(&request->asked.budgets.rules[0].budget, value, &error), &error);
}

bool certify_take_domain(certify_request *request, const char *value) {
    lq_error error = {""};
    return accept(lq_ranges_parse(&request->asked.domain, value, &error), &error);
}

/* Everything that was asked for, from one list; the exit code. */
static int report(const certify_request *request, const lq_certificates *made) {
    lq_error error = {""};
    lq_status status = LQ_OK;
    for (size_t i = 0; i < made->count && !request->json; i++) certify_print_text(&made->tables[i]);
    if (request->json) {
        char *text = NULL;
        status = lq_certificates_json(made, &text, &error);
        if (status == LQ_OK) printf("%s\n", text);
        free(text);
    }
    if (status == LQ_OK && request->junit) status = lq_certificates_junit(made, request->junit, &error);
    char date[CLI_DATE_SIZE];
    cli_date(date);
    if (status == LQ_OK && request->report)
        status = lq_certificates_page(made, request->report, date, &error);
    return status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
}

bool certify_takes_alone(const char *path) {
    struct stat facts;
    return stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
}

int validate_certify(const certify_request *request) {
    lq_certificates *made = NULL;
    lq_error error = {""};
    cli_watch bar;
    lq_certifying asked = request->asked;
    if (asked.table && certify_takes_alone(request->path))
        return cli_fail("--table needs a factor file; '%s' is a folder", request->path);
    asked.trust = request->trust;
    asked.watch = *cli_watch_start(&bar);
    const lq_status status = lq_certify_read(&asked, request->path, &made, &error);
    if (made && made->material_count > 0 && !request->json) certify_print_materials(made);
    int code = status == LQ_OK ? report(request, made) : cli_fail_status(status, &error);
    if (code == CLI_DONE && !lq_certificates_passed(made)) code = CLI_EXCEEDED;
    lq_certificates_free(made);
    return code;
}
