/* verb_validate.c - `lacquer validate`: a stored table against the exact solver and the random walk. */
#include "validate/verb_validate.h"

#include "cli/message.h"
#include "cli/options.h"
#include "cli/settings.h"
#include "validate/walk.h"
#include "validate/walk_kind.h"

#include <stdlib.h>

enum { AGAINST = 256, SAMPLES, POINTS, SEED, BUDGET, FORMAT };

static const cli_option options[] = {
    {AGAINST, "against", "exact|walk", "exact: the solver only; walk: random walks as well (default exact)"},
    {SAMPLES, "samples", "N", "random walks per point (default 100000)"},
    {POINTS, "points", "P", "points, half of them stored entries (default 256)"},
    {SEED, "seed", "S", "of the points and of the walks (default 1)"},
    {BUDGET, "budget", "E", "largest error that stored and interpolated values may have"},
    {FORMAT, "format", "text|json", "of the report (default text)"},
    CLI_THREADS_OPTION,
    {0},
};

static void print_notes(FILE *out) {
    fprintf(out,
            "Half of the points are stored entries, half lie anywhere between them; a third has mu <= 0.1\n"
            "and a third alpha <= 0.1. Compared are\n"
            "  stored - exact         the file against the solver at a tenth of its tolerance\n"
            "  interpolated - exact   the interpolation error between the nodes (judged by --budget only)\n"
            "  stored - walk          the file against random walks that share its NDF and Fresnel code, no "
            "more\n"
            "  exact - walk           the solver itself against them, between the nodes\n"
            "z is what a difference exceeds the stated tolerance by, in standard errors of the walk.\n"
            "Exit code 2: a stored value is off by more than its tolerance, z is larger than chance\n"
            "explains, or --budget is exceeded.\n");
}

static int run(int argc, char **argv);

const cli_verb cli_verb_validate = {
    .name = "validate",
    .summary = "check a stored table against the exact solver and random walks",
    .usage = "FILE [options]",
    .options = options,
    .notes = print_notes,
    .examples = "lacquer validate fgd.exr\n"
                "lacquer validate fgd.exr --against walk --samples 1000000 --points 64\n"
                "lacquer validate fgd.exr --budget 1e-3 --format json",
    .run = run,
};

static bool take_against(validate_request *request, const char *text) {
    static const char *const choices[] = {"exact", "walk"};
    const int choice = cli_parse_choice("--against", text, choices, 2);
    request->walk = choice == 1;
    return choice >= 0;
}

static bool take_format(validate_request *request, const char *text) {
    static const char *const choices[] = {"text", "json"};
    const int choice = cli_parse_choice("--format", text, choices, 2);
    request->json = choice == 1;
    return choice >= 0;
}

static bool take(validate_request *request, int id, const char *value) {
    size_t threads = 0;
    switch (id) {
    case AGAINST:
        return take_against(request, value);
    case SAMPLES:
        return cli_parse_count("--samples", value, 2, LQ_WALK_MAX_SAMPLES, &request->samples);
    case POINTS:
        return cli_parse_count("--points", value, 2, 10000000, &request->points);
    case SEED:
        return cli_parse_count("--seed", value, 0, SIZE_MAX, &request->seed);
    case BUDGET:
        return cli_parse_number("--budget", value, 1e-12, 1.0, &request->budget);
    case FORMAT:
        return take_format(request, value);
    case CLI_THREADS:
        if (!cli_parse_count("--threads", value, 1, 4096, &threads)) return false;
        request->threads = (int)threads;
        return true;
    default:
        break;
    }
    if (!request->file) {
        request->file = value;
        return true;
    }
    cli_message("one FILE at a time: '%s' after '%s'", value, request->file);
    return false;
}

static bool parse(validate_request *request, int argc, char **argv) {
    *request = (validate_request){.samples = 100000, .points = 256, .seed = 1};
    bool samples_given = false;
    cli_args args = cli_args_begin(&cli_verb_validate, argc, argv);
    for (int id; (id = cli_args_next(&args)) != CLI_END;) {
        if (id == CLI_BAD || !take(request, id, args.value)) return false;
        samples_given |= id == SAMPLES;
    }
    if (!request->file) cli_message("FILE is missing; see `lacquer validate --help`");
    else if (samples_given && !request->walk) cli_message("--samples needs --against walk");
    else return true;
    return false;
}

static lq_status load(validate_job *job, lq_error *error) {
    lq_status status = lq_table_read_exr(&job->table, job->request.file, error);
    if (status != LQ_OK) return status;
    lq_error cause = {""};
    status = lq_origin_of(job->table, &job->origin, &cause);
    if (status != LQ_OK)
        snprintf(error->text, sizeof error->text, "%.200s: %.300s", job->request.file, cause.text);
    else if (job->request.walk && !lq_walk_knows(job->origin.kind)) {
        status = LQ_BAD_INPUT;
        snprintf(error->text, sizeof error->text, "no random walk is known for table '%s'",
                 job->origin.kind->id);
    }
    job->origin.settings.threads = job->request.threads;
    return status;
}

static int report(const validate_job *job) {
    if (!job->request.json) validate_print_text(job);
    else if (!validate_print_json(job))
        return cli_fail("'%s' or its facts are not valid UTF-8", job->request.file);
    return validate_complaint(job) ? CLI_EXCEEDED : CLI_DONE;
}

static int run(int argc, char **argv) {
    validate_job job = {.table = NULL};
    if (!parse(&job.request, argc, argv)) return CLI_FAILED;
    lq_error error = {""};
    lq_status status = load(&job, &error);
    if (status == LQ_OK) {
        cli_progress bar;
        cli_progress_begin(&bar, job.origin.kind->id);
        status = validate_measure(&job, &bar.progress, &error);
        cli_progress_end(&bar);
    }
    const int code = status == LQ_OK ? report(&job) : cli_fail_status(status, &error);
    validate_free(&job);
    return code;
}
