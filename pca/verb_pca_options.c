/* verb_pca_options.c - the options of `lacquer pca` that name axes of the table. */
#include "pca/verb_pca.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "cli/options.h"

/* The axis called by the first `length` characters of `name`, or -1. */
static int find_axis(const char *what, const lq_table *table, const char *name, size_t length) {
    char list[LQ_MESSAGE_SIZE] = "";
    for (int a = 0; a < table->axis_count; a++) {
        const char *axis = table->axes[a].name;
        if (strlen(axis) == length && strncmp(axis, name, length) == 0) return a;
        cli_join(list, sizeof list, axis);
    }
    cli_message("%s: unknown axis '%.*s'; the table has: %s", what, (int)length, name, list);
    return -1;
}

/* "tau:2" or "n+kappa:8", up to `end`. */
static bool parse_separation(const lq_table *table, const char *text, const char *end, lq_separation *out) {
    const char *colon = memchr(text, ':', (size_t)(end - text));
    const char *names_end = colon ? colon : end;
    *out = (lq_separation){.bases = 4};
    for (const char *name = text;; name++) {
        const char *plus = memchr(name, '+', (size_t)(names_end - name));
        const char *stop = plus ? plus : names_end;
        if (out->axis_count == 2) {
            cli_message(
                "--separate: '%.*s' takes more than two axes out together; accepted are A:N and A+B:N",
                (int)(end - text), text);
            return false;
        }
        out->axes[out->axis_count] = find_axis("--separate", table, name, (size_t)(stop - name));
        if (out->axes[out->axis_count++] < 0) return false;
        if (!plus) break;
        name = plus;
    }
    if (!colon) return true;
    char number[24];
    snprintf(number, sizeof number, "%.*s", (int)(end - colon - 1), colon + 1);
    return cli_parse_count("--separate", number, 1, 64, &out->bases);
}

static bool parse_separations(pca_request *request, const lq_table *table) {
    const char *text = request->separate;
    lq_pca_options *options = &request->options;
    while (text && *text) {
        const char *end = text + strcspn(text, ",");
        if (options->separation_count == LQ_MAX_AXES) {
            cli_message("--separate: more than %d entries", (int)LQ_MAX_AXES);
            return false;
        }
        if (!parse_separation(table, text, end, &options->separations[options->separation_count++]))
            return false;
        text = *end ? end + 1 : end;
    }
    return true;
}

static bool parse_split(pca_request *request, const lq_table *table) {
    if (!request->split) return true;
    lq_pca_options *options = &request->options;
    const char *equals = strchr(request->split, '=');
    if (!equals) {
        cli_message("--split: '%s' names no value; write eta=1", request->split);
        return false;
    }
    options->split_axis = find_axis("--split", table, request->split, (size_t)(equals - request->split));
    if (options->split_axis < 0) return false;
    for (const char *text = equals + 1; *text;) {
        const size_t length = strcspn(text, ",");
        char number[64];
        snprintf(number, sizeof number, "%.*s", (int)length, text);
        if (options->split_count == LQ_MAX_PIECES - 1) {
            cli_message("--split: more than %d values", LQ_MAX_PIECES - 1);
            return false;
        }
        if (!cli_parse_number("--split", number, -1e9, 1e9, &options->splits[options->split_count++]))
            return false;
        text += length + (text[length] == ',');
    }
    return true;
}

static bool parse_map(const char *text, double *exponent) {
    *exponent = strcmp(text, "linear") == 0 ? 1.0 : strcmp(text, "sqrt") == 0 ? 2.0 : 0.0;
    if (*exponent > 0.0) return true;
    if (strncmp(text, "power", 5) == 0 && cli_parse_number("--texels", text + 5, 0.1, 10.0, exponent))
        return true;
    if (strncmp(text, "power", 5) != 0)
        cli_message("--texels: '%s' is not a map; accepted are linear, sqrt and powerP", text);
    return false;
}

static bool parse_texels(pca_request *request, const lq_table *table) {
    for (int i = 0; i < request->texel_count; i++) {
        const char *text = request->texels[i], *equals = strchr(text, '=');
        if (!equals) {
            cli_message("--texels: '%s' names no size; write mu=64", text);
            return false;
        }
        const int a = find_axis("--texels", table, text, (size_t)(equals - text));
        const char *colon = strchr(equals, ':');
        char number[24];
        snprintf(number, sizeof number, "%.*s", colon ? (int)(colon - equals - 1) : 23, equals + 1);
        if (a < 0 || !cli_parse_count("--texels", number, 2, 4096, &request->options.texels[a])) return false;
        if (colon && !parse_map(colon + 1, &request->options.exponents[a])) return false;
    }
    return true;
}

static bool parse_bases(pca_request *request) {
    if (!request->bases) return true;
    char first[24];
    const char *comma = strchr(request->bases, ',');
    const size_t length = comma ? (size_t)(comma - request->bases) : strlen(request->bases);
    snprintf(first, sizeof first, "%.*s", (int)length, request->bases);
    return cli_parse_count("--bases", first, 1, 64, &request->options.bases[0]) &&
           (!comma || cli_parse_count("--bases", comma + 1, 1, 64, &request->options.bases[1]));
}

static bool find_channel(const pca_request *request, const lq_table *table, int *channel) {
    char list[LQ_MESSAGE_SIZE] = "";
    *channel = 0;
    if (!request->channel) return true;
    for (; *channel < table->channel_count; ++*channel) {
        if (strcmp(table->channel_names[*channel], request->channel) == 0) return true;
        cli_join(list, sizeof list, table->channel_names[*channel]);
    }
    cli_message("--channel: unknown channel '%s'; the table has: %s", request->channel, list);
    return false;
}

bool pca_resolve(pca_request *request, const lq_table *table, int *channel) {
    request->options.value_axis = lq_table_axis(table, "tau");
    return parse_separations(request, table) && parse_split(request, table) && parse_texels(request, table) &&
           parse_bases(request) && find_channel(request, table, channel);
}
