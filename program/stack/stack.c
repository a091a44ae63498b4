/* stack.c - `lacquer stack`: what a layered material does to light, exactly. */
#include "program/stack/stack.h"

#include <stdlib.h>
#include <string.h>

#include "program/message.h"
#include "program/options.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/verb.h"

enum {
    OPTION_MU = 256,
    OPTION_FORMAT,
    OPTION_INTERFACES,
    OPTION_PATHS,
    OPTION_FROM,
    OPTION_TOLERANCE,
    OPTION_TRUST
};
enum { FORMAT_TEXT, FORMAT_CSV, FORMAT_JSON };
enum { MAX_PATHS = 64 };

typedef struct stack_cosines {
    size_t count;
    double mu[STACK_COSINES_MAX];
} stack_cosines;

typedef struct stack_request {
    const char *path;
    stack_cosines cosines;
    int format, interfaces, from;
    size_t paths, threads;
    double tolerance;
    bool trusted;
} stack_request;

static const char *const formats[] = {"text", "csv", "json", NULL};

/* Cosines separated by commas. */
static bool read_cosines(void *field, const char *value) {
    stack_cosines *cosines = field;
    cosines->count = 0;
    for (const char *at = value;; at++) {
        char text[64];
        const size_t length = strcspn(at, ",");
        if (length >= sizeof text || cosines->count == STACK_COSINES_MAX) {
            cli_message("--mu: accepted: up to %d cosines in [0,1] separated by commas", STACK_COSINES_MAX);
            return false;
        }
        memcpy(text, at, length);
        text[length] = '\0';
        if (!cli_parse_number("--mu", text, 0.0, 1.0, &cosines->mu[cosines->count++])) return false;
        at += length;
        if (*at == '\0') return true;
    }
}

static const cli_option options[] = {
    {OPTION_MU, "mu", "MU,...",
     "cosines of incidence, in the medium the light comes from (default 1,0.6,0.15)",
     CLI_READ(stack_request, cosines, read_cosines)},
    {OPTION_FORMAT, "format", "text|csv|json", "how to print (default text)",
     CLI_CHOICE(stack_request, format, formats)},
    {OPTION_INTERFACES, "interfaces", "all|single",
     "orders of scattering at each interface; single: what is blocked after one is lost (default all)",
     CLI_CHOICE(stack_request, interfaces, cli_interfaces)},
    {OPTION_FROM, "from", "above|below", "where the light comes from (default above)",
     CLI_CHOICE(stack_request, from, cli_sides)},
    {OPTION_PATHS, "paths", "N", "split light by how often it met the first interface: 1, 2, ... N or more",
     CLI_COUNT(stack_request, paths, 1, MAX_PATHS)},
    {OPTION_TOLERANCE, "tolerance", "T", "absolute error of every number (default 1e-4)",
     CLI_NUMBER(stack_request, tolerance, 1e-7, 0.1)},
    {OPTION_TRUST, "allow-plugin", NULL, "open the NDF files and run the plugins that the stack names",
     CLI_FLAG(stack_request, trusted)},
    CLI_THREADS_OPTION(stack_request, 0),
    {0},
};

static bool take_word(void *user, const char *word) {
    stack_request *request = user;
    if (request->path) {
        cli_message("one stack at a time, not '%s' too", word);
        return false;
    }
    request->path = word;
    return true;
}

static int print(const stack_request *request, const stack_result *result) {
    if (request->format == FORMAT_JSON) return stack_print_json(result);
    if (request->format == FORMAT_CSV) stack_print_csv(result);
    else stack_print_text(result);
    return CLI_DONE;
}

static int solve(const stack_request *request, const lq_stack *stack) {
    const lq_stack_query query = {.mu = request->cosines.mu,
                                  .mu_count = request->cosines.count,
                                  .from_below = request->from == 1,
                                  .single = request->interfaces == 1,
                                  .paths = request->paths,
                                  .tolerance = request->tolerance,
                                  .threads = (int)request->threads};
    const int channels = lq_stack_channels(stack);
    const size_t paths = request->paths ? request->paths : 1;
    lq_stack_light *light = calloc(query.mu_count * (size_t)channels * paths, sizeof *light);
    if (!light) return cli_fail("out of memory");
    lq_error error = {""};
    cli_progress bar;
    cli_progress_begin(&bar, "stack");
    const lq_status status = lq_stack_solve(stack, &query, light, &bar.progress, &error);
    cli_progress_end(&bar);
    const stack_result result = {stack, &query, channels, light};
    int code = status == LQ_OK || status == LQ_NOT_CONVERGED ? print(request, &result) : CLI_DONE;
    if (status != LQ_OK && code == CLI_DONE) code = cli_fail_status(status, &error);
    free(light);
    return code;
}

static int run(int argc, char **argv) {
    stack_request request = {.cosines = {3, {1.0, 0.6, 0.15}}};
    cli_given given;
    lq_error error = {""};
    lq_stack *stack = NULL;
    if (!cli_parse(&cli_verb_stack, argc, argv, &request, take_word, &given)) return CLI_FAILED;
    if (!request.path) return cli_fail("no stack; usage: lacquer stack FILE.json [options]");
    const lq_status status =
        lq_stack_read(&stack, request.path, request.trusted ? LQ_STACK_TRUSTED : 0, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    const int code = solve(&request, stack);
    lq_stack_free(stack);
    return code;
}

static void print_notes(FILE *out) {
    fprintf(
        out,
        "Prints, for each cosine and channel, the flux fractions `reflected` and `transmitted`, and of the\n"
        "light that leaves on either side sin2 = E[sin^2 theta], mean = E[sin theta cos phi] (positive away\n"
        "from the light) and across = E[sin^2 theta sin^2 phi]. `error` is an estimate for every number of\n"
        "its line, never meant to be too small. CSV leaves a field empty where there is no such light.\n"
        "FILE.json describes layers from the top; see docs/stacks.md.\n"
        "Exit 2: printed, but some estimate is above the tolerance.\n\n");
}

const cli_verb cli_verb_stack = {
    .name = "stack",
    .summary = "energies and spread of a layered material, without noise",
    .usage = "FILE.json [options]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer stack recipes/stacks/frosted-metal.json --mu 1,0.6,0.15\n"
                "lacquer stack recipes/stacks/frosted-metal.json --paths 3 --format csv\n"
                "lacquer stack recipes/stacks/slab.json --from below --tolerance 1e-6",
    .run = run,
};
