/* report.c - what `lacquer pca` says about what it tried: a table, CSV, SVG. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "program/message.h"
#include "program/pca/pca.h"
#include "system/output.h"
#include "tables/plot.h"

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

static int by_bytes(const void *a, const void *b) {
    const lq_pca_try *x = a, *y = b;
    return (x->bytes > y->bytes) - (x->bytes < y->bytes);
}

static lq_status write_svg(const pca_request *request, const lq_pca_try *tries, size_t count,
                           lq_error *error) {
    lq_pca_try *sorted = malloc((count + 1) * sizeof *sorted);
    double *x = malloc(4 * (count + 1) * sizeof *x);
    if (!sorted || !x) {
        free(sorted);
        free(x);
        snprintf(error->text, sizeof error->text, "no memory for a chart");
        return LQ_NO_MEMORY;
    }
    double *max = x + count, *rms = max + count, *p99 = rms + count;
    memcpy(sorted, tries, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, by_bytes);
    for (size_t t = 0; t < count; t++) {
        x[t] = (double)sorted[t].bytes;
        max[t] = sorted[t].errors.max;
        p99[t] = sorted[t].errors.p99;
        rms[t] = sorted[t].errors.rms;
    }
    const lq_plot_line series[] = {{"max", count, x, max, NULL, 0, false},
                                   {"p99", count, x, p99, NULL, 1, false},
                                   {"rms", count, x, rms, NULL, 2, false}};
    const lq_plot plot = {.title = "error of the factors tried",
                          .subtitle = request->input,
                          .x = {"bytes in half floats", true},
                          .y = {"error", true},
                          .series = series,
                          .series_count = 3};
    const lq_status status = lq_plot_write(&plot, request->svg, error);
    free(sorted);
    free(x);
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
    if (status == LQ_OK && request->svg) status = write_svg(request, tries, count, &error);
    if (status != LQ_OK) cli_fail_status(status, &error);
    return status == LQ_OK;
}
