/* eval.c - `lacquer eval`: values of a table at single points, exact or from a stored file. */
#include "program/eval/eval.h"

#include "program/catalogue.h"
#include "program/matched.h"
#include "program/message.h"
#include "program/options.h"
#include "program/settings.h"
#include "program/verb.h"

#include <string.h>

enum { OPTION_FORMAT = 256, OPTION_FROM, OPTION_ORDERS };
enum { FORMAT_TEXT, FORMAT_CSV, FORMAT_JSON };
enum { MAX_WORDS = 16, MAX_ORDERS = 64 };

enum { COMPUTED = 1, STORED = 2 }; /* modes */

typedef struct eval_request {
    const char *words[MAX_WORDS]; /* the table, unless `from` is given, and axis=value */
    int word_count;
    cli_settings settings;
    size_t threads;
    int format;
    const char *from;
    size_t orders;
} eval_request;

static const char *const formats[] = {"text", "csv", "json", NULL};

static const cli_option options[] = {
    CLI_SETTINGS_OPTIONS(eval_request, COMPUTED),
    CLI_THREADS_OPTION(eval_request, COMPUTED),
    {OPTION_ORDERS, "orders", "N", "energy after exactly 1, 2, ... N hits instead (fgd only)",
     CLI_COUNT(eval_request, orders, 1, MAX_ORDERS), .modes = COMPUTED},
    {OPTION_FROM, "from", "FILE|DIR",
     "a stored table, factors, or a function of a pack, instead of computing", CLI_TEXT(eval_request, from)},
    {OPTION_FORMAT, "format", "text|csv|json", "how to print (default text)",
     CLI_CHOICE(eval_request, format, formats)},
    {0},
};

/* ======================================================================================
 *                                       Arguments
 * ====================================================================================== */

static bool take_word(void *user, const char *word) {
    eval_request *request = user;
    if (request->word_count == MAX_WORDS) {
        cli_message("too many arguments at '%s'", word);
        return false;
    }
    request->words[request->word_count++] = word;
    return true;
}

static bool read_arguments(eval_request *request, cli_given *given, int argc, char **argv) {
    if (!cli_parse(&cli_verb_eval, argc, argv, request, take_word, given)) return false;
    request->settings.settings.threads = (int)request->threads;
    return !request->from || cli_suits(given, STORED, "with --from");
}

/* ======================================================================================
 *                                        Source
 * ====================================================================================== */

/* A folder is a pack, whose functions have names. */
static bool is_pack(const eval_request *request) {
    return request->from && lq_pack_found(request->from);
}

/* Words before the point: the table, or the function of a pack. */
static int names_of(const eval_request *request) {
    return !request->from || is_pack(request) ? 1 : 0;
}

static int open_file(const eval_request *request, eval_source *source) {
    lq_error error = {""};
    const bool named = request->word_count > 0 && !strchr(request->words[0], '=');
    lq_status status = is_pack(request)
                           ? eval_source_pack(source, request->from, named ? request->words[0] : NULL, &error)
                           : eval_source_file(source, request->from, &error);
    return status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
}

static int open_kind(const eval_request *request, const cli_given *given, eval_source *source) {
    lq_error error = {""};
    if (request->word_count == 0 || strchr(request->words[0], '='))
        return cli_fail("no table; usage: lacquer eval TABLE axis=value...; see lacquer list");
    if (strcmp(request->words[0], "stack") == 0)
        return cli_fail("a stack is no table to evaluate; use lacquer stack FILE.json, or --from FILE.exr of "
                        "lacquer precompute stack");
    const lq_kind *kind = lq_kind_find(request->words[0], &error);
    if (!kind) return cli_fail("%s", error.text);
    if (!cli_settings_suit(given, kind)) return CLI_FAILED;
    eval_source_kind(source, kind, &request->settings.settings);
    return CLI_DONE;
}

/* ======================================================================================
 *                                       One point
 * ====================================================================================== */

static bool read_word(const eval_source *source, const char *word, eval_point *point, lq_error *error) {
    char name[LQ_NAME_SIZE] = "";
    const char *equals = strchr(word, '=');
    if (!equals) {
        cli_message("unexpected '%s'; points are given as axis=value", word);
        return false;
    }
    snprintf(name, sizeof name, "%.*s", (int)(equals - word), word);
    int axis = eval_find_axis(source, name, error);
    if (axis >= 0 && eval_coordinate(source, point, axis, equals + 1, error)) return true;
    cli_message("%s", error->text);
    return false;
}

static bool read_point(const eval_request *request, const eval_source *source, eval_point *point) {
    lq_error error = {""};
    for (int i = names_of(request); i < request->word_count; i++)
        if (!read_word(source, request->words[i], point, &error)) return false;
    if (eval_complete(source, point, &error)) return true;
    cli_message("%s", error.text);
    return false;
}

static int print_result(const eval_request *request, const eval_source *source, const eval_point *point,
                        const eval_result *result) {
    if (request->format == FORMAT_JSON) return eval_print_json(source, point, result);
    if (request->format == FORMAT_TEXT) {
        eval_print_text(source, result);
        return CLI_DONE;
    }
    for (int i = 0; i < source->axis_count; i++) printf("%s%s", i > 0 ? "," : "", source->axes[i].name);
    eval_print_csv_header(source);
    for (int i = 0; i < source->axis_count; i++) printf("%s%.15g", i > 0 ? "," : "", point->at[i]);
    eval_print_csv_result(source, result);
    return CLI_DONE;
}

static int eval_one(const eval_request *request, const eval_source *source, const eval_point *point) {
    eval_result result;
    if (source->kind) cli_warn_matched_at(source->kind, point->at);
    eval_compute(source, &source->settings, point, &result);
    if (result.status != LQ_OK && result.status != LQ_NOT_CONVERGED)
        return cli_fail_status(result.status, &result.error);
    int code = print_result(request, source, point, &result);
    if (code == CLI_DONE && result.status != LQ_OK) code = cli_fail_status(result.status, &result.error);
    return code;
}

/* ======================================================================================
 *                                   Order by order
 * ====================================================================================== */

static void print_orders(int format, const double *energies, size_t count) {
    double sum = 0;
    if (format == FORMAT_CSV) printf("order,energy\n");
    if (format == FORMAT_JSON) printf("{\"orders\": [");
    for (size_t i = 0; i < count; i++) {
        sum += energies[i];
        if (format == FORMAT_CSV) printf("%zu,%.9g\n", i + 1, energies[i]);
        else if (format == FORMAT_JSON) printf("%s%.15g", i > 0 ? ", " : "", energies[i]);
        else printf("order %zu: %.9g\n", i + 1, energies[i]);
    }
    if (format == FORMAT_JSON) printf("], \"sum\": %.15g}\n", sum);
    if (format == FORMAT_TEXT) printf("sum: %.9g\n", sum);
}

static int eval_orders(const eval_request *request, const eval_source *source, const eval_point *point) {
    double energies[MAX_ORDERS];
    lq_error error = {""};
    if (strcmp(source->kind->id, "fgd") != 0)
        return cli_fail("--orders: only table fgd is known order by order, not %s", source->kind->id);
    if (source->settings.scattering == LQ_SINGLE)
        return cli_fail("--orders counts the hits of multiple scattering; leave out --scattering single");
    lq_status status = lq_eval_orders(&source->settings, point->at, request->orders, energies, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    print_orders(request->format, energies, request->orders);
    return CLI_DONE;
}

/* ======================================================================================
 *                                         Verb
 * ====================================================================================== */

static int eval_request_run(const eval_request *request, const eval_source *source) {
    bool has_point = request->word_count > names_of(request);
    if (!has_point && request->format == FORMAT_CSV && request->orders == 0) return eval_csv(source, stdin);
    eval_point point = eval_start(source);
    if (!read_point(request, source, &point)) return CLI_FAILED;
    if (request->orders > 0) return eval_orders(request, source, &point);
    return eval_one(request, source, &point);
}

static int run(int argc, char **argv) {
    eval_request request = {.settings = cli_settings_default()};
    eval_source source = {0};
    cli_given given;
    if (!read_arguments(&request, &given, argc, argv)) return CLI_FAILED;
    int code = request.from ? open_file(&request, &source) : open_kind(&request, &given, &source);
    if (code == CLI_DONE) code = eval_request_run(&request, &source);
    eval_source_free(&source);
    return code;
}

static void print_notes(FILE *out) {
    fprintf(
        out,
        "Prints VALUE ± ERROR, where ERROR is an estimate never meant to be too small; a table of\n"
        "several channels prints one line each. With --from it prints the interpolated VALUE, of factors as\n"
        "a GPU gets it: half floats, filter weights of 8 bits.\n"
        "--format csv without a point reads CSV from standard input (a header row of axis names in\n"
        "any order, then numbers) and writes it back with columns value (or the channels) and error.\n"
        "Exit 2: printed, but some estimate is above the tolerance.\n\n");
    cli_print_axes(out);
}

const cli_verb cli_verb_eval = {
    .name = "eval",
    .summary = "one point, computed exactly, or a CSV of points",
    .usage = "TABLE axis=value... [options]\n"
             "TABLE --format csv [options] < points.csv\n"
             "--from FILE axis=value... [options]\n"
             "--from DIR FUNCTION axis=value... [options]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer eval fgd mu=0.3 alpha=0.5 n=0.2 kappa=3.9\n"
                "lacquer eval fgd mu=0.3 alpha=0.5 n=0.2 kappa=3.9 --orders 7\n"
                "lacquer eval albedo mu=0.1 alpha=1 --masking separable --format json\n"
                "printf 'alpha,mu\\n0.5,0.1\\n0.5,0.9\\n' | lacquer eval albedo --format csv\n"
                "lacquer eval --from fgd.exr mu=0.3 alpha=0.5 n=0.2 kappa=3.9\n"
                "lacquer eval --from t01-factors.exr mu=0.3 alpha=0.2 eta=1.5 tau=0.5\n"
                "lacquer eval --from scene-pack gold mu=0.3 alpha=0.2",
    .run = run,
};
