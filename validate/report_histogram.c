/* report_histogram.c - how the errors of a certificate are distributed. */
#include "picture/plot.h"
#include "validate/report_maps.h"

#include <math.h>

enum { BINS = 36 };

/* Bins of a quarter decade from 1e-9 to 1; what is smaller counts for the first. */
static void count_bins(const lq_sampled *c, int stage, double *x, double *y) {
    const size_t values = c->points * (size_t)c->request.kind->channel_count;
    for (int b = 0; b < BINS; b++) {
        x[b] = pow(10.0, (b + 0.5) / 4.0 - 9.0);
        y[b] = 0.0;
    }
    for (size_t i = 0; i < values; i++) {
        const double at = 4.0 * (log10(fmax(fabs(c->decoded[stage][i] - c->exact[i]), 1e-30)) + 9.0);
        y[at < 0.0 ? 0 : at >= BINS ? BINS - 1 : (int)at] += 100.0 / (double)values;
    }
    for (int b = 0; b < BINS; b++)
        if (y[b] == 0.0 && (b == 0 || y[b - 1] == 0.0 || isnan(y[b - 1])) &&
            (b + 1 == BINS || y[b + 1] == 0.0))
            y[b] = NAN; /* an empty stretch is not drawn */
}

lq_status lq_report_histogram(const lq_sampled *c, FILE *out, lq_error *error) {
    double x[LQ_STAGES_MAX][BINS], y[LQ_STAGES_MAX][BINS];
    lq_plot_line series[LQ_STAGES_MAX];
    for (int s = 0; s < c->request.stage_count; s++) {
        count_bins(c, s, x[s], y[s]);
        series[s] = (lq_plot_line){.name = c->request.stages[s].name, .count = BINS, .x = x[s], .y = y[s]};
        series[s].curve = true;
        series[s].hue = s % LQ_PLOT_HUES;
        series[s].secondary = s >= LQ_PLOT_HUES;
    }
    const lq_plot plot = {.title = "Errors of the points",
                          .subtitle = "share of the points in each quarter of a decade",
                          .x = {"|decoded - exact|", true},
                          .y = {"% of the points", false},
                          .series = series,
                          .series_count = (size_t)c->request.stage_count};
    return lq_plot_draw(&plot, out, error);
}
