/* report.c - `lacquer bench --report DIR`: speed against error of everything, on one page. */
#include "program/bench/bench.h"

#include "program/message.h"
#include "program/output.h"
#include "program/progress.h"
#include "program/verb.h"
#include "system/output.h"
#include "tables/origin.h"
#include "tables/plot.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_JOBS = 32, PATH_SIZE = 4096, NAME = 96 };

typedef struct bench_page {
    const char *folder;
    bench_job *jobs; /* MAX_JOBS of them */
    size_t job_count;
    bench_compression compressions[BENCH_MAX_COMPRESSIONS];
    size_t compression_count;
    char machine[192];
} bench_page;

/* ======================================================================================
 *                                     Measurements
 * ====================================================================================== */

/* What tells two jobs apart, fit for a file name. */
static void name_of(const bench_job *job, char *name) {
    const bool single =
        (job->kind->takes & LQ_TAKES_SCATTERING) && job->options.settings.scattering == LQ_SINGLE;
    snprintf(name, NAME, "%s%s", job->kind->id, single ? "-single" : "");
}

static void list_jobs(bench_page *page, const bench_job *like) {
    for (size_t k = 0; k < lq_kind_count(); k++)
        for (int single = 0; single < 2 && page->job_count < MAX_JOBS; single++) {
            const lq_kind *kind = lq_kind_at(k);
            if (like->kind && like->kind != kind) continue;
            if (single && !(kind->takes & LQ_TAKES_SCATTERING)) continue;
            bench_job *job = &page->jobs[page->job_count++];
            *job = *like;
            job->kind = kind;
            if (single) job->options.settings.scattering = LQ_SINGLE;
        }
}

static lq_status measure_job(bench_job *job, lq_error *error) {
    char name[NAME];
    cli_progress bar;
    name_of(job, name);
    cli_progress_begin(&bar, name);
    const lq_status status = bench_measure(job, &bar.progress, error);
    cli_progress_end(&bar);
    if (status == LQ_OK) printf("%-28s %zu rows\n", name, job->row_count);
    fflush(stdout);
    return status;
}

static lq_status measure(bench_page *page, const bench_job *like, lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < page->job_count; i++)
        status = measure_job(&page->jobs[i], error);
    if (status != LQ_OK) return status;
    cli_progress bar;
    cli_progress_begin(&bar, "compressions");
    status = bench_compress(like->kind, like->threads, &bar.progress, page->compressions,
                            &page->compression_count, error);
    cli_progress_end(&bar);
    return status;
}

/* ======================================================================================
 *                                         Files
 * ====================================================================================== */

static lq_status write_charts(bench_page *page, lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < page->job_count; i++) {
        char name[NAME], svg[PATH_SIZE], csv[PATH_SIZE];
        bench_job *job = &page->jobs[i];
        name_of(job, name);
        snprintf(svg, sizeof svg, "%s/%s.svg", page->folder, name);
        snprintf(csv, sizeof csv, "%s/%s.csv", page->folder, name);
        job->svg = svg;
        job->csv = csv;
        status = bench_write_svg(job, error);
        if (status == LQ_OK) status = bench_write_csv(job, error);
        job->svg = job->csv = NULL;
    }
    return status;
}

/* Largest error against bytes of the table in rows `from` and on, one series a scheme; where its rows end. */
static lq_status write_compression_chart(const bench_page *page, size_t from, size_t *end, lq_error *error) {
    enum { SCHEMES = 2, POINTS = 16 };
    double bytes[SCHEMES][POINTS], worst[SCHEMES][POINTS];
    lq_plot_line series[SCHEMES];
    char path[PATH_SIZE], title[NAME];
    const char *kind = page->compressions[from].kind;
    size_t count = 0;
    for (*end = from; *end < page->compression_count && strcmp(page->compressions[*end].kind, kind) == 0;
         ++*end) {
        const bench_compression *c = &page->compressions[*end];
        if (count == 0 || strcmp(series[count - 1].name, c->scheme) != 0) {
            if (count == SCHEMES) continue;
            series[count] = (lq_plot_line){c->scheme, 0,          bytes[count],       worst[count],
                                           NULL,      (int)count, c->scheme[0] == 's'};
            count++;
        }
        lq_plot_line *s = &series[count - 1];
        if (s->count == POINTS) continue;
        bytes[count - 1][s->count] = (double)c->bytes;
        worst[count - 1][s->count++] = c->max;
    }
    snprintf(title, sizeof title, "Bytes against error: %s compressed", kind);
    const lq_plot plot = {.title = title,
                          .subtitle = page->machine,
                          .x = {"bytes", true},
                          .y = {"largest error as a GPU looks it up", true},
                          .series = series,
                          .series_count = count};
    snprintf(path, sizeof path, "%s/%s-compressed.svg", page->folder, kind);
    return lq_plot_write(&plot, path, error);
}

static lq_status write_compression_charts(const bench_page *page, lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t from = 0, end; status == LQ_OK && from < page->compression_count; from = end)
        status = write_compression_chart(page, from, &end, error);
    return status;
}

static const char head[] =
    "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>lacquer bench</title>\n<style>\n"
    "body{font:15px/1.45 system-ui,sans-serif;max-width:60em;margin:2em auto;padding:0 1em;"
    "background:#fcfcfb;color:#1a1a19}\n"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1em 0}\n"
    "th,td{padding:.2em .8em;text-align:right;border-bottom:1px solid #e6e5e0}"
    "th:first-child,td:first-child{text-align:left}\nimg{max-width:100%}a{color:#2a6fdb}\n"
    "@media (prefers-color-scheme:dark){body{background:#1a1a19;color:#f4f3ef}th,td{border-color:#33332f}"
    "a{color:#5b9bf2}}\n</style>\n<h1>Speed against error</h1>\n";

static lq_status write_number(lq_output *out, const char *format, double x, lq_error *error) {
    char text[48];
    snprintf(text, sizeof text, format, x);
    return lq_output_print(out, error, "<td>%s</td>", isfinite(x) ? text : "–");
}

static lq_status write_summary(const bench_page *page, lq_output *out, lq_error *error) {
    static const double equal = 1e-4;
    lq_status status =
        lq_output_print(out, error,
                        "<h2>At an rms error of 10<sup>−4</sup></h2>\n<table><tr><th>table</th><th>solver, "
                        "CPU s an entry</th>"
                        "<th>walk, CPU s an entry</th><th>ratio</th></tr>\n");
    for (size_t i = 0; status == LQ_OK && i < page->job_count; i++) {
        char name[NAME];
        const double solver = bench_solver_cost(&page->jobs[i], equal),
                     walk = bench_walk_cost(&page->jobs[i], equal);
        name_of(&page->jobs[i], name);
        status = lq_output_print(out, error, "<tr><td><a href=\"#%s\">%s</a></td>", name, name);
        if (status == LQ_OK) status = write_number(out, "%.2g", solver, error);
        if (status == LQ_OK) status = write_number(out, "%.2g", walk, error);
        if (status == LQ_OK) status = write_number(out, "%.2g", walk / solver, error);
        if (status == LQ_OK) status = lq_output_print(out, error, "</tr>\n");
    }
    return status == LQ_OK ? lq_output_print(out, error, "</table>\n") : status;
}

static lq_status write_job(const bench_job *job, lq_output *out, lq_error *error) {
    char name[NAME], what[160];
    name_of(job, name);
    lq_origin_describe(job->kind, &job->options.settings, what, sizeof what);
    lq_status status = lq_output_print(
        out, error,
        "<h2 id=\"%s\">%s</h2>\n<p>%s. Errors at %zu entries, against the solver at %.0e.</p>\n<p><img "
        "src=\"%s.svg\" "
        "alt=\"speed against "
        "error\"></p>\n<table><tr><th>method</th><th>setting</th><th>entries</th><th>wall s</th>"
        "<th>CPU s an entry</th><th>rms error</th><th>largest</th></tr>\n",
        name, what, job->kind->title, job->points, job->reference_tolerance, name);
    for (size_t i = 0; status == LQ_OK && i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        status =
            lq_output_print(out, error,
                            "<tr><td>%s</td><td>%.0e</td><td>%zu</td><td>%.3g</td><td>%.3g</td><td>%.2e</td>"
                            "<td>%.2e</td></tr>\n",
                            bench_method(row), row->setting, row->entries, row->seconds, row->cpu_per_entry,
                            row->rms, row->max);
    }
    return status == LQ_OK ? lq_output_print(out, error, "</table>\n") : status;
}

static lq_status write_compressions(const bench_page *page, lq_output *out, lq_error *error) {
    lq_status status =
        lq_output_print(out, error,
                        "<h2 id=\"compressions\">Compressions</h2>\n<p>Errors as a GPU looks the textures "
                        "up, against the table "
                        "they were made from; the full size is that of the table in half.</p>\n");
    for (size_t i = 0; status == LQ_OK && i < page->compression_count; i++) {
        const char *kind = page->compressions[i].kind;
        if (i == 0 || strcmp(page->compressions[i - 1].kind, kind) != 0)
            status = lq_output_print(
                out, error, "<p><img src=\"%s-compressed.svg\" alt=\"bytes against error of %s\"></p>\n",
                kind, kind);
    }
    if (status == LQ_OK)
        status = lq_output_print(out, error,
                                 "<table><tr><th>table</th><th>scheme</th><th>separated</th><th>bytes</th>"
                                 "<th>of</th><th>CPU s</th><th>rms</th><th>p99</th><th>largest</th></tr>\n");
    for (size_t i = 0; status == LQ_OK && i < page->compression_count; i++) {
        const bench_compression *c = &page->compressions[i];
        status = lq_output_print(out, error,
                                 "<tr><td>%s</td><td>%s</td><td>%s</td><td>%zu</td><td>%zu</td><td>%.2g</td>"
                                 "<td>%.1e</td><td>%.1e</td><td>%.1e</td></tr>\n",
                                 c->kind, c->scheme, c->separated, c->bytes, c->table_bytes, c->seconds,
                                 c->rms, c->p99, c->max);
    }
    return status == LQ_OK ? lq_output_print(out, error, "</table>\n") : status;
}

static lq_status write_page(const bench_page *page, lq_error *error) {
    char path[PATH_SIZE];
    lq_output *out;
    snprintf(path, sizeof path, "%s/index.html", page->folder);
    lq_status status = lq_output_open(&out, path, error);
    if (status != LQ_OK) return status;
    status = lq_output_print(out, error,
                             "%s<p>%s. Everything on this page comes from one run of <code>lacquer bench "
                             "--report</code>; times are CPU seconds: wall clock × threads.</p>\n",
                             head, page->machine);
    if (status == LQ_OK) status = write_summary(page, out, error);
    for (size_t i = 0; status == LQ_OK && i < page->job_count; i++)
        status = write_job(&page->jobs[i], out, error);
    if (status == LQ_OK && page->compression_count > 0) status = write_compressions(page, out, error);
    if (status == LQ_OK) status = lq_output_print(out, error, "</html>\n");
    if (status == LQ_OK) return lq_output_commit(out, error);
    lq_output_abandon(out);
    return status;
}

/* ======================================================================================
 *                                        The call
 * ====================================================================================== */

static bool make_folder(const char *folder) {
    char probe[PATH_SIZE];
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        cli_message("--report: cannot make the folder %s: %s", folder, strerror(errno));
        return false;
    }
    const int size = snprintf(probe, sizeof probe, "%s/index.html", folder);
    if (size >= (int)sizeof probe - NAME) {
        cli_message("--report: the name of the folder is too long");
        return false;
    }
    return cli_output_check(probe);
}

static int judge(const bench_page *page) {
    for (size_t i = 0; i < page->job_count; i++) {
        const bench_row *broken = bench_broken_row(&page->jobs[i]);
        if (!broken) continue;
        cli_message("%s: at tolerance %g the largest error is %.2e", page->jobs[i].kind->id, broken->setting,
                    broken->max);
        return CLI_EXCEEDED;
    }
    return CLI_DONE;
}

int bench_report(const char *folder, const bench_job *like) {
    if (!make_folder(folder)) return CLI_FAILED;
    bench_page *page = calloc(1, sizeof *page);
    bench_job *jobs = calloc(MAX_JOBS, sizeof *jobs);
    lq_error error = {""};
    int code = CLI_FAILED;
    if (page && jobs) {
        page->folder = folder;
        page->jobs = jobs;
        bench_describe_machine(like->threads, page->machine, sizeof page->machine);
        list_jobs(page, like);
        lq_status status = measure(page, like, &error);
        if (status == LQ_OK) status = write_charts(page, &error);
        if (status == LQ_OK) status = write_compression_charts(page, &error);
        if (status == LQ_OK) status = write_page(page, &error);
        code = status == LQ_OK ? judge(page) : cli_fail_status(status, &error);
        if (status == LQ_OK) printf("%s/index.html\n", folder);
        for (size_t i = 0; i < page->job_count; i++)
            for (int a = 0; a < jobs[i].kind->axis_count; a++) lq_axis_free(&jobs[i].axes[a]);
    } else {
        cli_message("out of memory");
    }
    free(jobs);
    free(page);
    return code;
}
