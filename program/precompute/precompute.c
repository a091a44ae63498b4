/* precompute.c - `lacquer precompute`: a whole table on all cores, into a file. */
#include "lacquer.h"
#include "program/catalogue.h"
#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/precompute/mitsuba.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/verb.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { OPTION_AXIS = 256, OPTION_FORMAT, OPTION_OUTPUT = 'o' };
/* The first two follow from the ending of a file, the published layouts do not. */
enum {
    FORMAT_EXR,
    FORMAT_NPY,
    FORMAT_BELCOUR,
    FORMAT_TM,
    FORMAT_MITSUBA,
    FORMATS,
    FORMAT_ENDINGS = FORMAT_BELCOUR
};
static const char *const formats[FORMATS] = {"exr", "npy", "belcour", "tm", "mitsuba"};

/* Why this is more than LQ_MAX_AXES: a fifth --axis must be refused by its name. */
enum { MAX_AXIS_OPTIONS = 2 * LQ_MAX_AXES };

typedef struct table_request {
    const char *table;
    const char *axes[MAX_AXIS_OPTIONS]; /* name=spec */
    int axis_count;
    cli_settings settings;
    int format;
    const char *format_text, *output;
    char *command; /* what determines the table, as a command line; owned */
} table_request;

/* ======================================================================================
 *                                       Arguments
 * ====================================================================================== */

static bool take_axis(table_request *request, const char *value) {
    if (request->axis_count == MAX_AXIS_OPTIONS) {
        cli_message("--axis: too many at '%s'", value);
        return false;
    }
    request->axes[request->axis_count++] = value;
    return true;
}

static bool take_word(table_request *request, const char *word) {
    if (request->table) {
        cli_message("unexpected '%s'; precompute takes one TABLE; axes are given as --axis name=min:max:n",
                    word);
        return false;
    }
    request->table = word;
    return true;
}

static bool take_option(table_request *request, int id, const char *value) {
    int taken = cli_settings_take(&request->settings, id, value);
    if (taken != 0) return taken > 0;
    if (id == CLI_WORD) return take_word(request, value);
    if (id == OPTION_AXIS) return take_axis(request, value);
    if (id == OPTION_OUTPUT) request->output = value;
    if (id == OPTION_FORMAT) request->format_text = value;
    return true;
}

static bool read_arguments(table_request *request, int argc, char **argv) {
    cli_args args = cli_args_begin(&cli_verb_precompute, argc, argv);
    for (int id; (id = cli_args_next(&args)) != CLI_END;)
        if (id == CLI_BAD || !take_option(request, id, args.value)) return false;
    if (!request->table) {
        cli_message("no table; usage: lacquer precompute TABLE -o FILE; see lacquer list");
        return false;
    }
    if (!request->output) cli_message("no output file; add -o FILE.exr or -o FILE.npy");
    return request->output != NULL;
}

/* From --format, otherwise from the ending of the output file. */
static bool find_format(table_request *request) {
    if (request->format_text) {
        request->format = cli_parse_choice("--format", request->format_text, formats, FORMATS);
        return request->format >= 0;
    }
    const char *dot = strrchr(cli_basename(request->output), '.');
    for (request->format = 0; request->format < FORMAT_ENDINGS; request->format++)
        if (dot && strcasecmp(dot + 1, formats[request->format]) == 0) return true;
    cli_message("%s: the format does not follow from the name; end it in .exr or .npy, or add --format "
                "exr|npy|belcour|tm|mitsuba",
                request->output);
    return false;
}

/* ======================================================================================
 *                                         Axes
 * ====================================================================================== */

/* The axis that "name=..." names among those of the kind, or -1. */
static int find_axis(const lq_kind *kind, const char *text) {
    char list[LQ_MESSAGE_SIZE] = "";
    size_t length = strcspn(text, "=");
    for (int i = 0; i < kind->axis_count; i++) {
        const char *name = kind->axes[i].name;
        if (strlen(name) == length && strncmp(name, text, length) == 0) return i;
        cli_join(list, sizeof list, name);
    }
    cli_message("--axis: unknown axis '%.*s'; %s has: %s", (int)length, text, kind->id, list);
    return -1;
}

static bool set_axis(const lq_kind *kind, const char *text, lq_axis *axes, bool *given) {
    lq_error error = {""};
    int i = find_axis(kind, text);
    if (i < 0) return false;
    const lq_axis_info *info = &kind->axes[i];
    const char *equals = strchr(text, '=');
    lq_axis axis;
    if (!equals) {
        cli_message("--axis: '%s' has no nodes; write %s=min:max:n or %s=min:max:n:map", text, text, text);
    } else if (given[i]) {
        cli_message("--axis: %s is given twice", info->name);
    } else if (lq_axis_parse(&axis, info->name, equals + 1, &error) != LQ_OK) {
        cli_message("%s", error.text);
    } else {
        lq_axis_free(&axes[i]);
        axes[i] = axis;
        given[i] = axis.min >= info->lowest && axis.max <= info->highest;
        if (given[i]) return true;
        cli_message("--axis: %s from %g to %g is out of range; accepted: %g to %g", info->name, axis.min,
                    axis.max, info->lowest, info->highest);
    }
    return false;
}

static void free_axes(const lq_kind *kind, lq_axis *axes) {
    for (int i = 0; i < kind->axis_count; i++) lq_axis_free(&axes[i]);
}

static bool is_mitsuba(const table_request *request, const lq_kind *kind) {
    return request->format == FORMAT_MITSUBA && strcmp(kind->id, "transmission") == 0;
}

static bool make_axes(const table_request *request, const lq_kind *kind, lq_axis *axes) {
    bool given[LQ_MAX_AXES] = {false};
    lq_error error = {""};
    lq_status status = lq_settings_axes(kind, &request->settings.settings, axes, &error);
    if (status == LQ_OK && is_mitsuba(request, kind)) status = precompute_mitsuba_axes(axes, &error);
    if (status != LQ_OK) {
        cli_message("%s", error.text);
        return false;
    }
    for (int i = 0; i < request->axis_count; i++) {
        if (set_axis(kind, request->axes[i], axes, given)) continue;
        free_axes(kind, axes);
        return false;
    }
    return true;
}

/* ======================================================================================
 *                                     Computation
 * ====================================================================================== */

/* The command line in a fixed order, without what does not change the numbers (threads, the file's
 * name): the same table is the same file, bit for bit. NULL: out of memory. */
static char *write_command(const table_request *request) {
    static const char *const names[] = {"ndf", "scattering", "masking", "tolerance"};
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fprintf(out, "lacquer precompute %s", request->table);
    for (int i = 0; i < request->axis_count; i++) fprintf(out, " --axis %s", request->axes[i]);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (request->settings.given[i]) fprintf(out, " --%s %s", names[i], request->settings.given[i]);
    if (fclose(out) == 0) return text;
    free(text);
    return NULL;
}

static lq_status compute(const table_request *request, const lq_kind *kind, const lq_axis *axes,
                         lq_table **table, lq_error *error) {
    cli_progress bar;
    cli_progress_begin(&bar, kind->id);
    lq_status status = lq_precompute(kind, &request->settings.settings, axes, &bar.progress, table, error);
    cli_progress_end(&bar);
    return status;
}

static lq_status write_table(const table_request *request, lq_table *table, lq_error *error) {
    lq_status status = lq_table_set_fact(table, "command", request->command, error);
    if (status != LQ_OK) return status;
    switch (request->format) {
    case FORMAT_NPY:
        return lq_table_write_npy(table, request->output, error);
    case FORMAT_BELCOUR:
        return lq_published_write(table, request->output, LQ_BELCOUR, error);
    case FORMAT_TM:
        return lq_published_write(table, request->output, LQ_TM, error);
    default:
        return lq_table_write_exr(table, request->output, error);
    }
}

/* Can the format hold the table to be? Asked before the work. */
static bool format_suits(const table_request *request, const lq_kind *kind, const lq_axis *axes) {
    const bool separable = request->settings.settings.masking == LQ_SEPARABLE;
    const char *masking = kind->takes & LQ_TAKES_MASKING ? separable ? "separable" : "correlated" : NULL;
    lq_error error = {""};
    if (request->format < FORMAT_BELCOUR) return true;
    static const lq_layout layouts[FORMATS] = {
        [FORMAT_BELCOUR] = LQ_BELCOUR, [FORMAT_TM] = LQ_TM, [FORMAT_MITSUBA] = LQ_MITSUBA};
    const lq_layout layout = layouts[request->format];
    if (lq_published_check(layout, kind->id, masking, axes, kind->axis_count, &error) == LQ_OK) return true;
    cli_message("%s", error.text);
    return false;
}

/* All of a Mitsuba file at once: three tables make one. */
static int precompute_file(const table_request *request, const lq_kind *kind, const lq_axis *axes) {
    lq_error error = {""};
    size_t entries;
    double estimate;
    const double start = cli_seconds();
    const lq_status status = precompute_mitsuba(kind, &request->settings.settings, axes, request->output,
                                                &entries, &estimate, &error);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return cli_fail_status(status, &error);
    printf("%s: %zu entries, error at most %.3g, %.3g s\n", request->output, entries, estimate,
           cli_seconds() - start);
    if (status != LQ_OK) cli_message("%s", error.text);
    return status == LQ_OK ? CLI_DONE : CLI_EXCEEDED;
}

static int precompute(const table_request *request, const lq_kind *kind, const lq_axis *axes) {
    lq_table *table = NULL;
    lq_error error = {""}, write_error = {""};
    double start = cli_seconds();
    lq_status status = compute(request, kind, axes, &table, &error);
    double seconds = cli_seconds() - start;
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return cli_fail_status(status, &error);
    int code = status == LQ_OK ? CLI_DONE : CLI_EXCEEDED;
    lq_status written = write_table(request, table, &write_error);
    if (written != LQ_OK) {
        code = cli_fail_status(written, &write_error);
    } else {
        const char *estimate = lq_table_fact(table, "error");
        printf("%s: %zu entries, error at most %s, %.3g s\n", request->output, lq_table_entries(table),
               estimate ? estimate : "unknown", seconds);
        if (status != LQ_OK) cli_message("%s", error.text);
    }
    lq_table_free(table);
    return code;
}

/* ======================================================================================
 *                                         Verb
 * ====================================================================================== */

static int run(int argc, char **argv) {
    table_request request = {.settings = cli_settings_default()};
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_error error = {""};
    if (!read_arguments(&request, argc, argv)) return CLI_FAILED;
    const lq_kind *kind = lq_kind_find(request.table, &error);
    if (!kind) return cli_fail("%s", error.text);
    if (!cli_settings_suit(&request.settings, kind) || !find_format(&request)) return CLI_FAILED;
    if (!cli_output_check(request.output) || !make_axes(&request, kind, axes)) return CLI_FAILED;
    int code = CLI_FAILED;
    if (format_suits(&request, kind, axes)) {
        request.command = write_command(&request);
        if (!request.command) code = cli_fail("out of memory");
        else if (is_mitsuba(&request, kind)) code = precompute_file(&request, kind, axes);
        else code = precompute(&request, kind, axes);
    }
    free(request.command);
    free_axes(kind, axes);
    return code;
}

static const cli_option options[] = {
    {OPTION_OUTPUT, "output", "FILE", "where to write (required); the ending .exr or .npy picks the format"},
    {OPTION_FORMAT, "format", "exr|npy|belcour|tm|mitsuba",
     "the format, whatever the ending; see lacquer list"},
    {OPTION_AXIS, "axis", "NAME=MIN:MAX:N[:MAP]", "nodes of one axis (default: below); may be repeated"},
    CLI_SETTINGS_OPTIONS,
    CLI_THREADS_OPTION,
    {0},
};

static void print_notes(FILE *out) {
    fprintf(out,
            "NODES of an axis: min:max:n or min:max:n:map with map linear, sqrt (denser at min) or power2.5\n"
            "(any exponent); one value 0.3; or a list 0,0.1,1,3. The file records how it was made and is\n"
            "the same, bit for bit, for any number of threads. Ctrl-C leaves no file and exits 130.\n"
            "Exit 2: written, but the error estimate is above the tolerance.\n\n");
    cli_print_axes(out);
}

const cli_verb cli_verb_precompute = {
    .name = "precompute",
    .summary = "a whole table, on all cores, into a file",
    .usage = "TABLE [--axis NAME=NODES]... [options] -o FILE",
    .options = options,
    .notes = print_notes,
    .examples = "lacquer precompute albedo -o albedo.exr\n"
                "lacquer precompute fgd -o fgd.exr\n"
                "lacquer precompute fgd --axis mu=0:1:32:sqrt --axis n=0.2 --axis kappa=3.9 -o silver.exr\n"
                "lacquer precompute dfg --tolerance 1e-7 -o dfg.npy\n"
                "lacquer precompute tir-pass --format belcour -o TIR.bin\n"
                "lacquer precompute transmission --format mitsuba -o ggx.dat",
    .run = run,
};
