/* view.c - `lacquer view`: tables, factors, packs and stacks to look at. */
#include "program/view/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "pack/read.h"
#include "picture/draw.h"
#include "program/light.h"
#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/settings.h"

enum {
    OPTION_X = 256,
    OPTION_Y,
    OPTION_AT,
    OPTION_CHANNEL,
    OPTION_RANGE,
    OPTION_AXES,
    OPTION_LAYOUT,
    OPTION_KIND
};
enum { OPTION_TOLERANCE = 300, OPTION_TRUST };
enum { TABLE = 1, FOREIGN = 2, PUBLISHED = 4, FACTORS = 8, PACK = 16, STACK = 32 };
enum { TABLES = TABLE | FOREIGN | PUBLISHED };

/* What float32 holds. */
#define RANGE_MAX 3e38

static bool read_range(void *field, const char *text) {
    view_range *range = field;
    char low[64] = "";
    const char *colon = strchr(text, ':');
    if (colon && (size_t)(colon - text) < sizeof low) memcpy(low, text, (size_t)(colon - text));
    range->given = colon && cli_number(low, &range->ends[0]) && cli_number(colon + 1, &range->ends[1]) &&
                   range->ends[0] < range->ends[1] && fabs(range->ends[0]) <= RANGE_MAX &&
                   fabs(range->ends[1]) <= RANGE_MAX;
    if (!range->given)
        cli_message("--range: '%.100s' is not LOW:HIGH with LOW < HIGH, both from %g to %g", text, -RANGE_MAX,
                    RANGE_MAX);
    return range->given;
}

static const cli_option options[] = {
    {'o', "output", "FILE", "page.html, image.png or image.svg", CLI_TEXT(view_request, output),
     .silent = true},
    {OPTION_X, "x", "AXIS", "axis to the right (default: the first of several nodes)",
     CLI_TEXT(view_request, x), .modes = TABLES},
    {OPTION_Y, "y", "AXIS", "axis upwards (default: the next of several nodes)", CLI_TEXT(view_request, y),
     .modes = TABLES},
    {OPTION_AT, "at", "NAME=VALUE", "where the slice lies on another axis (default: its middle node)",
     CLI_LIST(view_request, at), .modes = TABLES},
    {OPTION_CHANNEL, "channel", "NAME", "channel of the table (default: the first)",
     CLI_TEXT(view_request, channel), .modes = TABLES},
    {OPTION_RANGE, "range", "LOW:HIGH", "ends of the colours (default: of the values shown)",
     CLI_READ(view_request, range, read_range), .modes = TABLES},
    {OPTION_AXES, "axes", "AXES.json", "FILE is a .npy, EXR or C array of anybody's, described there",
     CLI_TEXT(view_request, axes), .modes = FOREIGN},
    {OPTION_LAYOUT, "layout", "belcour|tm|mitsuba|mitsuba-inside", "FILE is a published binary table",
     CLI_READ(view_request, layout, cli_read_layout), .modes = PUBLISHED},
    {OPTION_KIND, "kind", "TABLE", "which table that file holds; it does not say itself",
     CLI_TEXT(view_request, kind), .modes = PUBLISHED},
    {OPTION_TOLERANCE, "tolerance", "T", "absolute error of a stack's numbers (default 1e-4)",
     CLI_NUMBER(view_request, tolerance, CLI_STACK_TOLERANCE_MIN, CLI_STACK_TOLERANCE_MAX), .modes = STACK},
    {OPTION_TRUST, "allow-plugin", NULL, "open the NDF files and run the plugins that a stack names",
     CLI_FLAG(view_request, trusted), .modes = STACK},
    CLI_THREADS_OPTION(view_request, STACK),
    {0},
};

static bool take_word(void *user, const char *word) {
    view_request *request = user;
    if (request->input) cli_message("unexpected '%s'; view takes one FILE, DIR or STACK.json", word);
    else request->input = word;
    return request->input == word;
}

/* ======================================================================================
 *                                       The output
 * ====================================================================================== */

typedef enum picture_form { FORM_HTML, FORM_PNG, FORM_SVG, FORM_NONE } picture_form;

static bool ends_with(const char *path, const char *ending) {
    const size_t length = strlen(path), size = strlen(ending);
    return length > size && strcmp(path + length - size, ending) == 0;
}

static picture_form form_of(const char *path) {
    return ends_with(path, ".html")  ? FORM_HTML
           : ends_with(path, ".png") ? FORM_PNG
           : ends_with(path, ".svg") ? FORM_SVG
                                     : FORM_NONE;
}

static int write_picture(const view_request *request, const lq_page *page) {
    lq_error error = {""};
    const picture_form form = form_of(request->output);
    const lq_status status = form == FORM_HTML
                                 ? lq_page_write(page, request->output, &error)
                                 : lq_draw_write(page->figure, form == FORM_PNG ? LQ_IMAGE_PNG : LQ_IMAGE_SVG,
                                                 request->output, &error);
    return status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
}

/* The end of every kind of view; the figure is there unless its making failed, and goes. */
static int finish(const view_request *request, lq_figure *figure, lq_page page, lq_status made,
                  const lq_error *error) {
    page.figure = figure;
    int code = made == LQ_OK || made == LQ_NOT_CONVERGED ? write_picture(request, &page) : CLI_DONE;
    if (made != LQ_OK && code == CLI_DONE) code = cli_fail_status(made, error);
    lq_figure_free(figure);
    return code;
}

/* ======================================================================================
 *                                   What can be viewed
 * ====================================================================================== */

static int show_table(const view_request *request, const lq_table *table) {
    double at[LQ_MAX_AXES];
    lq_slice slice;
    lq_figure *figure = NULL;
    lq_error error = {""};
    if (!view_slice(request, table, &slice, at)) return CLI_FAILED;
    const lq_status status = view_table(table, &slice, cli_basename(request->input), &figure, &error);
    return finish(request, figure, (lq_page){.start = &slice}, status, &error);
}

static int show_factors(const view_request *request, const lq_factored *factored) {
    lq_figure *figure = NULL;
    lq_error error = {""};
    const lq_status status = view_factors(factored, cli_basename(request->input), &figure, &error);
    return finish(request, figure, (lq_page){0}, status, &error);
}

static int show_pack(const view_request *request) {
    lq_figure *figure = NULL;
    lq_error error = {""};
    if (!lq_pack_found(request->input))
        return cli_fail("%s: a folder without manifest.json; accepted: a pack", request->input);
    const lq_status status =
        view_pack(request->input, form_of(request->output) == FORM_HTML, &figure, &error);
    return finish(request, figure, (lq_page){.facts_first = true}, status, &error);
}

static int show_stack(const view_request *request) {
    lq_figure *figure = NULL;
    lq_stack *stack = NULL;
    lq_error error = {""};
    lq_status status = lq_stack_read(&stack, request->input, request->trusted ? LQ_STACK_TRUSTED : 0, &error);
    if (status == LQ_OK) status = view_stack(request, stack, &figure, &error);
    lq_stack_free(stack);
    return finish(request, figure, (lq_page){0}, status, &error);
}

/* A table of whatever form the mode says. */
static int read_and_show_table(const view_request *request, unsigned mode) {
    lq_table *table = NULL;
    lq_error error = {""};
    const lq_status status =
        mode == FOREIGN ? lq_table_read_described(&table, request->input, request->axes, &error)
        : mode == PUBLISHED
            ? lq_published_read(&table, request->input, (lq_layout)request->layout, request->kind, &error)
            : lq_table_read_exr(&table, request->input, &error);
    const int code = status == LQ_OK ? show_table(request, table) : cli_fail_status(status, &error);
    lq_table_free(table);
    return code;
}

static unsigned mode_of(const view_request *request, lq_factored **factored) {
    struct stat there;
    if (request->axes) return FOREIGN;
    if (request->layout >= 0) return PUBLISHED;
    if (stat(request->input, &there) == 0 && S_ISDIR(there.st_mode)) return PACK;
    if (ends_with(request->input, ".json")) return STACK;
    /* A file of factors is also a table, of texels. */
    return lq_factored_read(factored, request->input, NULL) == LQ_OK ? FACTORS : TABLE;
}

/* ======================================================================================
 *                                         Verb
 * ====================================================================================== */

static const char *where(unsigned mode) {
    return mode == FOREIGN     ? "with --axes"
           : mode == PUBLISHED ? "with --layout"
           : mode == FACTORS   ? "for factors"
           : mode == PACK      ? "for a pack"
           : mode == STACK     ? "for a stack"
                               : "for a table";
}

static bool check(const view_request *request) {
    if (!request->input) cli_message("nothing to view; usage: lacquer view %s", cli_verb_view.usage);
    else if (!request->output) cli_message("no output; give one with -o FILE.html, FILE.png or FILE.svg");
    else if (form_of(request->output) == FORM_NONE)
        cli_message("%s: what kind of picture is that; accepted: names that end in .html, .png or .svg",
                    request->output);
    else if (!request->axes && request->layout >= 0 && !request->kind)
        cli_message("--layout needs --kind: a published file does not say which table it holds");
    else if (!request->axes && request->layout < 0 && ends_with(request->input, ".npy"))
        cli_message("%s: a .npy does not say what its axes are; say it with --axes AXES.json",
                    request->input);
    else return cli_output_check(request->output);
    return false;
}

static int show(const view_request *request, unsigned mode, const lq_factored *factored) {
    return mode == FACTORS ? show_factors(request, factored)
           : mode == PACK  ? show_pack(request)
           : mode == STACK ? show_stack(request)
                           : read_and_show_table(request, mode);
}

static int run(int argc, char **argv) {
    view_request request = {.layout = -1};
    cli_given given;
    lq_factored *factored = NULL;
    if (!cli_parse(&cli_verb_view, argc, argv, &request, take_word, &given)) return CLI_FAILED;
    if (!check(&request)) return CLI_FAILED;
    const unsigned mode = mode_of(&request, &factored);
    const int code = cli_suits(&given, mode, where(mode)) ? show(&request, mode, factored) : CLI_FAILED;
    lq_factored_free(factored);
    return code;
}

static void print_notes(FILE *out) {
    fprintf(
        out,
        "A table: its values over two axes, drawn in the axes' own maps, so that nodes are evenly spaced\n"
        "and a crowded corner is as large as it is to the table; marks outside the frame are nodes. Between\n"
        "them is what a look-up gives. Green is no number. Values of both signs have colours around zero.\n"
        "A page (.html) needs no network: choose any two axes, move along the others, read values and\n"
        "curves under the cursor. A table too large for 2 MB is thinned, and its page says how.\n"
        "Factors: planes and lines. A pack: every function, its bytes and its measured error.\n"
        "A stack: energy by path and the moments of what leaves, over the cosine of incidence.\n\n");
}

const cli_verb cli_verb_view = {
    .name = "view",
    .summary = "a picture of a table, factors, a pack or a stack",
    .usage = "FILE|DIR|STACK.json -o FILE.html|FILE.png|FILE.svg [options]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer view fgd.exr -o fgd.html\n"
                "lacquer view fgd.exr --x n --y kappa --at mu=0.1 --at alpha=0.3 -o metals.png\n"
                "lacquer view theirs.npy --axes theirs.json -o theirs.svg\n"
                "lacquer view factors.exr -o factors.html\n"
                "lacquer view out/realtime -o pack.html\n"
                "lacquer view recipes/stacks/frosted-metal.json -o stack.png",
    .run = run,
};
