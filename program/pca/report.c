/* report.c - what `lacquer pca` says about what it tried: a table, CSV, SVG. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/plot.h"
#include "program/message.h"
#include "program/output.h"
#include "program/pca/pca.h"
#include "system/output.h"
#include "system/status.h"

static const char *const value_names[LQ_VALUES] = {"plain", "square", "beer"};

/* Append to a text of `size` bytes; what does not fit is cut. */
__attribute__((format(printf, 3, 4))) static void append(char *text, size_t size, const char *format, ...) {
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

void pca_describe(const lq_table *table, const lq_pca_options *o, char *text, size_t size) {
    snprintf(text, size, "%s", o->scheme == LQ_SEQUENTIAL ? "sequential" : value_names[o->value]);
    for (int i = 0; i < o->separation_count; i++) {
        append(text, size, i > 0 ? "|" : " ");
        for (int j = 0; j < o->separations[i].axis_count; j++)
            append(text, size, "%s%s", j > 0 ? "+" : "", table->axes[o->separations[i].axes[j]].name);
        if (o->scheme == LQ_SEQUENTIAL || o->bases[0] == 0)
            append(text, size, ":%zu", o->separations[i].bases);
    }
    if (o->scheme == LQ_JOINT && o->bases[0] > 0) append(text, size, " %zu", o->bases[0]);
    if (o->scheme == LQ_JOINT && o->value == LQ_VALUE_BEER) append(text, size, "+%zu", o->bases[1]);
    if (o->scheme == LQ_JOINT && o->separation_count > 1) append(text, size, " pairs %zu", o->pairs);
    if (o->critical) append(text, size, " critical");
    for (int a = 0; a < table->axis_count; a++)
        if (o->texels[a] > 0) append(text, size, " %s=%zu", table->axes[a].name, o->texels[a]);
}

/* ------------------------------------------------------------------ stdout */

static void print_worst(const lq_table *table, const lq_pca_errors *errors) {
    for (int a = 0; a < table->axis_count; a++)
        if (table->axes[a].size > 1) printf(" %s=%.4g", table->axes[a].name, errors->worst[a]);
}

static void print_tries(const lq_table *table, const lq_pca_try *tries, size_t count) {
    printf("%5s  %-44s %9s %9s %9s %9s  worst point\n", "piece", "factors", "bytes", "rms", "p99", "max");
    for (size_t t = 0; t < count; t++) {
        char text[160];
        pca_describe(table, &tries[t].options, text, sizeof text);
        printf("%c%4d  %-44s %9zu %9.2e %9.2e %9.2e ", tries[t].chosen ? '*' : ' ', tries[t].piece + 1, text,
               tries[t].bytes, tries[t].errors.rms, tries[t].errors.p99, tries[t].errors.max);
        print_worst(table, &tries[t].errors);
        putchar('\n');
    }
}

/* ------------------------------------------------------------------ files */

static lq_status write_csv(const char *path, const lq_table *table, const lq_pca_try *tries, size_t count,
                           lq_error *error) {
    lq_output *out;
    lq_status status = lq_output_open(&out, path, error);
    if (status != LQ_OK) return status;
    status = lq_output_print(out, error, "piece,factors,bytes,points,rms,p99,max");
    for (int a = 0; a < table->axis_count && status == LQ_OK; a++)
        status = lq_output_print(out, error, ",worst_%s", table->axes[a].name);
    if (status == LQ_OK) status = lq_output_print(out, error, ",chosen\n");
    for (size_t t = 0; t < count && status == LQ_OK; t++) {
        const lq_pca_errors *e = &tries[t].errors;
        char text[160];
        pca_describe(table, &tries[t].options, text, sizeof text);
        status = lq_output_print(out, error, "%d,%s,%zu,%zu,%.6g,%.6g,%.6g", tries[t].piece + 1, text,
                                 tries[t].bytes, e->points, e->rms, e->p99, e->max);
        for (int a = 0; a < table->axis_count && status == LQ_OK; a++)
            status = lq_output_print(out, error, ",%.9g", e->worst[a]);
        if (status == LQ_OK) status = lq_output_print(out, error, ",%d\n", tries[t].chosen);
    }
    if (status == LQ_OK) return lq_output_commit(out, error);
    lq_output_abandon(out);
    return status;
}

/* ------------------------------------------------------------------- chart */

static double norm_of(const lq_pca_try *t, lq_pca_norm norm) {
    return norm == LQ_PCA_RMS ? t->errors.rms : norm == LQ_PCA_P99 ? t->errors.p99 : t->errors.max;
}

static int by_bytes(const void *a, const void *b) {
    const lq_pca_try *x = a, *y = b;
    return (x->bytes > y->bytes) - (x->bytes < y->bytes);
}

enum { TRIED, FRONTIER, CHOSEN, SERIES };

/* Points of the chart and their names. */
typedef struct chart {
    size_t count[SERIES];
    double *x[SERIES], *y[SERIES];
    char (*names)[160];
    const char **labels[SERIES];
} chart;

static bool chart_open(chart *c, size_t count) {
    bool fine = (c->names = calloc(count + 1, sizeof *c->names)) != NULL;
    for (int k = 0; k < SERIES; k++) {
        fine = (c->x[k] = calloc(count + 1, sizeof(double))) && fine;
        fine = (c->y[k] = calloc(count + 1, sizeof(double))) && fine;
        fine = (c->labels[k] = calloc(count + 1, sizeof(char *))) && fine;
    }
    return fine;
}

static void chart_close(chart *c) {
    for (int k = 0; k < SERIES; k++) {
        free(c->x[k]);
        free(c->y[k]);
        free(c->labels[k]);
    }
    free(c->names);
}

static void add_point(chart *c, int series, const lq_pca_try *t, double error, const char *name) {
    const size_t i = c->count[series]++;
    c->x[series][i] = (double)t->bytes;
    c->y[series][i] = error;
    c->labels[series][i] = name;
}

/* On the frontier: fewer bytes are nowhere as exact. `sorted` by bytes. */
static void gather(chart *c, const lq_table *table, const lq_pca_try *sorted, size_t count,
                   lq_pca_norm norm) {
    double least = INFINITY;
    size_t chosen = 0;
    for (size_t i = 0; i < count; i++)
        if (sorted[i].chosen) chosen = sorted[i].bytes;
    for (size_t i = 0; i < count; i++) {
        const double error = norm_of(&sorted[i], norm);
        pca_describe(table, &sorted[i].options, c->names[i], sizeof c->names[i]);
        add_point(c, TRIED, &sorted[i], error, NULL);
        if (sorted[i].chosen) add_point(c, CHOSEN, &sorted[i], error, c->names[i]);
        if (!(error < least)) continue;
        least = error;
        add_point(c, FRONTIER, &sorted[i], error, sorted[i].bytes == chosen ? NULL : c->names[i]);
    }
}

static lq_status draw_svg(const pca_request *request, const chart *c, lq_error *error) {
    static const char *const norms[] = {
        [LQ_PCA_RMS] = "rms error", [LQ_PCA_P99] = "p99 of the error", [LQ_PCA_MAX] = "largest error"};
    static const char *const names[SERIES] = {"tried", "no smaller is better", "chosen"};
    static const int hues[SERIES] = {[TRIED] = 0, [FRONTIER] = 2, [CHOSEN] = 1};
    char budget[64];
    lq_plot_line series[SERIES];
    for (int k = 0; k < SERIES; k++)
        series[k] = (lq_plot_line){.name = names[k],
                                   .count = c->count[k],
                                   .x = c->x[k],
                                   .y = c->y[k],
                                   .labels = c->labels[k],
                                   .hue = hues[k],
                                   .scatter = k == TRIED};
    snprintf(budget, sizeof budget, "budget %g", request->budget);
    const lq_plot_rule rule = {request->budget, budget};
    const lq_plot plot = {.title = "Bytes against error of the factors tried",
                          .subtitle = cli_basename(request->input),
                          .x = {"bytes in half floats", true},
                          .y = {norms[request->norm], true},
                          .series = series,
                          .series_count = SERIES,
                          .rule = request->budget > 0.0 ? &rule : NULL};
    return lq_plot_write(&plot, request->svg, error);
}

static lq_status write_svg(const pca_request *request, const lq_table *table, const lq_pca_try *tries,
                           size_t count, lq_error *error) {
    lq_pca_try *sorted = malloc((count + 1) * sizeof *sorted);
    chart c = {.names = NULL};
    lq_status status = LQ_OK;
    if (!chart_open(&c, count) || !sorted) status = lq_fail(error, LQ_NO_MEMORY, "no memory for a chart");
    if (status == LQ_OK) {
        memcpy(sorted, tries, count * sizeof *sorted);
        qsort(sorted, count, sizeof *sorted, by_bytes);
        gather(&c, table, sorted, count, request->norm);
        status = draw_svg(request, &c, error);
    }
    chart_close(&c);
    free(sorted);
    return status;
}

bool pca_report(const pca_request *request, const lq_table *table, const lq_pca_try *tries, size_t count,
                const pca_exact *exact) {
    lq_error error = {""};
    printf("errors of half floats, filtered with 8 fractional bits, against %s", exact->from);
    if (exact->solver) printf(" (seed %zu)", request->seed);
    putchar('\n');
    print_tries(table, tries, count);
    lq_status status = LQ_OK;
    if (request->csv) status = write_csv(request->csv, table, tries, count, &error);
    if (status == LQ_OK && request->svg) status = write_svg(request, table, tries, count, &error);
    if (status != LQ_OK) cli_fail_status(status, &error);
    return status == LQ_OK;
}
