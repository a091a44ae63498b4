/* Certificates as JUnit XML, which build servers read: a table is a suite, a judgement a case. */
#include "validate/report.h"

#include "picture/text.h"
#include "system/output.h"

#include <math.h>

/* Text of an attribute or element. */
static lq_status put_text(lq_output *out, const char *text, lq_error *error) {
    lq_status status = LQ_OK;
    char code[LQ_TEXT_CODE_SIZE];
    while (status == LQ_OK && *text) {
        text += lq_text_character(text, code);
        status = lq_output_print(out, error, "%s", code);
    }
    return status;
}

static lq_status put_case(lq_output *out, const char *suite, const lq_check *check, lq_error *error) {
    lq_status status = lq_output_print(out, error, "    <testcase classname=\"");
    if (status == LQ_OK) status = put_text(out, suite, error);
    if (status == LQ_OK) status = lq_output_print(out, error, "\" name=\"");
    if (status == LQ_OK) status = put_text(out, check->name, error);
    if (status == LQ_OK && check->outcome == LQ_FAILED)
        status = lq_output_print(out, error, "\">\n      <failure message=\"%.3e exceeds %.3e\">",
                                 check->value, check->limit);
    else if (status == LQ_OK)
        status = lq_output_print(out, error, "\">\n      <system-out>%.3e%s ", check->value,
                                 check->outcome == LQ_NOTED ? ", not judged" : "");
    if (status == LQ_OK) status = put_text(out, check->detail, error);
    if (status == LQ_OK)
        status = lq_output_print(out, error, "</%s>\n    </testcase>\n",
                                 check->outcome == LQ_FAILED ? "failure" : "system-out");
    return status;
}

static lq_status put_suite(lq_output *out, const lq_certified *certified, lq_error *error) {
    int failures = certified->check_lost; /* a case more, which says so */
    for (int i = 0; i < certified->check_count; i++) failures += certified->checks[i].outcome == LQ_FAILED;
    lq_status status = lq_output_print(out, error, "  <testsuite name=\"");
    if (status == LQ_OK) status = put_text(out, certified->subject.name, error);
    if (status == LQ_OK)
        status = lq_output_print(out, error, "\" tests=\"%d\" failures=\"%d\" errors=\"0\">\n",
                                 certified->check_count + certified->check_lost, failures);
    for (int i = 0; status == LQ_OK && i < certified->check_count; i++)
        status = put_case(out, certified->subject.name, &certified->checks[i], error);
    if (status == LQ_OK && certified->check_lost)
        status = put_case(out, certified->subject.name, &lq_check_lost, error);
    return status == LQ_OK ? lq_output_print(out, error, "  </testsuite>\n") : status;
}

/* Number `i` of those of the materials. */
static lq_check check_of(const lq_report *report, size_t i) {
    return lq_material_check(&report->materials[i / LQ_MATERIAL_NORMS], (lq_norm)(i % LQ_MATERIAL_NORMS));
}

/* One case a norm. */
static lq_status put_materials(lq_output *out, const lq_report *report, lq_error *error) {
    size_t failures = 0;
    const size_t count = LQ_MATERIAL_NORMS * report->material_count;
    if (count == 0) return LQ_OK;
    for (size_t i = 0; i < count; i++) failures += check_of(report, i).outcome == LQ_FAILED;
    lq_status status = lq_output_print(
        out, error, "  <testsuite name=\"materials\" tests=\"%zu\" failures=\"%zu\" errors=\"0\">\n", count,
        failures);
    for (size_t i = 0; status == LQ_OK && i < count; i++) {
        const lq_check check = check_of(report, i);
        status = put_case(out, report->materials[i / LQ_MATERIAL_NORMS].name, &check, error);
    }
    return status == LQ_OK ? lq_output_print(out, error, "  </testsuite>\n") : status;
}

lq_status lq_report_junit(const lq_report *report, const char *path, lq_error *error) {
    lq_output *out;
    lq_status status = lq_output_open(&out, path, error);
    if (status != LQ_OK) return status;
    status = lq_output_print(out, error, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
    for (size_t i = 0; status == LQ_OK && i < report->count; i++)
        status = put_suite(out, &report->list[i], error);
    if (status == LQ_OK) status = put_materials(out, report, error);
    if (status == LQ_OK) status = lq_output_print(out, error, "</testsuites>\n");
    if (status == LQ_OK) return lq_output_commit(out, error);
    lq_output_abandon(out);
    return status;
}
