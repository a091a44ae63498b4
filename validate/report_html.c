/* The page of a certificate: one file that needs no other, readable without scripts. */
#include "picture/document.h"
#include "picture/text.h"
#include "system/number.h"
#include "system/status.h"
#include "system/stream.h"
#include "validate/report_parts.h"

#include <unistd.h>

size_t lq_report_failures(const lq_report *report) {
    size_t failures = 0;
    for (size_t i = 0; i < report->count; i++) failures += lq_certified_failure(&report->list[i]) != NULL;
    for (size_t i = 0; i < report->material_count; i++)
        failures += lq_material_failure(&report->materials[i]) != NULL;
    return failures;
}

/* ======================================================================================
 *                                        The verdict
 * ====================================================================================== */

/* The largest absolute error of all, and whose it is. */
static double worst_of(const lq_report *report, const char **name, char *at, size_t size) {
    double worst = -1.0;
    *name = "";
    at[0] = '\0';
    for (size_t i = 0; i < report->count; i++) {
        const lq_sampled *c = &report->list[i].certificate;
        if (c->max <= worst || (c->request.relative && report->count > 1)) continue;
        worst = c->max;
        *name = report->list[i].subject.name;
        lq_point_text(c->request.kind, lq_report_worst(c), at, size);
    }
    for (size_t i = 0; i < report->material_count; i++) {
        if (report->materials[i].measure.max <= worst) continue;
        worst = report->materials[i].measure.max;
        *name = report->materials[i].name;
        lq_material_worst(&report->materials[i], at, size);
    }
    return worst;
}

static void put_verdict(FILE *out, const lq_report *report) {
    const size_t failures = lq_report_failures(report), all = report->count + report->material_count;
    const char *name;
    char at[160], words[LQ_MESSAGE_SIZE], verdict[96];
    const double worst = worst_of(report, &name, at, sizeof at);
    if (failures == 0) lq_print(verdict, sizeof verdict, "Passed:");
    else lq_print(verdict, sizeof verdict, "Failed, %zu of %zu:", failures, all);
    size_t used = 0;
    if (report->count > 0)
        used = (size_t)lq_print(words, sizeof words, "%zu table%s", report->count,
                                report->count == 1 ? "" : "s");
    if (report->material_count > 0)
        used += (size_t)lq_print(words + used, sizeof words - used, "%s%zu material%s", used ? ", " : "",
                                 report->material_count, report->material_count == 1 ? "" : "s");
    lq_print(words + used, sizeof words - used, ". The worst is off by %.2g, in %.100s at %s.", worst, name,
             at);
    lq_document_verdict(out, failures == 0, verdict, report->date, words);
    fputs("<p>Certificate by lacquer " LQ_VERSION
          ": what a renderer decodes against the exact integral.</p>\n",
          out);
}

static void put_contents(FILE *out, const lq_report *report) {
    if (report->count + report->material_count < 2) return;
    fputs("<nav>", out);
    if (report->material_count > 0) fputs("<a href=\"#materials\">materials</a>\n", out);
    for (size_t i = 0; i < report->count; i++) {
        const bool failed = lq_certified_failure(&report->list[i]) != NULL;
        fprintf(out, "<a%s href=\"#t%zu\">", failed ? " class=\"failed\"" : "", i);
        lq_text_put(out, report->list[i].subject.name);
        fputs("</a>\n", out);
    }
    fputs("</nav>\n", out);
}

/* ======================================================================================
 *                                         Tables
 * ====================================================================================== */

static void put_result(FILE *out, const char *failure) {
    fprintf(out, "<td class=\"%s\">%s", failure ? "failed" : "passed", failure ? "failed: " : "passed");
    if (failure) lq_text_put(out, failure);
    fputs("</td>", out);
}

static void put_tables(FILE *out, const lq_report *report) {
    static const char *const heads[] = {"table", "result", "max", "worst at", "p99", "rms", "points", "kind"};
    if (report->count < 2) return;
    lq_document_table(out, heads, 8);
    for (size_t i = 0; i < report->count; i++) {
        const lq_sampled *c = &report->list[i].certificate;
        const lq_check *failed = lq_certified_failure(&report->list[i]);
        char at[160];
        lq_point_text(c->request.kind, lq_report_worst(c), at, sizeof at);
        fprintf(out, "<tr><td><a href=\"#t%zu\">", i);
        lq_text_put(out, report->list[i].subject.name);
        fputs("</a></td>", out);
        put_result(out, failed ? failed->name : NULL);
        fprintf(out, "<td>%.2e</td><td>%s</td><td>%.2e</td><td>%.2e</td><td>%zu</td><td>%s</td></tr>\n",
                c->max, at, c->total.p99, c->total.rms, c->points, c->request.kind->id);
    }
    lq_document_table_end(out);
}

static void put_materials(FILE *out, const lq_report *report) {
    static const char *const heads[] = {"material", "result", "max", "worst at", "p99", "rms", "points"};
    if (report->material_count == 0) return;
    lq_document_heading(out, 2, "materials", "Materials");
    fputs("<p>Energies and roughness against the exact stack.</p>\n", out);
    lq_document_table(out, heads, 7);
    for (size_t i = 0; i < report->material_count; i++) {
        const lq_certified_material *m = &report->materials[i];
        char at[160];
        lq_material_worst(m, at, sizeof at);
        fputs("<tr><td>", out);
        lq_text_put(out, m->name);
        fputs("</td>", out);
        put_result(out, lq_material_failure(m));
        fprintf(out, "<td>%.2e</td><td>%s</td><td>%.2e</td><td>%.2e</td><td>%zu</td></tr>\n", m->measure.max,
                at, m->measure.p99, m->measure.rms, m->measure.points);
    }
    lq_document_table_end(out);
}

/* ======================================================================================
 *                                        The page
 * ====================================================================================== */

static lq_status put_page(FILE *out, const lq_report *report, lq_error *error) {
    char title[LQ_MESSAGE_SIZE];
    snprintf(title, sizeof title, "Certificate of %.400s", report->name);
    lq_document_begin(out, title);
    put_verdict(out, report);
    put_contents(out, report);
    put_tables(out, report);
    put_materials(out, report);
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < report->count; i++)
        status = lq_report_table(out, &report->list[i], i, error);
    lq_document_end(out);
    return status;
}

static lq_status save_page(const lq_report *report, const char *folder, lq_error *error) {
    char path[4096];
    lq_stream stream;
    if ((size_t)snprintf(path, sizeof path, "%s/index.html", folder) >= sizeof path)
        return lq_fail(error, LQ_BAD_INPUT, "the name of the report's folder is too long");
    const lq_status opened = lq_stream_open(&stream, path, error);
    if (opened != LQ_OK) return opened;
    return lq_stream_close(&stream, put_page(stream.out, report, error), error);
}

lq_status lq_report_html(const lq_report *report, const char *folder, lq_error *error) {
    const bool was_there = access(folder, F_OK) == 0;
    lq_status status = lq_output_folder(folder, error);
    if (status != LQ_OK) return status;
    status = save_page(report, folder, error);
    if (status != LQ_OK && !was_there) rmdir(folder); /* no stray folder for a page that is not */
    return status;
}
