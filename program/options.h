/* options.h - the arguments of a verb, and the values of options. Everything that is
 * wrong is reported here, in one line that says what is accepted. */
#ifndef LACQUER_PROGRAM_OPTIONS_H
#define LACQUER_PROGRAM_OPTIONS_H

#include "program/verb.h"

#include <stdbool.h>
#include <stddef.h>

/* The options a command gave. */
typedef struct cli_given {
    const cli_verb *verb;
    const char *text[CLI_MAX_OPTIONS]; /* by row: the value ("" of a flag), NULL where it was not given */
} cli_given;

/* Fill `request` from the arguments: options by the rows of the verb, words through `word` (NULL: the verb
 * takes none). False: a line was printed. */
bool cli_parse(const cli_verb *verb, int argc, char **argv, void *request,
               bool (*word)(void *request, const char *word), cli_given *given);

/* What was given of an option of this verb, or NULL. */
const char *cli_given_text(const cli_given *given, int id);

/* Refuse, in one line, options that mean nothing in the mode a command turned out to ask for; `where` says it
 * in words: "with --from". */
bool cli_suits(const cli_given *given, unsigned mode, const char *where);

/* The command line in a fixed order, without what does not change results: the same result is the same file,
 * bit for bit. `request` is the one that was filled. Free it; NULL: out of memory. */
char *cli_command(const cli_given *given, const void *request, const char *words);

/* A finite number, the whole text and nothing else; prints nothing. */
bool cli_number(const char *text, double *value);

/* The value of an option; on false a line was printed. `what` is named in it: "--tolerance". */
bool cli_parse_number(const char *what, const char *text, double lowest, double highest, double *value);
bool cli_parse_count(const char *what, const char *text, size_t lowest, size_t highest, size_t *value);
/* The index of `text` among `count` choices, or -1 (a line was printed). */
int cli_parse_choice(const char *what, const char *text, const char *const *choices, size_t count);

/* --layout: the number of a published layout into an int. */
bool cli_read_layout(void *field, const char *value);

/* Print the help of a verb to stdout. */
void cli_print_help(const cli_verb *verb);

#endif
