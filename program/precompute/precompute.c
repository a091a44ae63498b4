/* precompute.c - `lacquer precompute`: a whole table on all cores, into a file. */
#include "program/precompute/precompute.h"

#include "precompute/sweep.h"
#include "program/build.h"
#include "program/catalogue.h"
#include "program/crew.h"
#include "program/light.h"
#include "program/matched.h"
#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/verb.h"
#include "system/output.h"
#include "system/status.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum {
    OPTION_AXIS = 256,
    OPTION_FORMAT,
    OPTION_STACK,
    OPTION_INTERFACES,
    OPTION_FROM,
    OPTION_TRUST,
    OPTION_RESUME,
    OPTION_OUTPUT = 'o'
};
enum { KIND = 1, STACK = 2 }; /* modes */

static const char *const formats[FORMATS + 1] = {"exr", "npy", "belcour", "tm", "mitsuba", NULL};

static const cli_option options[] = {
    {OPTION_OUTPUT, "output", "FILE", "where to write (required); the ending .exr or .npy picks the format",
     CLI_TEXT(table_request, output), .silent = true},
    {OPTION_FORMAT, "format", "exr|npy|belcour|tm|mitsuba",
     "the format, whatever the ending; see lacquer list", CLI_CHOICE(table_request, format, formats),
     .silent = true},
    {OPTION_AXIS, "axis", "NAME=MIN:MAX:N[:MAP]", "nodes of one axis (default: below); may be repeated",
     CLI_LIST(table_request, axes)},
    {OPTION_STACK, "stack", "FILE.json", "of table stack: the layers", CLI_TEXT(table_request, stack),
     .modes = STACK},
    {OPTION_INTERFACES, "interfaces", "all|single",
     "of table stack: orders of scattering at each interface (default all)",
     CLI_CHOICE(table_request, interfaces, cli_interfaces), .modes = STACK},
    {OPTION_FROM, "from", "above|below", "of table stack: where the light comes from (default above)",
     CLI_CHOICE(table_request, from, cli_sides), .modes = STACK},
    {OPTION_TRUST, "allow-plugin", NULL,
     "of table stack: open the NDF files and run the plugins that it names", CLI_FLAG(table_request, trusted),
     .modes = STACK, .silent = true},
    {OPTION_RESUME, "resume", NULL,
     "keep what is solved in FILE.parts until FILE is whole, and take up what a run before left there",
     CLI_FLAG(table_request, resume), .modes = KIND, .silent = true},
    CLI_NDF_OPTION(table_request, KIND),
    CLI_SCATTERING_OPTION(table_request, KIND),
    CLI_MASKING_OPTION(table_request, KIND),
    CLI_TOLERANCE_OPTION(table_request, 0),
    CLI_THREADS_OPTION(table_request, 0),
    {0},
};

/* ======================================================================================
 *                                       Arguments
 * ====================================================================================== */

static bool take_word(void *user, const char *word) {
    table_request *request = user;
    if (request->table) {
        cli_message("unexpected '%s'; precompute takes one TABLE; axes are given as --axis name=min:max:n",
                    word);
        return false;
    }
    request->table = word;
    return true;
}

static bool read_arguments(table_request *request, cli_given *given, int argc, char **argv) {
    if (!cli_parse(&cli_verb_precompute, argc, argv, request, take_word, given)) return false;
    request->settings.settings.threads = (int)request->threads;
    if (!request->table) {
        cli_message("no table; usage: lacquer precompute TABLE -o FILE; see lacquer list");
        return false;
    }
    if (!request->output) cli_message("no output file; add -o FILE.exr or -o FILE.npy");
    return request->output != NULL;
}

/* From --format, otherwise from the ending of the output file. */
static bool find_format(table_request *request) {
    if (request->format >= 0) return true;
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
        lq_list_add(list, sizeof list, name);
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
    if (status == LQ_OK && is_mitsuba(request, kind)) status = lq_mitsuba_axes(axes, &error);
    if (status != LQ_OK) {
        cli_message("%s", error.text);
        return false;
    }
    for (size_t i = 0; i < request->axes.count; i++) {
        if (set_axis(kind, request->axes.text[i], axes, given)) continue;
        free_axes(kind, axes);
        return false;
    }
    return true;
}

/* ======================================================================================
 *                                     Computation
 * ====================================================================================== */

static lq_status write_table(const table_request *request, const lq_rows *rows, lq_table *shape,
                             lq_error *error) {
    lq_status status = lq_table_set_fact(shape, "command", request->command, error);
    if (status != LQ_OK) return status;
    switch (request->format) {
    case FORMAT_NPY:
        return lq_rows_write_npy(rows, request->output, error);
    case FORMAT_BELCOUR:
        return lq_published_write(shape, request->output, LQ_BELCOUR, error);
    case FORMAT_TM:
        return lq_published_write(shape, request->output, LQ_TM, error);
    default:
        return lq_rows_write_exr(rows, request->output, error);
    }
}

static bool is_file_to_be(const char *path) {
    struct stat there;
    return stat(path, &there) != 0 || S_ISREG(there.st_mode);
}

/* Can what is finished be kept beside the file? */
static bool resume_suits(const table_request *request, const lq_kind *kind) {
    if (!request->resume && cli_crew())
        cli_message("several processes share what is finished; add --resume, which keeps it in FILE.parts");
    if (!request->resume) return !cli_crew();
    if (is_mitsuba(request, kind))
        cli_message("--resume: a Mitsuba file is three tables; accepted: exr, npy, belcour, tm");
    else if (!is_file_to_be(request->output))
        cli_message("--resume: %s is no file that parts can lie beside", request->output);
    else return true;
    return false;
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
static int precompute_file(const table_request *request, const lq_axis *axes) {
    lq_error error = {""};
    size_t entries;
    double estimate;
    const double start = cli_seconds();
    cli_progress bar;
    cli_progress_begin(&bar, "mitsuba");
    const lq_status status = lq_mitsuba_precompute(&request->settings.settings, axes, &bar.progress,
                                                   request->output, &entries, &estimate, &error);
    cli_progress_end(&bar);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return cli_fail_status(status, &error);
    printf("%s: %zu entries, error at most %.3g, %.3g s\n", request->output, entries, estimate,
           cli_seconds() - start);
    if (status != LQ_OK) cli_message("%s", error.text);
    return status == LQ_OK ? CLI_DONE : CLI_EXCEEDED;
}

int precompute_finish(const table_request *request, const lq_rows *rows, lq_table *shape, size_t found,
                      lq_status status, const lq_error *error, double seconds, bool *written) {
    lq_error write_error = {""};
    const lq_status wrote = write_table(request, rows, shape, &write_error);
    *written = wrote == LQ_OK;
    if (!*written) return cli_fail_status(wrote, &write_error);
    const char *estimate = lq_table_fact(shape, "error");
    printf("%s: %zu entries, error at most %s, %.3g s", request->output, lq_table_entries(shape),
           estimate ? estimate : "unknown", seconds);
    printf(found > 0 ? ", %zu parts from before\n" : "\n", found);
    if (status != LQ_OK) cli_message("%s", error->text);
    return status == LQ_OK ? CLI_DONE : CLI_EXCEEDED;
}

/* Solves of so many bytes are held in memory; of a 64^4 table they are less. */
enum { IN_MEMORY = 1 << 26 };

/* Where solves are kept; `folder` has room for the name. */
static lq_parts_place place_of(const table_request *request, char *folder, size_t size) {
    if (!request->resume)
        return (lq_parts_place){.beside = is_file_to_be(request->output) ? request->output : NULL,
                                .most = IN_MEMORY};
    snprintf(folder, size, "%s.parts", request->output);
    return (lq_parts_place){.folder = folder, .crew = cli_crew()};
}

/* A published layout is written from a table that is held: there are none that are large. */
static lq_status hold(lq_sweep *sweep, lq_table **held, lq_error *error) {
    const lq_table *shape = lq_sweep_shape(sweep);
    const char *names[LQ_MAX_CHANNELS];
    for (int c = 0; c < shape->channel_count; c++) names[c] = shape->channel_names[c];
    const lq_status status =
        lq_table_create(held, shape->axes, shape->axis_count, names, shape->channel_count, error);
    return status == LQ_OK ? lq_sweep_hold(sweep, *held, error) : status;
}

static int write_sweep(const table_request *request, lq_sweep *sweep, lq_status status, const lq_error *error,
                       double seconds, bool *written) {
    lq_table *held = NULL;
    lq_error cause = {""};
    const bool published = request->format >= FORMAT_ENDINGS;
    const lq_status hold_status = published ? hold(sweep, &held, &cause) : LQ_OK;
    const lq_rows rows = lq_sweep_rows(sweep);
    const int code = hold_status != LQ_OK
                         ? cli_fail_status(hold_status, &cause)
                         : precompute_finish(request, &rows, held ? held : lq_sweep_shape(sweep),
                                             lq_sweep_found(sweep), status, error, seconds, written);
    lq_table_free(held);
    return code;
}

static int precompute(const table_request *request, const lq_kind *kind, const lq_axis *axes) {
    char folder[PATH_MAX + 8];
    lq_sweep *sweep = NULL;
    lq_error error = {""};
    bool written = false;
    const double start = cli_seconds();
    const lq_parts_place place = place_of(request, folder, sizeof folder);
    cli_progress bar;
    cli_progress_begin(&bar, kind->id);
    const lq_status status = lq_sweep_solve(&sweep, kind, &request->settings.settings, axes, &place,
                                            cli_build, &bar.progress, &error);
    cli_progress_end(&bar);
    if (!sweep) return cli_fail_status(status, &error);
    const int code =
        cli_leads() ? write_sweep(request, sweep, status, &error, cli_seconds() - start, &written) : CLI_DONE;
    if (written && request->resume) written = lq_output_settle(request->output, NULL) == LQ_OK;
    lq_sweep_free(sweep, written);
    return code;
}

/* ======================================================================================
 *                                         Verb
 * ====================================================================================== */

static int run(int argc, char **argv) {
    table_request request = {.settings = cli_settings_default(), .format = -1};
    cli_given given;
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_error error = {""};
    if (!read_arguments(&request, &given, argc, argv)) return CLI_FAILED;
    if (strcmp(request.table, "stack") == 0) {
        if (cli_crew()) return cli_fail("a stack's table is work for one process");
        if (!cli_suits(&given, STACK, "for a stack") || !find_format(&request)) return CLI_FAILED;
        request.command = cli_command(&given, &request, request.table);
        const int code = request.command ? precompute_stack(&request) : cli_fail("out of memory");
        free(request.command);
        return code;
    }
    if (!cli_suits(&given, KIND, "for this table")) return CLI_FAILED;
    const lq_kind *kind = lq_kind_find(request.table, &error);
    if (!kind) return cli_fail("%s", error.text);
    if (!cli_settings_suit(&given, kind) || !find_format(&request)) return CLI_FAILED;
    if (!cli_output_check(request.output) || !make_axes(&request, kind, axes)) return CLI_FAILED;
    int code = CLI_FAILED;
    if (resume_suits(&request, kind) && format_suits(&request, kind, axes)) {
        request.command = cli_command(&given, &request, request.table);
        cli_warn_matched(kind, axes);
        if (!request.command) code = cli_fail("out of memory");
        else if (is_mitsuba(&request, kind)) code = precompute_file(&request, axes);
        else code = precompute(&request, kind, axes);
    }
    free(request.command);
    free_axes(kind, axes);
    return code;
}

static void print_notes(FILE *out) {
    fprintf(
        out,
        "NODES of an axis: min:max:n or min:max:n:map with map linear, sqrt (denser at min) or power2.5\n"
        "(any exponent); one value 0.3; or a list 0,0.1,1,3. The file records how it was made and is\n"
        "the same, bit for bit, for any number of threads. Ctrl-C leaves no file and exits 130.\n"
        "With --resume it leaves FILE.parts, as a kill does: the same command goes on from there, to the\n"
        "same file; parts of other options are refused. The table itself is never held in memory.\n"
        "TABLE stack is what the layers of --stack FILE.json do to light (lacquer stack), over mu and any\n"
        "parameters of theirs: top.alpha, 2.n, base.rho, ... See docs/stacks.md.\n"
        "Exit 2: written, but the error estimate is above the tolerance.\n\n");
    cli_print_axes(out);
}

const cli_verb cli_verb_precompute = {
    .name = "precompute",
    .summary = "a whole table, on all cores, into a file",
    .usage = "TABLE [--axis NAME=NODES]... [options] -o FILE\n"
             "stack --stack FILE.json --axis mu=NODES [--axis LAYER.NAME=NODES]... -o FILE",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer precompute albedo -o albedo.exr\n"
                "lacquer precompute fgd -o fgd.exr\n"
                "lacquer precompute fgd --axis mu=0:1:32:sqrt --axis n=0.2 --axis kappa=3.9 -o silver.exr\n"
                "lacquer precompute dfg --tolerance 1e-7 -o dfg.npy\n"
                "lacquer precompute tir-pass --format belcour -o TIR.bin\n"
                "lacquer precompute transmission --format mitsuba -o ggx.dat\n"
                "lacquer precompute stack --stack recipes/stacks/frosted-metal.json --axis mu=0:1:64 "
                "--axis top.alpha=0:1:64 -o frosted.exr",
    .run = run,
    .shares = true,
};
