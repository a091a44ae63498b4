/* bench.c - `lacquer bench`: speed against error of the solver and of the random walk. */
#include "program/bench/bench.h"

#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/progress.h"

#include <omp.h>

enum { CSV = 256, SVG, POINTS, SEED, FULL, LONGEST, REPORT };

typedef struct bench_request {
    bench_job job;
    const char *report;
} bench_request;

static const cli_option options[] = {
    {CSV, "csv", "FILE", "write the table as CSV as well"},
    {SVG, "svg", "FILE", "write a log-log chart"},
    {POINTS, "points", "P", "entries at which errors are measured (default 64)"},
    {SEED, "seed", "S", "of the points and of the walks (default 1)"},
    {LONGEST, "samples", "N", "of the longest walk, up to 1e6 (default 1000000)"},
    {REPORT, "report", "DIR", "all tables, walks and compressions afresh, as one page: DIR/index.html"},
    {FULL, "full", NULL, "also the default grid (fgd: 64 x 64 x 64 x 64) and tolerance 1e-7"},
    {CLI_NDF, "ndf", "NDF", "distribution of microfacet normals, see `lacquer list` (default ggx)"},
    {CLI_SCATTERING, "scattering", "single|multiple", "hits on the microsurface (default multiple)"},
    {CLI_MASKING, "masking", "correlated|separable", "Smith masking (default correlated)"},
    CLI_THREADS_OPTION,
    {0},
};

static void print_notes(FILE *out) {
    fprintf(
        out,
        "TABLE is an id of `lacquer list` (default fgd). The solver fills a grid at several tolerances,\n"
        "the random walk computes some of its entries with several sample counts; the errors of both are\n"
        "taken against the solver at its finest. Times are CPU seconds per entry: wall clock x threads.\n"
        "Exit code 2: a value of the solver is off by more than its tolerance.\n");
}

static int run(int argc, char **argv);

const cli_verb cli_verb_bench = {
    .name = "bench",
    .summary = "speed against error of the solver and of the random walk",
    .usage = "[TABLE] [options]\n[TABLE] --report DIR [--points P] [--samples N]",
    .options = options,
    .notes = print_notes,
    .examples = "lacquer bench\n"
                "lacquer bench fgd --full --csv bench.csv --svg bench.svg\n"
                "lacquer bench albedo --points 200\n"
                "lacquer bench --report bench --points 32 --samples 100000",
    .run = run,
};

static bool take_table(bench_job *job, const char *id) {
    lq_error error = {""};
    if (job->kind) {
        cli_message("unexpected '%s'; bench takes one TABLE", id);
        return false;
    }
    job->kind = lq_kind_find(id, &error);
    if (!job->kind) cli_message("%s", error.text);
    return job->kind != NULL;
}

static bool take(bench_request *request, int id, const char *value) {
    bench_job *job = &request->job;
    size_t samples;
    const int taken = cli_settings_take(&job->options, id, value);
    if (taken != 0) return taken > 0;
    switch (id) {
    case CSV:
        job->csv = value;
        return true;
    case SVG:
        job->svg = value;
        return true;
    case REPORT:
        request->report = value;
        return true;
    case POINTS:
        return cli_parse_count("--points", value, 2, 100000, &job->points);
    case LONGEST:
        if (!cli_parse_count("--samples", value, 1000, 1000000, &samples)) return false;
        job->longest_walk = (double)samples;
        return true;
    case SEED:
        return cli_parse_count("--seed", value, 0, SIZE_MAX, &job->seed);
    case FULL:
        job->full = true;
        return true;
    default:
        return take_table(job, value);
    }
}

/* A report runs tables in every way they can be made. */
static bool suits_report(const bench_request *request) {
    const bench_job *job = &request->job;
    const char *given = job->options.given[CLI_SCATTERING - CLI_NDF] ? "--scattering"
                        : job->options.given[CLI_MASKING - CLI_NDF]  ? "--masking"
                        : job->csv                                   ? "--csv"
                        : job->svg                                   ? "--svg"
                        : job->full                                  ? "--full"
                                                                     : NULL;
    if (given)
        cli_message("--report runs every sort of scattering and writes its own files: leave out %s", given);
    return !given;
}

static bool parse(bench_request *request, int argc, char **argv) {
    bench_job *job = &request->job;
    cli_args args = cli_args_begin(&cli_verb_bench, argc, argv);
    for (int id; (id = cli_args_next(&args)) != CLI_END;)
        if (id == CLI_BAD || !take(request, id, args.value)) return false;
    job->threads = job->options.settings.threads > 0 ? job->options.settings.threads : omp_get_max_threads();
    job->options.settings.threads = job->threads;
    if (request->report) return suits_report(request);
    if (!job->kind && !take_table(job, "fgd")) return false;
    if (!cli_settings_suit(&job->options, job->kind)) return false;
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
        .job = {.options = cli_settings_default(), .points = 64, .seed = 1, .longest_walk = 1e6}};
    bench_job *job = &request.job;
    if (!parse(&request, argc, argv)) return CLI_FAILED;
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
