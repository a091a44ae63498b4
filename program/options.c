/* options.c - walks the arguments of a verb through getopt_long and reports every mistake in one line. */
#include "program/options.h"

#include "program/message.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void cli_join(char *list, size_t size, const char *word) {
    size_t used = strlen(list);
    snprintf(list + used, size - used, "%s%s", used > 0 ? ", " : "", word);
}

/* ======================================================================================
 *                                       Arguments
 * ====================================================================================== */

static bool is_letter(int id) {
    return id > CLI_WORD && id < 256;
}

cli_args cli_args_begin(const cli_verb *verb, int argc, char **argv) {
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    return (cli_args){.verb = verb, .argc = argc, .argv = argv};
}

static void accepted_options(const cli_verb *verb, char *list, size_t size) {
    list[0] = '\0';
    for (const cli_option *option = verb->options; option->name; option++) {
        char text[64] = "";
        if (is_letter(option->id)) snprintf(text, sizeof text, "-%c/", option->id);
        snprintf(text + strlen(text), sizeof text - strlen(text), "--%s", option->name);
        cli_join(list, size, text);
    }
    cli_join(list, size, "--help");
}

static int unknown_option(const cli_args *args, const char *text) {
    char list[LQ_MESSAGE_SIZE];
    accepted_options(args->verb, list, sizeof list);
    cli_message("unknown option '%s'; accepted: %s", text, list);
    return CLI_BAD;
}

static const cli_option *option_of(const cli_verb *verb, int id) {
    for (const cli_option *option = verb->options; option->name; option++)
        if (option->id == id) return option;
    return NULL;
}

/* The tables getopt_long wants. "-:" gives words in order, as CLI_WORD, and ':' for a missing value. */
static void getopt_tables(const cli_verb *verb, char *letters, struct option *names) {
    memcpy(letters, "-:", 3);
    letters += 2;
    for (const cli_option *option = verb->options; option->name; option++) {
        *names++ =
            (struct option){option->name, option->value ? required_argument : no_argument, NULL, option->id};
        if (!is_letter(option->id)) continue;
        *letters++ = (char)option->id;
        if (option->value) *letters++ = ':';
    }
    *letters = '\0';
    *names = (struct option){0};
}

/* getopt_long accepts abbreviations; scripts that use one would break when an option is added. */
static bool is_abbreviation(const char *text, const cli_option *option) {
    return strncmp(text, "--", 2) == 0 && strcspn(text + 2, "=") != strlen(option->name);
}

/* What getopt_long refused, as the user wrote it: a long option whole, one letter of a group alone. */
static int refused_option(const cli_args *args, const char *text) {
    char letter[3] = {'-', (char)optopt, '\0'};
    const cli_option *option = optopt ? option_of(args->verb, optopt) : NULL;
    if (option && strchr(text, '=')) {
        cli_message("option --%s takes no value", option->name);
        return CLI_BAD;
    }
    return unknown_option(args, text[1] == '-' ? text : letter);
}

static int next_word(cli_args *args) {
    if (args->rest >= args->argc) return CLI_END;
    args->value = args->argv[args->rest++];
    return CLI_WORD;
}

int cli_args_next(cli_args *args) {
    if (args->rest > 0) return next_word(args);
    char letters[2 * CLI_MAX_OPTIONS + 3];
    struct option names[CLI_MAX_OPTIONS + 1];
    getopt_tables(args->verb, letters, names);
    int at = optind > 0 ? optind : 1;
    int id = getopt_long(args->argc, args->argv, letters, names, NULL);
    args->value = optarg;
    if (id == -1) {
        args->rest = optind;
        return next_word(args);
    }
    if (id == CLI_WORD) return CLI_WORD;
    if (id == '?') return refused_option(args, args->argv[at]);
    const cli_option *option = option_of(args->verb, id == ':' ? optopt : id);
    if (is_abbreviation(args->argv[at], option)) return unknown_option(args, args->argv[at]);
    if (id != ':') return id;
    cli_message("option --%s needs a value: %s", option->name, option->value);
    return CLI_BAD;
}

/* ======================================================================================
 *                                        Values
 * ====================================================================================== */

bool cli_number(const char *text, double *value) {
    /* strtod would also take leading space, hexadecimal, "inf" and "nan" */
    if (*text == '\0' || strspn(text, "0123456789+-.eE") != strlen(text)) return false;
    char *end;
    *value = strtod(text, &end);
    return *end == '\0' && end != text && isfinite(*value);
}

bool cli_parse_number(const char *what, const char *text, double lowest, double highest, double *value) {
    if (cli_number(text, value) && *value >= lowest && *value <= highest) return true;
    cli_message("%s: '%s' is not a number from %g to %g", what, text, lowest, highest);
    return false;
}

bool cli_parse_count(const char *what, const char *text, size_t lowest, size_t highest, size_t *value) {
    char *end;
    errno = 0;
    unsigned long long count = strtoull(text, &end, 10);
    bool digits = *text != '\0' && strspn(text, "0123456789") == strlen(text);
    if (digits && errno == 0 && count >= lowest && count <= highest) {
        *value = (size_t)count;
        return true;
    }
    cli_message("%s: '%s' is not a whole number from %zu to %zu", what, text, lowest, highest);
    return false;
}

int cli_parse_choice(const char *what, const char *text, const char *const *choices, size_t count) {
    char list[LQ_MESSAGE_SIZE] = "";
    for (size_t i = 0; i < count; i++) {
        if (strcmp(text, choices[i]) == 0) return (int)i;
        cli_join(list, sizeof list, choices[i]);
    }
    cli_message("%s: '%s' is not one of: %s", what, text, list);
    return -1;
}

/* ======================================================================================
 *                                         Help
 * ====================================================================================== */

/* Every line of `text` behind `prefix`. */
static void print_lines(const char *prefix, const char *text) {
    while (*text) {
        int length = (int)strcspn(text, "\n");
        printf("%s%.*s\n", prefix, length, text);
        text += length + (text[length] == '\n');
    }
}

static void print_option(const cli_option *option) {
    char text[64];
    snprintf(text, sizeof text, "--%s%s%s", option->name, option->value ? " " : "",
             option->value ? option->value : "");
    if (is_letter(option->id)) printf("  -%c, ", option->id);
    else printf("      ");
    printf("%-34s %s\n", text, option->meaning);
}

void cli_print_help(const cli_verb *verb) {
    char prefix[64];
    snprintf(prefix, sizeof prefix, "  lacquer %s ", verb->name);
    printf("lacquer %s: %s\n\nUsage:\n", verb->name, verb->summary);
    print_lines(prefix, verb->usage);
    printf("\nOptions:\n");
    for (const cli_option *option = verb->options; option->name; option++) print_option(option);
    print_option(&(cli_option){'h', "help", NULL, "this text"});
    if (verb->notes) {
        printf("\n");
        verb->notes(stdout);
    }
    printf("\nExamples:\n");
    print_lines("  ", verb->examples);
}
