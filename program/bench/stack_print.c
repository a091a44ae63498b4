/* stack_print.c - the figures of `lacquer bench stack`: text and CSV. */
#include "program/bench/stack.h"

#include "system/output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 192 };

static bool is(const bench_stack_row *row, const char *method) {
    return strcmp(row->method, method) == 0;
}

static void print_row(const bench_stack_row *row) {
    printf("%-24s %-7s %8.0e %8zu %9d %6zu %10.3g %10.3g %8.3g %10.2e", row->stack, row->method, row->setting,
           row->entries, row->channels, row->runs, row->fastest, row->slowest, row->cpu, row->error);
    if (isfinite(row->off)) printf(" %10.2e", row->off);
    printf("\n");
}

/* The solver's row of the same stack comes before the walk's. */
static const bench_stack_row *solver_of(const bench_stack_job *b, size_t walk) {
    size_t i = walk;
    while (i > 0 && is(&b->rows[i - 1], "solver") && strcmp(b->rows[i - 1].stack, b->rows[walk].stack) == 0)
        i--;
    return &b->rows[i];
}

static void print_ratio(const bench_stack_job *b, size_t i) {
    const bench_stack_row *row = &b->rows[i];
    if (!isfinite(row->ratio)) return;
    if (is(row, "solver")) {
        printf("%s: %d channels take %.2f times as long as one\n", row->stack, row->channels, row->ratio);
        return;
    }
    const bench_stack_row *solver = solver_of(b, i);
    printf("%s: off by %.1e, %zu cosines: solver %.2g s, walk %.2g s: %.2g times faster\n", row->stack,
           solver->off, solver->entries, solver->fastest, bench_stack_walk_seconds(solver, row), row->ratio);
}

void bench_stack_print(const bench_stack_job *b) {
    char machine[LINE];
    bench_describe_machine(b->job->threads, machine, sizeof machine);
    printf("stacks at %d cosines; walks of %.0f samples at cosine %g, seed %zu\n%s\n\n", BENCH_STACK_COSINES,
           b->job->longest_walk, BENCH_STACK_WALK_COSINE, b->job->seed, machine);
    printf("%-24s %-7s %8s %8s %9s %6s %10s %10s %8s %10s %10s\n", "stack", "method", "setting", "entries",
           "channels", "runs", "fastest s", "slowest s", "CPU s", "error", "off by");
    for (size_t i = 0; i < b->row_count; i++) print_row(&b->rows[i]);
    printf("\n");
    for (size_t i = 0; i < b->row_count; i++) print_ratio(b, i);
    printf(
        "\nSeconds are wall clock, CPU those of all threads in the fastest run. The error of a solver is\n"
        "its largest estimate, that of a walk its largest standard error; a solver is off by its largest\n"
        "difference from one ten times as fine (means over a lobe, of both: times its energy). The time of\n"
        "a walk that is off by as much is extrapolated: fastest x (its error / off by)^2 x cosines.\n");
}

static lq_status write_row(const bench_stack_job *b, const bench_stack_row *row, lq_output *file,
                           lq_error *error) {
    char ratio[32] = "", off[32] = "", name[LQ_STACK_NAME_SIZE];
    if (isfinite(row->ratio)) snprintf(ratio, sizeof ratio, "%.6g", row->ratio);
    if (isfinite(row->off)) snprintf(off, sizeof off, "%.6g", row->off);
    snprintf(name, sizeof name, "%s", row->stack);
    for (char *at = name; *at; at++)
        if (strchr(",\"\r\n", *at)) *at = '_'; /* a name may be any text, a field may not */
    return lq_output_print(file, error, "%s,%s,%g,%zu,%d,%d,%zu,%.6g,%.6g,%.6g,%.6g,%s,%s\n", name,
                           row->method, row->setting, row->entries, row->channels, b->job->threads, row->runs,
                           row->fastest, row->slowest, row->cpu, row->error, off, ratio);
}

lq_status bench_stack_write_csv(const bench_stack_job *b, lq_error *error) {
    lq_output *file;
    lq_status status = lq_output_open(&file, b->job->csv, error);
    if (status != LQ_OK) return status;
    status = lq_output_print(file, error,
                             "stack,method,setting,entries,channels,threads,runs,wall_seconds,"
                             "slowest_seconds,cpu_seconds,error,off,ratio\n");
    for (size_t i = 0; status == LQ_OK && i < b->row_count; i++)
        status = write_row(b, &b->rows[i], file, error);
    if (status == LQ_OK) return lq_output_commit(file, error);
    lq_output_abandon(file);
    return status;
}
