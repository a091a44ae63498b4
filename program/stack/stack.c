/* stack.c - `lacquer stack`: what a layered material does to light, exactly or by a model. */
#include "program/stack/stack.h"

#include <stdlib.h>
#include <string.h>

#include "pack/model_source.h"
#include "program/light.h"
#include "program/message.h"
#include "program/options.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/verb.h"

enum {
    OPTION_FORMAT = 256,
    OPTION_PATHS,
    OPTION_TOLERANCE,
    OPTION_TRUST,
    OPTION_MODEL,
    OPTION_VARIANT,
    OPTION_MAPPING,
    OPTION_FIRST,
    OPTION_AZIMUTH,
    OPTION_TABLES
};
enum { EXACT = 1, VARIED = 2, LOBES = 4, RAYS = 8, TURNED = 16 };
enum { FORMAT_TEXT, FORMAT_CSV, FORMAT_JSON };

typedef struct stack_request {
    const char *path, *tables;
    cli_light light;
    int format;
    bool paths;
    size_t threads;
    double tolerance, azimuth;
    bool trusted;
    int model, variant, mapping, first;
} stack_request;

static const char *const formats[] = {"text", "csv", "json", NULL};
static const char *const variants[] = {"paper", "released", NULL};      /* as lq_model_variant */
static const char *const firsts[] = {"model", "exact", "scaled", NULL}; /* as lq_first_lobe */
static const char *const mappings[] = {"exact", "b18", NULL};           /* as lq_model_f */

static const cli_option options[] = {
    CLI_MU_OPTION(stack_request, 0),
    CLI_SIDE_OPTIONS(stack_request, EXACT),
    {OPTION_MODEL, "model", "NAME", "a model's lobes instead of what is exact: see below",
     CLI_CHOICE(stack_request, model, lq_model_names)},
    {OPTION_VARIANT, "variant", "paper|released",
     "B18 as printed, or as its code was released (default paper)",
     CLI_CHOICE(stack_request, variant, variants), .modes = VARIED | TURNED},
    {OPTION_MAPPING, "mapping", "exact|b18", "f of roughness: computed, or B18's fit of it (default exact)",
     CLI_CHOICE(stack_request, mapping, mappings), .modes = VARIED | TURNED},
    {OPTION_FIRST, "first", "model|exact|scaled",
     "first lobe: the model's, the top's BRDF (Ba19 eq. 6), or that with the model's energy (default model)",
     CLI_CHOICE(stack_request, first, firsts), .modes = VARIED | LOBES},
    {OPTION_AZIMUTH, "azimuth", "DEG",
     "of the light's travel from the x axis that layers turn from (default 0)",
     CLI_NUMBER(stack_request, azimuth, -360.0, 360.0), .modes = TURNED},
    {OPTION_TABLES, "tables", "DIR", "a pack whose tables the model looks up (default: exact ones)",
     CLI_TEXT(stack_request, tables), .modes = VARIED | TURNED},
    {OPTION_FORMAT, "format", "text|csv|json", "how to print (default text)",
     CLI_CHOICE(stack_request, format, formats)},
    {OPTION_PATHS, "paths", NULL, "split light by how often it met the first interface: 1, 2, ... N or more",
     CLI_FLAG(stack_request, paths), .modes = EXACT},
    {OPTION_TOLERANCE, "tolerance", "T", "absolute error of every number (default 1e-4)",
     CLI_NUMBER(stack_request, tolerance, CLI_STACK_TOLERANCE_MIN, CLI_STACK_TOLERANCE_MAX), .modes = EXACT},
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

/* What the last path of --paths may hold. */
static const double LAST_PATH = 0.01;

static int solve(const stack_request *request, const lq_stack *stack) {
    lq_stack_query query = cli_light_query(&request->light);
    lq_error error = {""};
    query.tolerance = request->tolerance;
    query.threads = (int)request->threads;
    const lq_status counted =
        request->paths ? lq_stack_count_paths(stack, &query, LAST_PATH, &query.paths, &error) : LQ_OK;
    if (counted != LQ_OK) return cli_fail_status(counted, &error);
    const int channels = lq_stack_channels(stack);
    const size_t paths = query.paths ? query.paths : 1;
    lq_stack_light *light = calloc(query.mu_count * (size_t)channels * paths, sizeof *light);
    if (!light) return cli_fail("out of memory");
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

static unsigned mode_of(const stack_request *request) {
    if (request->model < 0) return EXACT;
    const lq_model_kind *kind = &lq_model_kinds[request->model];
    if (kind->anisotropic) return TURNED;
    return kind->varied ? VARIED : kind->of_pairs ? RAYS : LOBES;
}

static int print_model(const stack_request *request, const model_result *result) {
    if (request->format == FORMAT_JSON) return model_print_json(result);
    if (request->format == FORMAT_CSV) model_print_csv(result);
    else model_print_text(result);
    return CLI_DONE;
}

static int run_model(const stack_request *request, const lq_stack *stack, const lq_model_source *source) {
    const lq_model_query query = {.mu = request->light.mu,
                                  .mu_count = request->light.count,
                                  .model = (lq_model_id)request->model,
                                  .variant = (lq_model_variant)request->variant,
                                  .f = (lq_model_f)request->mapping,
                                  .source = source,
                                  .threads = (int)request->threads};
    const bool varied = lq_model_kinds[request->model].varied;
    model_result result = {.stack = stack,
                           .query = &query,
                           .model = lq_model_names[request->model],
                           .variant = varied ? variants[request->variant] : NULL,
                           .mapping = varied ? mappings[request->mapping] : NULL,
                           .first_name = mode_of(request) & (RAYS | TURNED) ? NULL : firsts[request->first],
                           .tables = request->tables,
                           .first = (lq_first_lobe)request->first,
                           .azimuth = request->azimuth,
                           .channels = lq_stack_channels(stack)};
    lq_error error = {""};
    cli_progress bar;
    cli_progress_begin(&bar, "model");
    const lq_status status = model_run(&result, &bar.progress, &error);
    cli_progress_end(&bar);
    const int code = status == LQ_OK ? print_model(request, &result) : cli_fail_status(status, &error);
    model_free(&result);
    return code;
}

static int solve_model(const stack_request *request, const lq_stack *stack) {
    lq_pack pack = {.count = 0};
    lq_error error = {""};
    if (!request->tables) return run_model(request, stack, NULL);
    const lq_status status = lq_pack_read(&pack, request->tables, &error);
    const lq_model_source source = lq_pack_source(&pack);
    const int code = status == LQ_OK ? run_model(request, stack, &source) : cli_fail_status(status, &error);
    lq_pack_free(&pack);
    return code;
}

static int run(int argc, char **argv) {
    stack_request request = {.light = cli_light_default(), .model = -1};
    cli_given given;
    lq_error error = {""};
    lq_stack *stack = NULL;
    if (!cli_parse(&cli_verb_stack, argc, argv, &request, take_word, &given)) return CLI_FAILED;
    const bool exact = request.model < 0;
    char where[64] = "without --model";
    if (!exact) snprintf(where, sizeof where, "with --model %s", lq_model_names[request.model]);
    if (!cli_suits(&given, mode_of(&request), where)) return CLI_FAILED;
    if (!request.path) return cli_fail("no stack; usage: lacquer stack FILE.json [options]");
    const lq_status status =
        lq_stack_read(&stack, request.path, request.trusted ? LQ_STACK_TRUSTED : 0, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    const int code = exact ? solve(&request, stack) : solve_model(&request, stack);
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
        "--paths goes on until no more than a hundredth of the light is left; its last line holds that.\n"
        "--model prints the lobes of a model instead, a line each: energy, mean (sin theta of its "
        "direction),\n"
        "variance (f of its roughness, where the model has one) and GGX roughness, by the layer that adds "
        "it;\n"
        "CSV has the same columns as without it, `error` empty.\n"
        "FILE.json describes layers from the top; see docs/stacks.md.\n"
        "Exit 2: printed, but some estimate is above the tolerance.\n\nModels (--model):\n");
    for (int i = 0; i < LQ_MODELS; i++)
        fprintf(out, "  %-26s %s\n", lq_model_names[i], lq_model_kinds[i].title);
}

const cli_verb cli_verb_stack = {
    .name = "stack",
    .summary = "energies and spread of a layered material, without noise, or a model's lobes",
    .usage = "FILE.json [options]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer stack recipes/stacks/frosted-metal.json --mu 1,0.6,0.15\n"
                "lacquer stack recipes/stacks/frosted-metal.json --paths --format csv\n"
                "lacquer stack recipes/stacks/slab.json --from below --tolerance 1e-6\n"
                "lacquer stack recipes/stacks/frosted-metal.json --model b18-forward",
    .run = run,
};
