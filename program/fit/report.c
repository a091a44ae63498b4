/* report.c - `lacquer fit --report DIR`: a page that says how good the fit is, with its curve and its
 * residuals. */
#include "picture/document.h"
#include "picture/plot.h"
#include "picture/text.h"
#include "program/date.h"
#include "program/fit/fit.h"
#include "program/message.h"
#include "system/number.h"
#include "system/status.h"
#include "system/stream.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fits lie on the exact curve, which is drawn first, under them. */
enum { EXACT, FITTED, PAPER, SERIES };

/* ======================================================================================
 *                                         Charts
 * ====================================================================================== */

static void fill(const fit_job *job, double *at, double *values[SERIES], bool residual) {
    for (size_t i = 0; i < job->count; i++) {
        const double *x = job->x + i * LQ_FAMILY_COORDINATES;
        at[i] = x[0];
        values[EXACT][i] = job->y[i];
        values[FITTED][i] = lq_family_value(job->request.family, job->answer.p, x);
        values[PAPER][i] = job->published < 0 ? NAN : lq_family_value(job->published, job->published_p, x);
        for (int k = FITTED; residual && k < SERIES; k++) values[k][i] = fabs(values[k][i] / job->y[i] - 1.0);
    }
}

/* A label at the largest residual alone, which its marker shows. */
static void label_worst(const fit_job *job, const double *y, const char **labels, char *text, size_t size) {
    size_t worst = 0;
    for (size_t i = 0; i < job->count; i++) {
        labels[i] = NULL;
        if (y[i] > y[worst]) worst = i;
    }
    lq_print(text, size, "%.2g", y[worst]);
    labels[worst] = text;
}

/* Room for the points of every series. */
typedef struct points {
    double *numbers; /* of x, then of each series */
    const char **labels;
} points;

static lq_status draw_points(const fit_job *job, const points *p, bool residual, FILE *out, lq_error *error) {
    const lq_family *family = lq_family_at(job->request.family);
    const bool hg = job->request.mapping == LQ_MAP_HG;
    const size_t first = residual ? FITTED : EXACT, last = job->published >= 0 ? PAPER : FITTED;
    char texts[SERIES][24];
    double *values[SERIES];
    lq_plot_line series[SERIES] = {
        {.name = "exact", .under = true}, {.name = family->name, .hue = 1}, {.hue = 2, .secondary = true}};
    series[PAPER].name = job->published >= 0 ? lq_family_at(job->published)->source : "";
    for (size_t k = 0; k < SERIES; k++) values[k] = p->numbers + (1 + k) * job->count;
    fill(job, p->numbers, values, residual);
    for (size_t k = first; k <= last; k++) {
        series[k].count = job->count;
        series[k].x = p->numbers;
        series[k].y = values[k];
        series[k].curve = true;
        if (!residual) continue;
        series[k].labels = p->labels + k * job->count;
        label_worst(job, values[k], p->labels + k * job->count, texts[k], sizeof texts[k]);
    }
    const lq_plot plot = {.title = residual ? "Relative error of the fits" : family->formula,
                          .subtitle = lq_ndf_text(job->ndf),
                          .x = {hg ? "g" : "alpha", !hg},
                          .y = {residual ? "|fit / exact - 1|" : lq_mapping_name(job->request.mapping), true},
                          .series = series + first,
                          .series_count = last - first + 1};
    return lq_plot_draw(&plot, out, error);
}

static lq_status draw(const fit_job *job, bool residual, FILE *out, lq_error *error) {
    const points p = {calloc((1 + SERIES) * job->count, sizeof(double)),
                      calloc(SERIES * job->count, sizeof(char *))};
    const lq_status status = p.numbers && p.labels ? draw_points(job, &p, residual, out, error)
                                                   : lq_fail(error, LQ_NO_MEMORY, "no memory for the chart");
    free(p.numbers);
    free(p.labels);
    return status;
}

/* ======================================================================================
 *                                        The page
 * ====================================================================================== */

static void put_verdict(FILE *out, const fit_job *job) {
    char date[CLI_DATE_SIZE];
    cli_date(date);
    fprintf(
        out,
        "<p class=\"verdict\">Off by at most <b>%.3g</b>, relative, at %.3g; rms %.3g <time>%s</time></p>\n",
        job->errors.max, job->errors.max_at, job->errors.rms, date);
    fprintf(out, "<p>%zu points from %g to %g, fitted by lacquer " LQ_VERSION ".", job->count,
            job->request.low, job->request.high);
    if (job->published >= 0) {
        fputs(" On the same points ", out);
        lq_text_put(out, lq_family_at(job->published)->source);
        fprintf(out, " is off by %.3g at %.3g, rms %.3g.", job->published_errors.max,
                job->published_errors.max_at, job->published_errors.rms);
    }
    fputs("</p>\n", out);
}

static void put_formula(FILE *out, const char *text) {
    fputs("<pre>", out);
    lq_text_put(out, text);
    fputs("</pre>\n", out);
}

static void put_use(FILE *out, const fit_job *job) {
    const lq_family *family = lq_family_at(job->request.family);
    static const char *const heads[] = {"coefficient", "value", "standard error"};
    lq_document_heading(out, 2, NULL, "How to use it");
    put_formula(out, family->formula);
    if (family->inverse) put_formula(out, family->inverse);
    lq_document_table(out, heads, 3);
    for (int k = 0; k < family->parameters; k++)
        fprintf(out, "<tr><td>%c</td><td>%.9g</td><td>%.2g</td></tr>\n", family->names[k], job->answer.p[k],
                sqrt(fmax(job->answer.covariance[k * LQ_FAMILY_PARAMETERS + k], 0.0)));
    lq_document_table_end(out);
    fputs("<p><code>--snippet FILE.glsl</code>, <code>.hlsl</code> or <code>.h</code> writes them as a "
          "function and "
          "its inverse.</p>\n",
          out);
}

static lq_status put_page(FILE *out, const fit_job *job, lq_error *error) {
    char title[LQ_MESSAGE_SIZE];
    snprintf(title, sizeof title, "Fit of %s, %.200s, family %s", lq_mapping_name(job->request.mapping),
             lq_ndf_text(job->ndf), lq_family_at(job->request.family)->name);
    lq_document_begin(out, title);
    put_verdict(out, job);
    lq_status status = draw(job, false, out, error);
    if (status == LQ_OK) status = draw(job, true, out, error);
    put_use(out, job);
    lq_document_end(out);
    return status;
}

bool fit_write_report(const fit_job *job) {
    char path[4096];
    lq_stream stream;
    lq_error error = {""};
    snprintf(path, sizeof path, "%s/index.html", job->request.report);
    lq_status status = lq_stream_open(&stream, path, &error);
    if (status == LQ_OK) status = lq_stream_close(&stream, put_page(stream.out, job, &error), &error);
    return status == LQ_OK || (cli_fail_status(status, &error), false);
}
