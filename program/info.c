/* info.c - `lacquer info`: what a stored table holds and how it was made. */
#include "lacquer.h"
#include "pack/read.h"
#include "program/info_pack.h"
#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/verb.h"

#include <math.h>

typedef struct channel_range {
    double min, max, mean;
    size_t bad; /* NaN or infinite entries, not counted in the others */
} channel_range;

static channel_range measure(const lq_table *table, int channel) {
    channel_range range = {INFINITY, -INFINITY, 0, 0};
    size_t entries = lq_table_entries(table);
    for (size_t i = 0; i < entries; i++) {
        double value = (double)table->channels[channel][i];
        if (!isfinite(value)) {
            range.bad++;
            continue;
        }
        range.min = fmin(range.min, value);
        range.max = fmax(range.max, value);
        range.mean += value;
    }
    range.mean /= (double)(entries - range.bad); /* NaN where nothing is finite */
    return range;
}

/* ======================================================================================
 *                                         Text
 * ====================================================================================== */

static void print_axis(const lq_axis *axis) {
    char map[64];
    snprintf(map, sizeof map, "%s", lq_map_name(axis->map));
    if (axis->map == LQ_MAP_POWER) snprintf(map, sizeof map, "%s %g", lq_map_name(axis->map), axis->exponent);
    printf("  %-10s %5zu nodes, %g to %g, %s\n", axis->name, axis->size, axis->min, axis->max, map);
}

static void print_channel(const lq_table *table, int channel) {
    channel_range range = measure(table, channel);
    printf("  %-10s min %.9g, max %.9g, mean %.9g", table->channel_names[channel], range.min, range.max,
           range.mean);
    if (range.bad > 0) printf(", %zu not finite", range.bad);
    printf("\n");
}

static void print_text(const char *path, const lq_table *table) {
    printf("%s: %zu entries\n", path, lq_table_entries(table));
    printf("axes (the first one fastest)\n");
    for (int i = 0; i < table->axis_count; i++) print_axis(&table->axes[i]);
    printf("channels\n");
    for (int i = 0; i < table->channel_count; i++) print_channel(table, i);
    printf("facts\n");
    for (size_t i = 0; i < table->fact_count; i++)
        printf("  %-10s %s\n", table->facts[i].key, table->facts[i].value);
}

/* ======================================================================================
 *                                         JSON
 * ====================================================================================== */

static json_t *axis_json(const lq_axis *axis) {
    json_t *nodes = json_array();
    for (size_t i = 0; i < axis->size; i++) lq_json_append(&nodes, lq_json_number(axis->nodes[i]));
    return json_pack("{s:s, s:I, s:f, s:f, s:s, s:f, s:o}", "name", axis->name, "size",
                     (json_int_t)axis->size, "min", axis->min, "max", axis->max, "map",
                     lq_map_name(axis->map), "exponent", axis->exponent, "nodes", nodes);
}

static json_t *channel_json(const lq_table *table, int channel) {
    channel_range range = measure(table, channel);
    return json_pack("{s:s, s:o, s:o, s:o, s:I}", "name", table->channel_names[channel], "min",
                     lq_json_number(range.min), "max", lq_json_number(range.max), "mean",
                     lq_json_number(range.mean), "not_finite", (json_int_t)range.bad);
}

static int print_json(const char *path, const lq_table *table) {
    json_t *axes = json_array(), *channels = json_array(), *facts = json_object();
    for (int i = 0; i < table->axis_count; i++) lq_json_append(&axes, axis_json(&table->axes[i]));
    for (int i = 0; i < table->channel_count; i++) lq_json_append(&channels, channel_json(table, i));
    for (size_t i = 0; i < table->fact_count; i++)
        lq_json_set(&facts, table->facts[i].key, lq_json_text(table->facts[i].value));
    json_t *root =
        json_pack("{s:o, s:I, s:o, s:o, s:o}", "file", lq_json_text(path), "entries",
                  (json_int_t)lq_table_entries(table), "axes", axes, "channels", channels, "facts", facts);
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(15)) ? CLI_DONE : CLI_FAILED;
}

/* ======================================================================================
 *                                         Verb
 * ====================================================================================== */

enum { OPTION_FORMAT = 256, OPTION_LAYOUT, OPTION_KIND, OPTION_NDF };
enum { OWN = 1, PUBLISHED = 2 }; /* modes: a file of this program, or a published one */

typedef struct info_request {
    const char *path, *kind, *ndf;
    int format, layout; /* layout -1: a file of this program */
} info_request;

static const char *const formats[] = {"text", "json", NULL};

static const cli_option options[] = {
    {OPTION_FORMAT, "format", "text|json", "how to print (default text)",
     CLI_CHOICE(info_request, format, formats)},
    {OPTION_LAYOUT, "layout", "belcour|tm|mitsuba|mitsuba-inside", "FILE is a published binary table",
     CLI_READ(info_request, layout, cli_read_layout)},
    {OPTION_KIND, "kind", "TABLE", "which table that file holds; it does not say itself",
     CLI_TEXT(info_request, kind), .modes = PUBLISHED},
    {OPTION_NDF, "ndf", "NDF", "which NDF it was made for, where it is not the one of the layout",
     CLI_TEXT(info_request, ndf), .modes = PUBLISHED},
    {0},
};

static bool take_word(void *user, const char *word) {
    info_request *request = user;
    if (request->path) cli_message("unexpected '%s'; info takes one FILE", word);
    else request->path = word;
    return request->path == word;
}

static bool read_arguments(info_request *request, int argc, char **argv) {
    cli_given given;
    if (!cli_parse(&cli_verb_info, argc, argv, request, take_word, &given)) return false;
    if (!request->path) cli_message("no file; usage: lacquer info %s", cli_verb_info.usage);
    else if (request->layout >= 0 && !request->kind)
        cli_message("--layout needs --kind: a published file does not say which table it holds");
    else
        return request->layout >= 0 ? cli_suits(&given, PUBLISHED, "with --layout")
                                    : cli_suits(&given, OWN, "without --layout");
    return false;
}

static int run(int argc, char **argv) {
    info_request request = {.layout = -1};
    if (!read_arguments(&request, argc, argv)) return CLI_FAILED;
    if (request.layout < 0 && lq_pack_found(request.path))
        return info_pack(request.path, request.format == 1);
    lq_table *table = NULL;
    lq_error error = {""};
    lq_status status = request.layout < 0 ? lq_table_read_exr(&table, request.path, &error)
                                          : lq_published_read(&table, request.path, (lq_layout)request.layout,
                                                              request.kind, &error);
    if (status == LQ_OK && request.ndf) status = lq_table_set_fact(table, "ndf", request.ndf, &error);
    if (status != LQ_OK) {
        lq_table_free(table);
        return cli_fail_status(status, &error);
    }
    int code = CLI_DONE;
    if (request.format == 1) code = print_json(request.path, table);
    else print_text(request.path, table);
    lq_table_free(table);
    return code;
}

const cli_verb cli_verb_info = {
    .name = "info",
    .summary = "axes, channels and provenance of a stored table; the functions of a pack",
    .usage = "FILE|DIR [--format text|json] [--layout LAYOUT --kind TABLE]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .examples = "lacquer info fgd.exr\n"
                "lacquer info --format json fgd.exr\n"
                "lacquer info scene-pack\n"
                "lacquer info TIR.bin --layout belcour --kind tir-pass",
    .run = run,
};
