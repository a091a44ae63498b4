/* options.c - walks the arguments of a verb, fills its request by its rows, and reports every mistake in one
 * line. */
#include "program/options.h"

#include "program/message.h"
#include "system/draft.h"
#include "system/status.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ======================================================================================
 *                                       Arguments
 * ====================================================================================== */

static bool is_letter(int id) {
    return id > ' ' && id < 256;
}

/* The row called so, by its name or its letter; NULL: there is none. */
static const cli_option *find_name(const cli_verb *verb, const char *name, size_t length) {
    for (size_t i = 0; i < verb->option_count; i++)
        if (strlen(verb->options[i].name) == length && strncmp(verb->options[i].name, name, length) == 0)
            return &verb->options[i];
    return NULL;
}

static const cli_option *find_id(const cli_verb *verb, int id) {
    for (size_t i = 0; i < verb->option_count; i++)
        if (verb->options[i].id == id) return &verb->options[i];
    return NULL;
}

/* The options that mean something in a mode (0: any). */
static void accepted_options(const cli_verb *verb, unsigned mode, char *list, size_t size) {
    list[0] = '\0';
    for (size_t i = 0; i < verb->option_count; i++) {
        const cli_option *option = &verb->options[i];
        char text[64] = "";
        if (mode && option->modes && !(option->modes & mode)) continue;
        if (is_letter(option->id)) snprintf(text, sizeof text, "-%c/", option->id);
        snprintf(text + strlen(text), sizeof text - strlen(text), "--%s", option->name);
        lq_list_add(list, size, text);
    }
    lq_list_add(list, size, "--help");
}

static bool refuse_unknown(const cli_verb *verb, const char *text) {
    char list[LQ_MESSAGE_SIZE];
    accepted_options(verb, 0, list, sizeof list);
    cli_message("unknown option '%s'; accepted: %s", text, list);
    return false;
}

/* ---------------------------------------------------------------------- one option into its field */

static bool take_count(const cli_option *option, const char *what, const char *value, size_t *field) {
    const size_t highest = option->highest < (double)SIZE_MAX ? (size_t)option->highest : SIZE_MAX;
    return cli_parse_count(what, value, (size_t)option->lowest, highest, field);
}

static bool take_choice(const cli_option *option, const char *what, const char *value, int *field) {
    size_t count = 0;
    while (option->choices[count]) count++;
    const int choice = cli_parse_choice(what, value, option->choices, count);
    if (choice >= 0) *field = choice;
    return choice >= 0;
}

static bool take_listed(const char *what, const char *value, cli_texts *list) {
    if (list->count == CLI_LIST_SIZE) {
        cli_message("%s: too many at '%s'; accepted are %d", what, value, (int)CLI_LIST_SIZE);
        return false;
    }
    list->text[list->count++] = value;
    return true;
}

static bool take_option(const cli_option *option, void *request, const char *value) {
    void *field = (char *)request + option->at;
    char what[64];
    snprintf(what, sizeof what, "--%s", option->name);
    switch (option->type) {
    case CLI_TYPE_TEXT:
        *(const char **)field = value;
        return true;
    case CLI_TYPE_FLAG:
        return *(bool *)field = true;
    case CLI_TYPE_NUMBER:
        return cli_parse_number(what, value, option->lowest, option->highest, field);
    case CLI_TYPE_COUNT:
        return take_count(option, what, value, field);
    case CLI_TYPE_CHOICE:
        return take_choice(option, what, value, field);
    case CLI_TYPE_LIST:
        return take_listed(what, value, field);
    case CLI_TYPE_READ:
        return option->read(field, value);
    }
    return false;
}

/* --------------------------------------------------------------------------- walking the arguments */

typedef struct walk {
    const cli_verb *verb;
    char **argv;
    int argc, at;
    void *request;
    bool (*word)(void *request, const char *word);
    cli_given *given;
} walk;

/* An option and the value glued to it, or NULL. */
static bool take(walk *w, const cli_option *option, const char *glued) {
    const char *value = option->value ? glued ? glued : w->at < w->argc ? w->argv[w->at++] : NULL : "";
    if (!value) {
        cli_message("option --%s needs a value: %s", option->name, option->value);
        return false;
    }
    w->given->text[option - w->verb->options] = value;
    return take_option(option, w->request, value);
}

/* "--name" or "--name=value"; the whole name, as scripts that use a part of one would break when an option
 * is added. */
static bool take_long(walk *w, const char *text) {
    const size_t length = strcspn(text + 2, "=");
    const cli_option *option = find_name(w->verb, text + 2, length);
    const char *glued = text[2 + length] ? text + 2 + length + 1 : NULL;
    if (!option) return refuse_unknown(w->verb, text);
    if (!option->value && glued) {
        cli_message("option --%s takes no value", option->name);
        return false;
    }
    return take(w, option, glued);
}

/* "-o FILE", "-oFILE", and letters that take no value together. */
static bool take_letters(walk *w, const char *letters) {
    for (; *letters; letters++) {
        const cli_option *option = is_letter(*letters) ? find_id(w->verb, *letters) : NULL;
        const char name[] = {'-', *letters, '\0'};
        if (!option) return refuse_unknown(w->verb, name);
        if (option->value) return take(w, option, letters[1] ? letters + 1 : NULL);
        if (!take(w, option, NULL)) return false;
    }
    return true;
}

static bool take_word(const walk *w, const char *word) {
    if (w->word) return w->word(w->request, word);
    cli_message("unexpected '%s'; %s takes no arguments", word, w->verb->name);
    return false;
}

bool cli_parse(const cli_verb *verb, int argc, char **argv, void *request,
               bool (*word)(void *request, const char *word), cli_given *given) {
    walk w = {verb, argv, argc, 1, request, word, given};
    bool words_only = false, good = true;
    *given = (cli_given){.verb = verb};
    while (good && w.at < argc) {
        const char *text = argv[w.at++];
        if (words_only || text[0] != '-' || text[1] == '\0') good = take_word(&w, text);
        else if (strcmp(text, "--") == 0) words_only = true;
        else good = text[1] == '-' ? take_long(&w, text) : take_letters(&w, text + 1);
    }
    return good;
}

/* ---------------------------------------------------------------------------------- what was given */

const char *cli_given_text(const cli_given *given, int id) {
    const cli_option *option = find_id(given->verb, id);
    return option ? given->text[option - given->verb->options] : NULL;
}

bool cli_suits(const cli_given *given, unsigned mode, const char *where) {
    const cli_verb *verb = given->verb;
    char list[LQ_MESSAGE_SIZE];
    for (size_t i = 0; i < verb->option_count; i++) {
        const cli_option *option = &verb->options[i];
        if (!given->text[i] || !option->modes || (option->modes & mode)) continue;
        accepted_options(verb, mode, list, sizeof list);
        cli_message("--%s has no effect %s; accepted there: %s", option->name, where, list);
        return false;
    }
    return true;
}

static void write_option(FILE *out, const cli_option *option, const void *request, const char *text) {
    const cli_texts *list = (const cli_texts *)(const void *)((const char *)request + option->at);
    if (option->type != CLI_TYPE_LIST)
        fprintf(out, " --%s%s%s", option->name, option->value ? " " : "", text);
    else
        for (size_t i = 0; i < list->count; i++) fprintf(out, " --%s %s", option->name, list->text[i]);
}

char *cli_command(const cli_given *given, const void *request, const char *words) {
    const cli_verb *verb = given->verb;
    lq_draft draft = {.text = NULL};
    FILE *out = lq_draft_open(&draft);
    if (!out) return NULL;
    fprintf(out, "lacquer %s %s", verb->name, words);
    for (size_t i = 0; i < verb->option_count; i++)
        if (given->text[i] && !verb->options[i].silent)
            write_option(out, &verb->options[i], request, given->text[i]);
    return lq_draft_close(&draft, out) ? draft.text : NULL;
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
        lq_list_add(list, sizeof list, choices[i]);
    }
    cli_message("%s: '%s' is not one of: %s", what, text, list);
    return -1;
}

bool cli_read_layout(void *field, const char *value) {
    const char *layouts[LQ_LAYOUTS];
    for (int i = 0; i < LQ_LAYOUTS; i++) layouts[i] = lq_layout_name((lq_layout)i);
    const int choice = cli_parse_choice("--layout", value, layouts, LQ_LAYOUTS);
    if (choice >= 0) *(int *)field = choice;
    return choice >= 0;
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
    for (size_t i = 0; i < verb->option_count; i++) print_option(&verb->options[i]);
    print_option(&(cli_option){.id = 'h', .name = "help", .meaning = "this text"});
    if (verb->notes) {
        printf("\n");
        verb->notes(stdout);
    }
    printf("\nExamples:\n");
    print_lines("  ", verb->examples);
}
