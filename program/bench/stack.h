/* stack.h - what the files of `lacquer bench stack` share: the rows it measures. */
#ifndef LACQUER_PROGRAM_BENCH_STACK_H
#define LACQUER_PROGRAM_BENCH_STACK_H

#include "program/bench/bench.h"

enum { BENCH_STACK_COSINES = 64, BENCH_STACK_ROWS = 24 };
#define BENCH_STACK_WALK_COSINE 0.5

typedef struct bench_stack_row {
    char stack[LQ_STACK_NAME_SIZE];
    const char *method; /* solver, walk, table */
    double setting;     /* tolerance, or samples */
    size_t entries;     /* cosines; of a table all */
    int channels;
    size_t runs;
    double fastest, slowest; /* of the runs; wall clock, seconds */
    double cpu;              /* seconds of all threads in the fastest; far below wall x threads: others ran */
    double error;            /* largest estimate; of a walk the largest standard error */
    double off; /* of a solver: the largest difference from one ten times as fine, otherwise NAN; means over a
                 * lobe, like those of a walk, by its energy */
    double ratio; /* of a walk: its time at the solver's error / the solver's; of a solver of three channels:
                   * its time / that of the first channel alone; otherwise NAN */
    bool above;   /* an estimate is above the tolerance */
} bench_stack_row;

typedef struct bench_stack_job {
    const bench_job *job; /* seed, threads, longest_walk, full, csv */
    bench_stack_row rows[BENCH_STACK_ROWS];
    size_t row_count;
} bench_stack_job;

/* Seconds of as long a walk at each of the solver's cosines that is off by as much: that of a walk goes as
 * 1/sqrt(samples), its time as the samples. */
double bench_stack_walk_seconds(const bench_stack_row *solver, const bench_stack_row *walk);

void bench_stack_print(const bench_stack_job *b);
lq_status bench_stack_write_csv(const bench_stack_job *b, lq_error *error);

#endif
