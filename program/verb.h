/* verb.h - what a verb is, and how to write one.
 *
 * A verb is one file NAME.c here, or a folder NAME/ with NAME.c in it, with one definition
 *
 *     const cli_verb cli_verb_NAME = {"NAME", "one line", "FILE [options]", options, notes, examples, run};
 *
 * declared below and listed in program/verbs.c. `run` gets argv[0] = the verb's name and returns an exit
 * code of cli_exit. --help is handled before it is called, from the same fields. An option is a row that says
 * what its value may be, which field of the verb's request it fills, and in which modes it means anything:
 *
 *     static const cli_option options[] = {
 *         {'o', "output", "FILE", "where to write", CLI_TEXT(my_request, output), .silent = true},
 *         {SAMPLES, "samples", "N", "walks", CLI_COUNT(my_request, samples, 1, 1000000), .modes = WALKS},
 *         CLI_SETTINGS_OPTIONS(my_request, 0), {0}};
 *     ...
 *     my_request request = {...defaults...};
 *     cli_given given;
 *     if (!cli_parse(&cli_verb_NAME, argc, argv, &request, take_word, &given)) return CLI_FAILED;
 *     if (!cli_suits(&given, WALKS, "for a walk")) return CLI_FAILED;   // once the mode is known
 *
 * What else a verb uses: program/message.h (every line on stderr), program/options.h (numbers, choices),
 * program/settings.h (--ndf, --scattering, --masking, --tolerance, --threads), program/progress.h (the bar,
 * Ctrl-C), program/output.h (is the output path writable, before hours of work). Results go to stdout
 * with printf; main checks that they got there.
 */
#ifndef LACQUER_PROGRAM_VERB_H
#define LACQUER_PROGRAM_VERB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Exit codes of the program. */
typedef enum cli_exit {
    CLI_DONE = 0,         /* done and within budget */
    CLI_FAILED = 1,       /* could not run: bad input, input or output refused */
    CLI_EXCEEDED = 2,     /* ran, but a tolerance or budget was exceeded */
    CLI_INTERRUPTED = 130 /* stopped by SIGINT or SIGTERM; nothing was left behind */
} cli_exit;

/* What the value of an option is, and the type of the field it fills. */
typedef enum cli_type {
    CLI_TYPE_TEXT,   /* const char * */
    CLI_TYPE_FLAG,   /* bool; takes no value */
    CLI_TYPE_NUMBER, /* double */
    CLI_TYPE_COUNT,  /* size_t */
    CLI_TYPE_CHOICE, /* int, or an enumeration: the index in `choices` */
    CLI_TYPE_LIST,   /* cli_texts; the option may be repeated */
    CLI_TYPE_READ    /* anything, by `read` */
} cli_type;

enum { CLI_LIST_SIZE = 16, CLI_MAX_OPTIONS = 48 };

typedef struct cli_texts {
    size_t count;
    const char *text[CLI_LIST_SIZE];
} cli_texts;

/* One option of a verb. `id` is its letter where it has a short form, otherwise any number from 256;
 * 512 and above are taken by program/settings.h. */
typedef struct cli_option {
    int id;
    const char *name;    /* without the dashes; NULL ends a list */
    const char *value;   /* what its value is called in help, "FILE"; NULL: it takes none */
    const char *meaning; /* one line, with the default */
    cli_type type;
    size_t at;                                    /* of the field in the verb's request */
    double lowest, highest;                       /* of a number or count, both accepted */
    const char *const *choices;                   /* ends with NULL */
    bool (*read)(void *field, const char *value); /* false: a line was printed */
    unsigned modes;                               /* of the verb in which it means anything; 0: all */
    bool silent; /* results do not depend on it: it is left out of the command a file records */
} cli_option;

/* The offset of a field, which must be as large as what is written there. */
#define CLI_AT(REQUEST, field, TYPE)                                                                         \
    (offsetof(REQUEST, field) + 0 * sizeof(char[sizeof(((REQUEST *)0)->field) == sizeof(TYPE) ? 1 : -1]))

/* The rest of a row, by its type. */
#define CLI_TEXT(REQUEST, field) .type = CLI_TYPE_TEXT, .at = CLI_AT(REQUEST, field, const char *)
#define CLI_FLAG(REQUEST, field) .type = CLI_TYPE_FLAG, .at = CLI_AT(REQUEST, field, bool)
#define CLI_NUMBER(REQUEST, field, low, high)                                                                \
    .type = CLI_TYPE_NUMBER, .at = CLI_AT(REQUEST, field, double), .lowest = (low), .highest = (high)
#define CLI_COUNT(REQUEST, field, low, high)                                                                 \
    .type = CLI_TYPE_COUNT, .at = CLI_AT(REQUEST, field, size_t), .lowest = (low), .highest = (high)
#define CLI_CHOICE(REQUEST, field, names)                                                                    \
    .type = CLI_TYPE_CHOICE, .at = CLI_AT(REQUEST, field, int), .choices = (names)
#define CLI_LIST(REQUEST, field) .type = CLI_TYPE_LIST, .at = CLI_AT(REQUEST, field, cli_texts)
#define CLI_READ(REQUEST, field, function)                                                                   \
    .type = CLI_TYPE_READ, .at = offsetof(REQUEST, field), .read = (function)

typedef struct cli_verb {
    const char *name;
    const char *summary;       /* one line */
    const char *usage;         /* what follows `lacquer NAME`; one form a line */
    const cli_option *options; /* ends with {0} */
    size_t option_count;       /* CLI_COUNTED(options) */
    void (*notes)(FILE *out);  /* more help, such as the tables of the catalogue; NULL: none */
    const char *examples;      /* worked examples, one a line */
    int (*run)(int argc, char **argv);
    bool shares; /* several processes (program/crew.h) may run it, some of its forms at least */
} cli_verb;

/* How many rows an array has before its {0}; more than a cli_given records do not compile. */
#define CLI_COUNTED(options)                                                                                 \
    (sizeof(options) / sizeof *(options)-1 +                                                                 \
     0 * sizeof(char[sizeof(options) / sizeof *(options) <= CLI_MAX_OPTIONS + 1 ? 1 : -1]))

extern const cli_verb cli_verb_list;
extern const cli_verb cli_verb_eval;
extern const cli_verb cli_verb_precompute;
extern const cli_verb cli_verb_validate;
extern const cli_verb cli_verb_pca;
extern const cli_verb cli_verb_pack;
extern const cli_verb cli_verb_info;
extern const cli_verb cli_verb_fit;
extern const cli_verb cli_verb_bench;
extern const cli_verb cli_verb_stack;
extern const cli_verb cli_verb_view;

/* All verbs in the order help shows them; NULL beyond the last. */
const cli_verb *cli_verb_at(size_t i);
/* NULL where there is none of that name. */
const cli_verb *cli_verb_find(const char *name);

#endif
