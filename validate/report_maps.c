/* Error maps as coloured cells and histograms as curves. */
#include "validate/report_maps.h"

#include "tables/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 20, CELL = 14, DECADES = 9, BINS = 36 };

/* Half decades from 1e-5 up; one hue that grows darker, so that order is seen without colour. */
const char lq_report_map_style[] =
    ".e0{fill:#f2f0ea}.e1{fill:#e4e6ee}.e2{fill:#c9d6ec}.e3{fill:#a5bfe4}.e4{fill:#7aa3d9}.e5{fill:#4f84c9}"
    ".e6{fill:#2f63ad}.e7{fill:#1d4486}.e8{fill:#10295a}\n";

static int shade(double error) {
    const double half_decades = 2.0 * (log10(fmax(error, 1e-30)) + 5.0) + 1.0;
    return half_decades < 0.0 ? 0 : half_decades >= DECADES - 1 ? DECADES - 1 : (int)half_decades;
}

static size_t cell_of(const lq_domain *domain, int axis, double x) {
    const double u = (x - domain->min[axis]) / (domain->max[axis] - domain->min[axis]);
    const double at = fmin(fmax(u * CELLS, 0.0), CELLS - 1);
    return (size_t)at;
}

static void gather(const lq_sampled *c, int axis_x, int axis_y, double *most) {
    const size_t axes = (size_t)c->request.kind->axis_count;
    const double *decoded = c->decoded[c->request.stage_count - 1];
    for (size_t i = 0; i < (size_t)CELLS * CELLS; i++) most[i] = -1.0;
    for (size_t i = 0; i < c->points * (size_t)c->request.kind->channel_count; i++) {
        const double *at = c->at + i % c->points * axes;
        double *cell = &most[cell_of(&c->request.domain, axis_y, at[axis_y]) * CELLS +
                             cell_of(&c->request.domain, axis_x, at[axis_x])];
        *cell = fmax(*cell, fabs(decoded[i] - c->exact[i]));
    }
}

void lq_report_map(const lq_sampled *c, int axis_x, int axis_y, FILE *out) {
    const lq_axis_info *x = &c->request.kind->axes[axis_x], *y = &c->request.kind->axes[axis_y];
    const lq_domain *d = &c->request.domain;
    double most[CELLS * CELLS];
    gather(c, axis_x, axis_y, most);
    fprintf(out, "<svg class=\"map\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" role=\"img\">",
            CELLS * CELL + 54, CELLS * CELL + 44, CELLS * CELL + 54, CELLS * CELL + 44);
    fprintf(out, "<title>largest error over %s and %s</title>\n", x->name, y->name);
    for (int row = 0; row < CELLS; row++)
        for (int column = 0; column < CELLS; column++)
            if (most[row * CELLS + column] >= 0.0)
                fprintf(out, "<rect class=\"e%d\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/>",
                        shade(most[row * CELLS + column]), 48 + column * CELL, 4 + (CELLS - 1 - row) * CELL,
                        CELL, CELL);
    const int bottom = 4 + CELLS * CELL, right = 48 + CELLS * CELL;
    fprintf(out,
            "\n<text class=\"ink\" x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text>"
            "<text class=\"soft\" x=\"48\" y=\"%d\">%.3g</text>"
            "<text class=\"soft\" x=\"%d\" y=\"%d\" text-anchor=\"end\">%.3g</text>",
            (48 + right) / 2, bottom + 32, x->name, bottom + 16, d->min[axis_x], right, bottom + 16,
            d->max[axis_x]);
    fprintf(out,
            "<text class=\"ink\" x=\"40\" y=\"%d\" text-anchor=\"end\">%s</text>"
            "<text class=\"soft\" x=\"42\" y=\"%d\" text-anchor=\"end\">%.3g</text>"
            "<text class=\"soft\" x=\"42\" y=\"14\" text-anchor=\"end\">%.3g</text></svg>\n",
            bottom / 2, y->name, bottom, d->min[axis_y], d->max[axis_y]);
}

/* --------------------------------------------------------------------------------- histograms */

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
