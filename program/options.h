/* options.h - the arguments of a verb, one at a time, and the values of options. Everything that is
 * wrong is reported here, in one line that says what is accepted. */
#ifndef LACQUER_PROGRAM_OPTIONS_H
#define LACQUER_PROGRAM_OPTIONS_H

#include "program/verb.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    CLI_END = -1, /* no more arguments */
    CLI_BAD = -2, /* a message was printed */
    CLI_WORD = 1  /* not an option: a table, a file, axis=value */
};

enum { CLI_MAX_OPTIONS = 24 };

typedef struct cli_args {
    const cli_verb *verb;
    int argc;
    char **argv;
    const char *value; /* of the argument returned last: the word, or the option's value */
    int rest;          /* the next argument after "--", where everything is a word; 0 before that */
} cli_args;

cli_args cli_args_begin(const cli_verb *verb, int argc, char **argv);
/* The id of the next option, CLI_WORD, CLI_END or CLI_BAD. */
int cli_args_next(cli_args *args);

/* A finite number, the whole text and nothing else; prints nothing. */
bool cli_number(const char *text, double *value);

/* The value of an option; on false a line was printed. `what` is named in it: "--tolerance". */
bool cli_parse_number(const char *what, const char *text, double lowest, double highest, double *value);
bool cli_parse_count(const char *what, const char *text, size_t lowest, size_t highest, size_t *value);
/* The index of `text` among `count` choices, or -1 (a line was printed). */
int cli_parse_choice(const char *what, const char *text, const char *const *choices, size_t count);

/* Print the help of a verb to stdout. */
void cli_print_help(const cli_verb *verb);

/* Append `word` to the comma-separated list in `list` (size bytes, at first an empty string). */
void cli_join(char *list, size_t size, const char *word);

#endif
