/* report.c - `lacquer bench --report DIR`: speed against error of everything, on one page. */
#include "program/bench/page.h"

#include "picture/plot.h"
#include "program/message.h"
#include "program/output.h"
#include "program/progress.h"
#include "program/verb.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_JOBS = 32, PATH_SIZE = 4096, NAME = BENCH_NAME };

/* ======================================================================================
 *                                     Measurements
 * ====================================================================================== */

void bench_name(const bench_job *job, char *name) {
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
    bench_name(job, name);
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
        bench_name(job, name);
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
            series[count] = (lq_plot_line){.name = c->scheme,
                                           .x = bytes[count],
                                           .y = worst[count],
                                           .hue = (int)count,
                                           .secondary = c->scheme[0] == 's'};
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

/* ======================================================================================
 *                                        The call
 * ====================================================================================== */

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
    if (!cli_report_folder(folder)) return CLI_FAILED;
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
        if (status == LQ_OK) status = bench_write_page(page, &error);
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
