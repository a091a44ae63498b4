/* A fit as charts: the curve with the fits, and beside it their residuals. */
#include "program/fit/fit.h"
#include "program/message.h"
#include "tables/plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXACT, FITTED, PAPER, SERIES };

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

static bool draw(const fit_job *job, const char *path, bool residual) {
    const lq_family *family = lq_family_at(job->request.family);
    double *at = malloc(job->count * sizeof *at), *values[SERIES];
    bool memory = at != NULL;
    for (int k = 0; k < SERIES; k++) memory &= (values[k] = malloc(job->count * sizeof(double))) != NULL;
    lq_plot_line series[SERIES] = {
        {.name = "exact"}, {.name = family->name, .hue = 1}, {.hue = 2, .secondary = true}};
    series[PAPER].name = job->published >= 0 ? lq_family_at(job->published)->source : "";
    const size_t first = residual ? FITTED : EXACT, last = job->published >= 0 ? PAPER : FITTED;
    lq_error error = {"no memory for the chart"};
    lq_status status = LQ_NO_MEMORY;
    if (memory) {
        fill(job, at, values, residual);
        for (int k = 0; k < SERIES; k++) {
            series[k].count = job->count;
            series[k].x = at;
            series[k].y = values[k];
        }
        const bool hg = job->request.mapping == LQ_MAP_HG;
        const lq_plot plot = {
            .title = residual ? "Relative error of the fits" : family->formula,
            .subtitle = lq_ndf_text(job->ndf),
            .x = {hg ? "g" : "alpha", !hg},
            .y = {residual ? "|fit / exact - 1|" : lq_mapping_name(job->request.mapping), true},
            .series = series + first,
            .series_count = last - first + 1};
        status = lq_plot_write(&plot, path, &error);
    }
    free(at);
    for (int k = 0; k < SERIES; k++) free(values[k]);
    return status == LQ_OK || (cli_fail_status(status, &error), false);
}

bool fit_write_report(const fit_job *job) {
    char other[1024];
    const char *path = job->request.report, *dot = strrchr(path, '.');
    const int stem = (int)(dot ? dot - path : (long)strlen(path));
    snprintf(other, sizeof other, "%.*s-residuals%s", stem, path, dot ? dot : "");
    return draw(job, path, false) && draw(job, other, true);
}
