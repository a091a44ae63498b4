/* print.c - the figures of `lacquer bench`: text, CSV and the chart. */
#include "program/bench/bench.h"

#include "picture/plot.h"
#include "system/output.h"
#include "tables/origin.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 192 };

/* The errors at which speeds are compared. */
static const double equal_errors[] = {1e-3, 1e-4, 1e-5};

void bench_describe_machine(int threads, char *text, size_t size) {
    char line[LINE], name[LINE] = "unknown processor";
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "model name", 10) == 0 && strchr(line, ':')) {
            line[strcspn(line, "\n")] = '\0';
            snprintf(name, sizeof name, "%s", strchr(line, ':') + 2);
            break;
        }
    if (file) fclose(file);
    snprintf(text, size, "lacquer %s%s, %d thread%s of %.100s", LQ_VERSION, LACQUER_COMMIT, threads,
             threads == 1 ? "" : "s", name);
}

static void describe_grid(const bench_job *job, char *text) {
    size_t used = 0;
    text[0] = '\0';
    for (int a = 0; a < job->kind->axis_count; a++)
        used += (size_t)snprintf(text + used, LINE - used, "%s%s %zu", a ? " x " : "", job->axes[a].name,
                                 job->axes[a].size);
}

const char *bench_method(const bench_row *row) {
    return row->walk ? "walk" : row->full ? "solver, full grid" : "solver";
}

static void print_ratio(const bench_job *job, double error) {
    const double walk = bench_walk_cost(job, error), solver = bench_solver_cost(job, error);
    if (isnan(solver)) printf("rms error %.0e: the solver stays above it\n", error);
    else if (isnan(walk))
        printf("rms error %.0e: solver %.2g s per entry; no walk is known\n", error, solver);
    else
        printf("rms error %.0e: solver %.2g s, walk %.2g s per entry: %.2g times faster\n", error, solver,
               walk, walk / solver);
}

void bench_print(const bench_job *job) {
    char table[LINE], machine[LINE], grid[LINE];
    lq_origin_describe(job->kind, &job->options.settings, table, sizeof table);
    bench_describe_machine(job->threads, machine, sizeof machine);
    describe_grid(job, grid);
    printf("%s; solver over %s nodes\n", table, grid);
    printf("errors at %zu entries, seed %zu, against the solver at %.0e\n%s\n\n", job->points, job->seed,
           job->reference_tolerance, machine);
    printf("%-18s %9s %12s %10s %12s %10s %10s\n", "method", "setting", "entries", "wall s", "CPU s/entry",
           "rms error", "max error");
    for (size_t i = 0; i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        printf("%-18s %9.0e %12zu %10.3g %12.3g %10.2e %10.2e\n", bench_method(row), row->setting,
               row->entries, row->seconds, row->cpu_per_entry, row->rms, row->max);
    }
    printf("\n");
    for (size_t i = 0; i < sizeof equal_errors / sizeof equal_errors[0]; i++)
        print_ratio(job, equal_errors[i]);
}

lq_status bench_write_csv(const bench_job *job, lq_error *error) {
    lq_output *file;
    lq_status status = lq_output_open(&file, job->csv, error);
    if (status != LQ_OK) return status;
    status = lq_output_print(file, error,
                             "table,method,setting,entries,threads,wall_seconds,cpu_seconds_per_entry,"
                             "rms_error,max_error\n");
    for (size_t i = 0; status == LQ_OK && i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        status = lq_output_print(file, error, "%s,%s,%g,%zu,%d,%.6g,%.6g,%.6g,%.6g\n", job->kind->id,
                                 row->walk   ? "walk"
                                 : row->full ? "solver-full"
                                             : "solver",
                                 row->setting, row->entries, job->threads, row->seconds, row->cpu_per_entry,
                                 row->rms, row->max);
    }
    if (status == LQ_OK) return lq_output_commit(file, error);
    lq_output_abandon(file);
    return status;
}

/* ======================================================================================
 *                                         Chart
 * ====================================================================================== */

typedef struct curve {
    size_t count;
    double cost[BENCH_MAX_ROWS], rms[BENCH_MAX_ROWS], max[BENCH_MAX_ROWS];
    char text[BENCH_MAX_ROWS][24];
    const char *labels[BENCH_MAX_ROWS];
} curve;

static void gather(const bench_job *job, bool walk, curve *c) {
    c->count = 0;
    for (size_t i = 0; i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        if (row->walk != walk || row->full) continue;
        const size_t k = c->count++;
        c->cost[k] = row->cpu_per_entry;
        c->rms[k] = row->rms;
        c->max[k] = row->max;
        lq_plot_power(c->text[k], (int)lround(log10(row->setting)));
        c->labels[k] = c->text[k];
    }
}

static void format_ratio(char *text, double ratio) {
    char power[24];
    const double exponent = floor(log10(ratio));
    lq_plot_power(power, (int)exponent);
    snprintf(text, LINE, "%.1f × %s times faster at error 10⁻⁴", ratio / pow(10.0, exponent), power);
}

lq_status bench_write_svg(const bench_job *job, lq_error *error) {
    curve solver, walk;
    gather(job, false, &solver);
    gather(job, true, &walk);
    const lq_plot_line series[] = {
        {"solver at tolerance, rms", solver.count, solver.cost, solver.rms, solver.labels, .hue = 0},
        {"largest", solver.count, solver.cost, solver.max, .hue = 0, .secondary = true},
        {"random walk of N samples, rms", walk.count, walk.cost, walk.rms, walk.labels, .hue = 1},
        {"largest", walk.count, walk.cost, walk.max, .hue = 1, .secondary = true},
    };
    char table[LINE], title[2 * LINE], machine[LINE], ratio[LINE];
    lq_origin_describe(job->kind, &job->options.settings, table, sizeof table);
    bench_describe_machine(job->threads, machine, sizeof machine);
    snprintf(title, sizeof title, "Speed against error: %s", table);
    lq_plot_span span = {.y = 1e-4, .label = ratio};
    span.x_from = bench_solver_cost(job, span.y);
    span.x_to = bench_walk_cost(job, span.y);
    const bool comparable = span.x_from > 0.0 && span.x_to > 0.0;
    if (comparable) format_ratio(ratio, span.x_to / span.x_from);
    const lq_plot plot = {.title = title,
                          .subtitle = machine,
                          .x = {"CPU seconds per entry", true},
                          .y = {"error", true},
                          .series = series,
                          .series_count = 4,
                          .span = comparable ? &span : NULL};
    return lq_plot_write(&plot, job->svg, error);
}
