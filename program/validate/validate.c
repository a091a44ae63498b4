/* validate.c - `lacquer validate`: a stored table against the exact solver and the random walk. */
#include "program/validate/validate.h"

#include "program/crew.h"
#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/settings.h"
#include "validate/walk.h"
#include "validate/walk_kind.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    AGAINST = 256,
    SAMPLES,
    POINTS,
    SEED,
    BUDGET,
    FORMAT,
    JSON,
    LAYOUT,
    KIND,
    AXES,
    DIAGNOSE,
    SLICES,
    SET,
    TABLES,
    MODEL
};

static void print_notes(FILE *out) {
    fprintf(
        out,
        "Half of the points are stored entries, half lie anywhere between them; a third has mu <= 0.1\n"
        "and a third alpha <= 0.1. Compared are\n"
        "  stored - exact         the file against the solver at a tenth of its tolerance\n"
        "  interpolated - exact   the interpolation error between the nodes (judged by --budget only)\n"
        "  stored - walk          the file against random walks that share its NDF and Fresnel code, no "
        "more\n"
        "  exact - walk           the solver itself against them, between the nodes\n"
        "z is what a difference exceeds the stated tolerance by, in standard errors of the walk.\n"
        "Exit code 2: a stored value is off by more than its tolerance, z is larger than chance\n"
        "explains, or --budget is exceeded.\n\n"
        "With --against OTHER, OTHER minus FILE is taken at every node of OTHER, or at --points P of them\n"
        "drawn at random; where FILE has other nodes, what it says it holds is computed there. A published\n"
        "FILE alone is compared with the solver; --ndf, --scattering, --masking and --tolerance say what\n"
        "to compute, because it does not. An NDF from a file or plugin that another FILE records is opened\n"
        "only if --ndf names it. Noise of independent samples is uncorrelated between\n"
        "neighbours, a bias is not. What differs is held against the known other definitions. Exit code\n"
        "2: --budget is exceeded or, without one, neither the tolerances nor such noise explain the\n"
        "difference. docs/foreign.md describes AXES.json.\n\n"
        "A certificate (--certificate, a budget by norm, --on, --junit, --report) takes 100000 exact values\n"
        "anywhere between the nodes, uniform over the axes, searches for the worst point, states the\n"
        "confidence of p99 and of the largest error, and checks physics; FILE is a table or the factors\n"
        "of one, DIR a folder of them. docs/certificates.md describes it and the budget file.\n\n"
        "stack FILE.json compares what `lacquer stack` says with random walks of single rays, --samples N a\n"
        "cosine and channel: energies, sin2, mean and across of the light on both sides. z is what a\n"
        "difference exceeds the solver's error estimate by, in standard errors of the walk. Exit code 2: z\n"
        "is larger than chance explains, or the solver did not reach --tolerance (default 1e-4).\n"
        "With --slices DIR the walks are counted by direction instead, 90 x 360 cells of it or of the half\n"
        "vector, and energies are compared by how often light met the first interface.\n\n"
        "layered measures models of layered materials on a set of stacks: RMSE of their lobes against\n"
        "slices of --samples walks, energies and moments against the exact solver. Finished stacks are kept\n"
        "in the report's folder and taken up where all settings are the same. docs/layered.md.\n");
}

/* Modes. */
enum {
    OWN = 1,          /* FILE of this program, against the solver */
    WALKED = 2,       /* and against walks */
    OTHERS = 4,       /* against another table */
    PUBLISHED = 8,    /* a published FILE alone */
    DESCRIBED = 16,   /* anybody's, --axes */
    DIAGNOSED = 32,   /* --diagnose */
    CERTIFIED = 64,   /* a certificate */
    HARD_CASES = 128, /* no file at all */
    STACKED = 256,    /* a stack's description, against walks */
    LAYERED = 512     /* models of layered materials, on a set of stacks */
};

static bool read_against(void *field, const char *text) {
    validate_request *request = field;
    request->walk = strcmp(text, "walk") == 0;
    request->other = NULL;
    if (request->walk || strcmp(text, "exact") == 0) return true;
    request->other = text;
    if (access(text, R_OK) == 0) return true;
    cli_message("--against: '%s' is not exact, walk or a file that can be read", text);
    return false;
}

static bool read_budget(void *field, const char *value) {
    validate_request *request = field;
    if (strchr(value, '=') || !cli_number(value, &request->budget))
        return certify_take_budget(&request->certify, value);
    return cli_parse_number("--budget", value, 1e-12, 1.0, &request->budget);
}

static bool read_domain(void *field, const char *value) {
    return certify_take_domain(field, value);
}

static const char *const formats[] = {"text", "json", NULL};

static const cli_option options[] = {
    {AGAINST, "against", "exact|walk|OTHER",
     "the solver; random walks as well; another table, EXR or published (default exact)",
     .type = CLI_TYPE_READ, .read = read_against, .modes = OWN | WALKED | OTHERS | PUBLISHED},
    {LAYOUT, "layout", "belcour|tm|mitsuba|mitsuba-inside", "OTHER, or FILE alone, is a published table",
     CLI_READ(validate_request, layout, cli_read_layout), .modes = OTHERS | PUBLISHED},
    {KIND, "kind", "TABLE", "which table that file holds; it does not say itself",
     CLI_TEXT(validate_request, kind), .modes = OTHERS | PUBLISHED},
    {AXES, "axes", "AXES.json", "FILE is a .npy, EXR or C array of anybody's, described there",
     CLI_TEXT(validate_request, axes), .modes = DESCRIBED},
    {DIAGNOSE, "diagnose", NULL, "compare every entry with the solver and say what is wrong",
     CLI_FLAG(validate_request, diagnose), .modes = DIAGNOSED},
    {SAMPLES, "samples", "N", "random walks per point (default 100000), or slice of layered (10^6)",
     CLI_COUNT(validate_request, samples, 2, (double)LQ_WALK_MAX_SAMPLES),
     .modes = WALKED | STACKED | LAYERED},
    {POINTS, "points", "P", "points, half of them stored entries (default 256)",
     CLI_COUNT(validate_request, points, 2, 10000000), .modes = ~(unsigned)(HARD_CASES | STACKED | LAYERED)},
    {SEED, "seed", "S", "of the points and of the walks (default 1)",
     CLI_COUNT(validate_request, seed, 0, (double)SIZE_MAX), .modes = ~(unsigned)HARD_CASES},
    {BUDGET, "budget", "E|max=E,p99=E|FILE",
     "largest error that stored and interpolated values may have; by norm, or a budget file: certify",
     .type = CLI_TYPE_READ, .read = read_budget, .modes = ~(unsigned)(HARD_CASES | STACKED | LAYERED)},
    CERTIFY_OPTIONS,
    {FORMAT, "format", "text|json", "of the report (default text)",
     CLI_CHOICE(validate_request, format, formats), .modes = ~(unsigned)LAYERED},
    {JSON, "json", NULL, "the same as --format json", CLI_FLAG(validate_request, json),
     .modes = ~(unsigned)LAYERED},
    CLI_NDF_OPTION(validate_request, ~(unsigned)(STACKED | LAYERED)),
    CLI_ALLOW_PLUGIN_OPTION(validate_request, ~(unsigned)(PUBLISHED | HARD_CASES | LAYERED)),
    CLI_SCATTERING_OPTION(validate_request, PUBLISHED),
    CLI_MASKING_OPTION(validate_request, PUBLISHED),
    CLI_TOLERANCE_OPTION(validate_request, PUBLISHED | STACKED),
    CLI_LIGHT_OPTIONS(validate_request, STACKED),
    {SLICES, "slices", "DIR", "write where the walks leave, as EXR and PNG; compare energies by order",
     CLI_TEXT(validate_request, slices), .modes = STACKED},
    {SET, "set", "SET", "stacks that models are measured on: ba19, b18, d22 or a file (default ba19)",
     CLI_TEXT(validate_request, set), .modes = LAYERED},
    {MODEL, "model", "NAME,...", "models to measure (default: all that `lacquer stack --model` takes)",
     CLI_TEXT(validate_request, models), .modes = LAYERED},
    {TABLES, "tables", "DIR", "the pack that models named with +tables look up (default: computed tables)",
     CLI_TEXT(validate_request, tables), .modes = LAYERED},
    CLI_THREADS_OPTION(validate_request, 0),
    {0},
};

/* The words that stand in place of FILE; files of such names are ./hard-cases, ./stack and so on. */
static bool is_hard_cases(const validate_request *request) {
    return strcmp(request->file, "hard-cases") == 0;
}

static bool is_stack(const validate_request *request) {
    return strcmp(request->file, "stack") == 0;
}

static bool is_layered(const validate_request *request) {
    return strcmp(request->file, "layered") == 0;
}

static bool take_word(void *user, const char *word) {
    validate_request *request = user;
    const bool layers = request->file && is_stack(request);
    if (layers && !request->stack) request->stack = word;
    else if (request->file)
        cli_message("one FILE at a time: '%s' after '%s'", word, layers ? request->stack : request->file);
    else request->file = word;
    return request->file == word || request->stack == word;
}

/* The mode asked for, in words as well. */
static unsigned mode_of(const validate_request *request, const char **where) {
    const struct {
        bool asked;
        unsigned mode;
        const char *where;
    } modes[] = {
        {is_hard_cases(request), HARD_CASES, "for hard-cases: every case has its own limit"},
        {is_stack(request), STACKED, "for a stack, whose description says what it is"},
        {is_layered(request), LAYERED, "for layered, whose set says what is measured"},
        {request->axes, DESCRIBED, "with --axes, which says how FILE was made"},
        {request->diagnose, DIAGNOSED, "with --diagnose, which is for FILE alone"},
        {request->other, OTHERS, "with --against OTHER"},
        {request->layout >= 0, PUBLISHED, "for a published FILE"},
        {request->certify.wanted, CERTIFIED, "on a certificate, which is made against the solver"},
        {request->walk, WALKED, "for a FILE of this program, which says itself how it was made"},
    };
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++)
        if (modes[i].asked) return *where = modes[i].where, modes[i].mode;
    *where = "without --against walk, --layout or --against OTHER";
    return OWN;
}

/* What FILE records may be named where FILE says how it was made; an NDF that opens nothing is not read. */
static bool names_nothing(const validate_request *request, unsigned mode) {
    const char *ndf;
    return request->trust.ndf && !(mode & (PUBLISHED | HARD_CASES | STACKED | LAYERED)) &&
           lq_ndf_trusted(request->trust.ndf, NULL, &ndf, NULL) == LQ_OK;
}

static bool suits(const validate_request *request, const cli_given *given) {
    const char *where;
    const unsigned mode = mode_of(request, &where);
    if (mode == PUBLISHED && request->walk)
        cli_message("a published table is not checked by walks; drop --layout or --against walk");
    else if (names_nothing(request, mode))
        cli_message("--ndf has no effect %s; accepted there: the file: or plugin: that FILE records", where);
    else if (!cli_suits(given, mode, where)) return false;
    else if (request->layout >= 0 && !request->kind)
        cli_message("--layout needs --kind: a published file does not say which table it holds");
    else if (request->layout < 0 && request->kind) cli_message("--kind needs --layout");
    else return true;
    return false;
}

static bool parse(validate_request *request, int argc, char **argv) {
    *request = (validate_request){.samples = 100000, .points = 256, .seed = 1, .layout = -1};
    request->settings = cli_settings_default();
    request->light = cli_light_default();
    request->certify.asked.budgets.count = 1;
    if (!cli_parse(&cli_verb_validate, argc, argv, request, take_word, &request->given)) return false;
    if (request->file && is_layered(request) && !cli_given_text(&request->given, SAMPLES))
        request->samples = 1000000;
    request->points_given = cli_given_text(&request->given, POINTS) != NULL;
    request->json |= request->format == 1;
    if (cli_given_text(&request->given, CLI_NDF)) request->trust.ndf = request->settings.settings.ndf;
    request->certify.trust = request->trust;
    for (int id = CERTIFY_FIRST; id <= CERTIFY_LAST; id++)
        request->certify.wanted |= cli_given_text(&request->given, id) != NULL;
    if (!request->file) cli_message("FILE is missing; see `lacquer validate --help`");
    else if (is_stack(request) && !request->stack)
        cli_message("no stack; usage: lacquer validate stack FILE.json [options]");
    else
        return (!request->certify.junit || cli_output_check(request->certify.junit)) &&
               suits(request, &request->given);
    return false;
}

lq_status validate_load_file(const char *path, const lq_trust *trust, lq_table **table, lq_origin *origin,
                             lq_error *error) {
    lq_status status = lq_table_read_exr(table, path, error);
    if (status != LQ_OK) return status;
    lq_error cause = {""};
    status = lq_origin_of(*table, trust, origin, &cause);
    if (status != LQ_OK) snprintf(error->text, sizeof error->text, "%.200s: %.300s", path, cause.text);
    return status;
}

static lq_status load(validate_job *job, lq_error *error) {
    lq_status status =
        validate_load_file(job->request.file, &job->request.trust, &job->table, &job->origin, error);
    /* Once, not at every point: an NDF may tabulate. */
    if (status == LQ_OK) status = lq_ndf_open(&job->origin.settings.opened, job->origin.settings.ndf, error);
    if (status == LQ_OK && job->request.walk && !lq_walk_knows(job->origin.kind)) {
        status = LQ_BAD_INPUT;
        snprintf(error->text, sizeof error->text, "no random walk is known for table '%s'",
                 job->origin.kind->id);
    }
    job->origin.settings.threads = (int)job->request.threads;
    return status;
}

static int report(const validate_job *job) {
    if (!job->request.json) validate_print_text(job);
    else if (!validate_print_json(job)) return CLI_FAILED;
    return validate_complaint(job) ? CLI_EXCEEDED : CLI_DONE;
}

/* What the options that both ways of validating share say. */
static int certify(validate_request *request) {
    certify_request *c = &request->certify;
    if (request->walk || request->other || request->layout >= 0 || request->axes || request->diagnose)
        return cli_fail(
            "a certificate is made against the solver; drop --against, --layout, --axes and --diagnose, "
            "or the budget by norm");
    c->path = request->file;
    c->asked.points = request->points_given ? request->points : 0;
    c->asked.seed = request->seed;
    c->asked.threads = (int)request->threads;
    c->json = request->json;
    if (request->budget > 0.0) c->asked.budgets.rules[0].budget.bound[LQ_NORM_MAX] = request->budget;
    c->asked.has_budget |= request->budget > 0.0;
    return validate_certify(c);
}

static int run(int argc, char **argv) {
    validate_job job = {.table = NULL};
    if (!parse(&job.request, argc, argv)) return CLI_FAILED;
    if (is_hard_cases(&job.request)) return validate_hard_cases(&job.request);
    if (is_layered(&job.request)) return validate_layered(&job.request);
    if (cli_crew()) return cli_fail("is work for one process; accepted of several: validate layered");
    if (job.request.stack)
        return job.request.slices ? validate_slices(&job.request) : validate_stack(&job.request);
    if (job.request.certify.wanted || certify_takes_alone(job.request.file)) return certify(&job.request);
    if (job.request.other || job.request.layout >= 0 || job.request.axes || job.request.diagnose)
        return validate_against(&job.request);
    lq_error error = {""};
    lq_status status = load(&job, &error);
    if (job.table && lq_table_fact(job.table, "factors")) {
        validate_free(&job);
        return certify(&job.request);
    }
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

const cli_verb cli_verb_validate = {
    .name = "validate",
    .summary = "check a stored table against the exact solver and random walks",
    .usage = "FILE|DIR [options]\nhard-cases [--ndf NDF] [--format text|json]\nstack FILE.json [options]\n"
             "layered --report DIR [--set SET] [--model NAME,...]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer validate fgd.exr\n"
                "lacquer validate fgd.exr --against walk --samples 1000000 --points 64\n"
                "lacquer validate fgd.exr --budget 1e-3 --format json\n"
                "lacquer validate fgd.exr --budget max=1e-2,p99=2e-3 --on mu=0.02:1,alpha=0.02:1\n"
                "lacquer validate tables/ --budget budget.json --report page --junit tables.xml\n"
                "lacquer validate tir.exr --against TIR.bin --layout belcour --kind tir-pass\n"
                "lacquer validate TIR.bin --layout belcour --kind tir-pass\n"
                "lacquer validate theirs.npy --axes theirs.json\n"
                "lacquer validate fgd.exr --diagnose\n"
                "lacquer validate hard-cases\n"
                "lacquer validate stack recipes/stacks/frosted-metal.json --samples 1000000 --mu 1,0.3\n"
                "lacquer validate stack recipes/stacks/slab.json --samples 1000000 --mu 0.7 --slices slices\n"
                "lacquer validate layered --report report --samples 1000000",
    .run = run,
    .shares = true,
};
