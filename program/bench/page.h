/* page.h - what `lacquer bench --report` measured, and the page of it. */
#ifndef LACQUER_PROGRAM_BENCH_PAGE_H
#define LACQUER_PROGRAM_BENCH_PAGE_H

#include "program/bench/bench.h"

enum { BENCH_NAME = 96 };

typedef struct bench_page {
    const char *folder;
    bench_job *jobs;
    size_t job_count;
    bench_compression compressions[BENCH_MAX_COMPRESSIONS];
    size_t compression_count;
    char machine[192];
} bench_page;

/* What tells two jobs apart, fit for a file name. */
void bench_name(const bench_job *job, char *name);

/* folder/index.html, whose charts are files beside it. */
lq_status bench_write_page(const bench_page *page, lq_error *error);

#endif
