/* verb_bench.h - what the parts of `lacquer bench` share: the request and the rows it measures. */
#ifndef LACQUER_VALIDATE_VERB_BENCH_H
#define LACQUER_VALIDATE_VERB_BENCH_H

#include "cli/settings.h"
#include "validate/draw.h"

#include <stdbool.h>

enum { BENCH_MAX_ROWS = 16 };

typedef struct bench_row {
    bool walk, full;      /* a random walk; the default grid instead of the small one */
    double setting;       /* tolerance, or samples */
    size_t entries;       /* that the time was measured over */
    double seconds;       /* wall clock */
    double cpu_per_entry; /* seconds x threads / entries */
    double rms, max;      /* of the error against the reference */
} bench_row;

typedef struct bench_job {
    const lq_kind *kind;
    cli_settings options;
    const char *csv, *svg;
    size_t points, seed;
    bool full;
    int threads;
    lq_axis axes[LQ_MAX_AXES];
    double reference_tolerance, reference_error; /* asked for; the largest estimate that came back */
    bench_row rows[BENCH_MAX_ROWS];
    size_t row_count;
} bench_job;

/* Run everything and fill the rows. */
lq_status bench_measure(bench_job *job, const lq_progress *progress, lq_error *error);

/* CPU seconds per entry at an rms error. The walk: error ~ 1/sqrt(N), from all its rows. The solver:
 * log-log between its rows; an error above that of its fastest row costs what that row costs. NAN: the
 * solver did not reach it. */
double bench_walk_cost(const bench_job *job, double error);
double bench_solver_cost(const bench_job *job, double error);

/* A row that is off by more than its tolerance, or NULL. */
const bench_row *bench_broken_row(const bench_job *job);

void bench_print(const bench_job *job);
lq_status bench_write_csv(const bench_job *job, lq_error *error);
lq_status bench_write_svg(const bench_job *job, lq_error *error);

#endif
