/* page.c - the page of `lacquer bench --report`: speed against error of everything. */
#include "program/bench/page.h"

#include "picture/document.h"
#include "picture/text.h"
#include "program/date.h"
#include "system/stream.h"
#include "tables/origin.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void put_number(FILE *out, const char *format, double x) {
    char text[48];
    snprintf(text, sizeof text, format, x);
    fprintf(out, "<td>%s</td>", isfinite(x) ? text : "–");
}

static void put_summary(FILE *out, const bench_page *page) {
    static const char *const heads[] = {"table", "solver, CPU s an entry", "walk, CPU s an entry", "ratio"};
    static const double equal = 1e-4;
    fputs("<h2 class=\"apart\">At an rms error of 10<sup>−4</sup></h2>\n", out);
    lq_document_table(out, heads, 4);
    for (size_t i = 0; i < page->job_count; i++) {
        char name[BENCH_NAME];
        const double solver = bench_solver_cost(&page->jobs[i], equal),
                     walk = bench_walk_cost(&page->jobs[i], equal);
        bench_name(&page->jobs[i], name);
        fprintf(out, "<tr><td><a href=\"#%s\">%s</a></td>", name, name);
        put_number(out, "%.2g", solver);
        put_number(out, "%.2g", walk);
        put_number(out, "%.2g", walk / solver);
        fputs("</tr>\n", out);
    }
    lq_document_table_end(out);
}

static void put_job(FILE *out, const bench_job *job) {
    static const char *const heads[] = {"method",         "setting",   "entries", "wall s",
                                        "CPU s an entry", "rms error", "largest"};
    char name[BENCH_NAME], what[160];
    bench_name(job, name);
    lq_origin_describe(job->kind, &job->options.settings, what, sizeof what);
    lq_document_heading(out, 2, name, what);
    fprintf(
        out,
        "<p>%s. Errors at %zu entries, against the solver at %.0e.</p>\n<p><img src=\"%s.svg\" alt=\"speed "
        "against error\"></p>\n",
        job->kind->title, job->points, job->reference_tolerance, name);
    lq_document_table(out, heads, 7);
    for (size_t i = 0; i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        fprintf(out,
                "<tr><td>%s</td><td>%.0e</td><td>%zu</td><td>%.3g</td><td>%.3g</td><td>%.2e</td><td>%.2e</td>"
                "</tr>\n",
                bench_method(row), row->setting, row->entries, row->seconds, row->cpu_per_entry, row->rms,
                row->max);
    }
    lq_document_table_end(out);
}

static void put_compressions(FILE *out, const bench_page *page) {
    static const char *const heads[] = {"table", "scheme", "separated", "bytes",  "of",
                                        "CPU s", "rms",    "p99",       "largest"};
    lq_document_heading(out, 2, "compressions", "Compressions");
    fputs("<p>Errors as a GPU looks the textures up, against the table they were made from; the full size is "
          "that "
          "of the table in half.</p>\n",
          out);
    for (size_t i = 0; i < page->compression_count; i++) {
        const char *kind = page->compressions[i].kind;
        if (i == 0 || strcmp(page->compressions[i - 1].kind, kind) != 0)
            fprintf(out, "<p><img src=\"%s-compressed.svg\" alt=\"bytes against error of %s\"></p>\n", kind,
                    kind);
    }
    lq_document_table(out, heads, 9);
    for (size_t i = 0; i < page->compression_count; i++) {
        const bench_compression *c = &page->compressions[i];
        fprintf(out,
                "<tr><td>%s</td><td>%s</td><td>%s</td><td>%zu</td><td>%zu</td><td>%.2g</td><td>%.1e</td>"
                "<td>%.1e</td><td>%.1e</td></tr>\n",
                c->kind, c->scheme, c->separated, c->bytes, c->table_bytes, c->seconds, c->rms, c->p99,
                c->max);
    }
    lq_document_table_end(out);
}

static void put_page(FILE *out, const bench_page *page) {
    char date[CLI_DATE_SIZE];
    cli_date(date);
    lq_document_begin(out, "Speed against error");
    fputs("<p>", out);
    lq_text_put(out, page->machine);
    fprintf(out,
            ", <time>%s</time>. Everything on this page comes from one run of <code>lacquer bench "
            "--report</code>; "
            "times are CPU seconds: wall clock × threads.</p>\n",
            date);
    put_summary(out, page);
    for (size_t i = 0; i < page->job_count; i++) put_job(out, &page->jobs[i]);
    if (page->compression_count > 0) put_compressions(out, page);
    lq_document_end(out);
}

lq_status bench_write_page(const bench_page *page, lq_error *error) {
    char path[4096];
    lq_stream stream;
    snprintf(path, sizeof path, "%s/index.html", page->folder);
    const lq_status opened = lq_stream_open(&stream, path, error);
    if (opened != LQ_OK) return opened;
    put_page(stream.out, page);
    return lq_stream_close(&stream, LQ_OK, error);
}
