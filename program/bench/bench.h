/* bench.h - what the parts of `lacquer bench` share: the request and the rows it measures. */
#ifndef LACQUER_PROGRAM_BENCH_BENCH_H
#define LACQUER_PROGRAM_BENCH_BENCH_H

#include "program/settings.h"
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
    double longest_walk; /* samples; longer ones are left out */
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
void bench_describe_machine(int threads, char *text, size_t size);
/* How a row was made: "solver", "walk", "solver, full grid". */
const char *bench_method(const bench_row *row);

/* One table compressed one way. */
typedef struct bench_compression {
    const char *kind, *scheme;
    char separated[32]; /* "n+kappa:4" */
    size_t entries, table_bytes, bytes;
    double seconds;       /* CPU, without the table's */
    double rms, p99, max; /* as a GPU looks it up, against the table */
} bench_compression;

enum { BENCH_MAX_COMPRESSIONS = 64 };

/* Fresh tables, compressed with the schemes and numbers of bases of a fixed list; `only` of this kind, NULL:
 * all. */
lq_status bench_compress(const lq_kind *only, int threads, const lq_progress *progress,
                         bench_compression *list, size_t *count, lq_error *error);

/* The whole of `bench --report DIR`, of the kind of `like` or of all; returns the exit code. */
int bench_report(const char *folder, const bench_job *like);

/* `bench stack`, of the description in `path`, or (NULL) of those that are built in; `trusted`: it may open
 * files and plugins. Returns the exit code. */
int bench_stack(const bench_job *job, const char *path, bool trusted);

#endif
