/* bench.c - `lacquer bench`: speed against error of the solver and of the random walk. */
#include "program/bench/bench.h"

#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/progress.h"

#include <omp.h>
#include <string.h>

enum { CSV = 256, SVG, POINTS, SEED, FULL, LONGEST, REPORT, STACK_FILE };

/* Modes: one table, the report of all, or stacks. */
enum { ONE = 1, ALL = 2, STACK = 4 };

typedef struct bench_request {
    bench_job job;
    cli_settings settings;
    size_t threads, samples;
    const char *report;
    bool of_stack; /* the word was "stack" */
    const char *stack;
    lq_trust trust;
} bench_request;

static const cli_option options[] = {
    {CSV, "csv", "FILE", "write the table as CSV as well", CLI_TEXT(bench_request, job.csv),
     .modes = ONE | STACK},
    {SVG, "svg", "FILE", "write a log-log chart", CLI_TEXT(bench_request, job.svg), .modes = ONE},
    {POINTS, "points", "P", "entries at which errors are measured (default 64)",
     CLI_COUNT(bench_request, job.points, 2, 100000), .modes = ONE | ALL},
    {SEED, "seed", "S", "of the points and of the walks (default 1)",
     CLI_COUNT(bench_request, job.seed, 0, (double)SIZE_MAX)},
    {LONGEST, "samples", "N", "of the longest walk, up to 1e6 (default 1000000)",
     CLI_COUNT(bench_request, samples, 1000, 1000000)},
    {REPORT, "report", "DIR", "all tables, walks and compressions afresh, as one page: DIR/index.html",
     CLI_TEXT(bench_request, report), .modes = ONE | ALL},
    {FULL, "full", NULL,
     "also the default grid (fgd: 64 x 64 x 64 x 64) and tolerance 1e-7; stack: a table of 64 x 64",
     CLI_FLAG(bench_request, job.full), .modes = ONE | STACK},
    {STACK_FILE, "stack", "FILE.json", "of stack: these layers instead of those built in",
     CLI_TEXT(bench_request, stack), .modes = STACK},
    CLI_NDF_OPTION(bench_request, ONE | ALL),
    CLI_SCATTERING_OPTION(bench_request, ONE),
    CLI_MASKING_OPTION(bench_request, ONE),
    CLI_ALLOW_PLUGIN_OPTION(bench_request, STACK),
    CLI_THREADS_OPTION(bench_request, 0),
    {0},
};

static void print_notes(FILE *out) {
    fprintf(
        out,
        "TABLE is an id of `lacquer list` (default fgd). The solver fills a grid at several tolerances,\n"
        "the random walk computes some of its entries with several sample counts; the errors of both are\n"
        "taken against the solver at its finest. Times are CPU seconds per entry: wall clock x threads.\n"
        "Exit code 2: a value of the solver is off by more than its tolerance.\n"
        "bench stack times the solver of stacks at tolerance 1e-4 and 64 cosines, a random walk at one,\n"
        "and, of a stack in RGB, one channel of it; times are wall clock. See docs/bench.md.\n");
}

static int run(int argc, char **argv);

const cli_verb cli_verb_bench = {
    .name = "bench",
    .summary = "speed against error of the solver and of the random walk",
    .usage = "[TABLE] [options]\n[TABLE] --report DIR [--points P] [--samples N]\nstack [--stack FILE.json] "
             "[--samples N] [--full] [--csv FILE]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer bench\n"
                "lacquer bench fgd --full --csv bench.csv --svg bench.svg\n"
                "lacquer bench albedo --points 200\n"
                "lacquer bench --report bench --points 32 --samples 100000\n"
                "lacquer bench stack --csv stacks.csv\n"
                "lacquer bench stack --stack recipes/stacks/slab.json --full",
    .run = run,
};

static bool take_table(void *user, const char *id) {
    bench_request *request = user;
    bench_job *job = &request->job;
    lq_error error = {""};
    if (job->kind || request->of_stack) {
        cli_message("unexpected '%s'; bench takes one TABLE", id);
        return false;
    }
    if (strcmp(id, "stack") == 0) return request->of_stack = true;
    job->kind = lq_kind_find(id, &error);
    if (!job->kind) cli_message("%s", error.text);
    return job->kind != NULL;
}

static bool parse(bench_request *request, int argc, char **argv) {
    bench_job *job = &request->job;
    cli_given given;
    if (!cli_parse(&cli_verb_bench, argc, argv, request, take_table, &given)) return false;
    job->threads = request->threads > 0 ? (int)request->threads : omp_get_max_threads();
    job->longest_walk = (double)request->samples;
    job->options = request->settings;
    job->options.settings.threads = job->threads;
    if (request->of_stack)
        return cli_suits(&given, STACK, "for stacks") && (!job->csv || cli_output_check(job->csv));
    if (request->report)
        return cli_suits(&given, ALL, "with --report, which runs every table and scattering");
    if (!cli_suits(&given, ONE, "for a table")) return false;
    if (!job->kind && !take_table(request, "fgd")) return false;
    if (!cli_settings_suit(&given, job->kind)) return false;
    return (!job->csv || cli_output_check(job->csv)) && (!job->svg || cli_output_check(job->svg));
}

static int report(const bench_job *job) {
    lq_error error = {""};
    lq_status status = LQ_OK;
    bench_print(job);
    if (job->csv) status = bench_write_csv(job, &error);
    if (status == LQ_OK && job->svg) status = bench_write_svg(job, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    const bench_row *broken = bench_broken_row(job);
    if (!broken) return CLI_DONE;
    cli_message("at tolerance %g the largest error is %.2e", broken->setting, broken->max);
    return CLI_EXCEEDED;
}

static int run(int argc, char **argv) {
    bench_request request = {
        .job = {.points = 64, .seed = 1}, .settings = cli_settings_default(), .samples = 1000000};
    bench_job *job = &request.job;
    if (!parse(&request, argc, argv)) return CLI_FAILED;
    if (request.of_stack) return bench_stack(job, request.stack, request.trust.plugins);
    if (request.report) return bench_report(request.report, job);
    lq_error error = {""};
    cli_progress bar;
    cli_progress_begin(&bar, "bench");
    const lq_status status = bench_measure(job, &bar.progress, &error);
    cli_progress_end(&bar);
    const int code = status == LQ_OK ? report(job) : cli_fail_status(status, &error);
    for (int i = 0; i < job->kind->axis_count; i++) lq_axis_free(&job->axes[i]);
    return code;
}
