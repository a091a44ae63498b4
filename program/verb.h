/* verb.h - what a verb is, and how to write one.
 *
 * A verb is one file NAME.c here, or a folder NAME/ with NAME.c in it, with one definition
 *
 *     const cli_verb cli_verb_NAME = {"NAME", "one line", "FILE [options]", options, notes, examples, run};
 *
 * declared below and listed in program/verbs.c. `run` gets argv[0] = the verb's name and returns an exit
 * code of cli_exit. --help is handled before it is called, from the same fields. Inside, the pattern is
 *
 *     cli_args args = cli_args_begin(&cli_verb_NAME, argc, argv);
 *     for (int id; (id = cli_args_next(&args)) != CLI_END;) {
 *         if (id == CLI_BAD) return CLI_FAILED;              // its line is already printed
 *         if (id == CLI_WORD) ... args.value                 // an argument that is no option
 *         if (id == OPTION_SAMPLES && !cli_parse_count("--samples", args.value, 1, 1000000000, &samples))
 *             return CLI_FAILED;
 *     }
 *
 * What else a verb uses: program/message.h (every line on stderr), program/options.h (numbers, choices),
 * program/settings.h (--ndf, --scattering, --masking, --tolerance, --threads), program/progress.h (the bar,
 * Ctrl-C), program/output.h (is the output path writable, before hours of work). Results go to stdout
 * with printf; main checks that they got there.
 */
#ifndef LACQUER_PROGRAM_VERB_H
#define LACQUER_PROGRAM_VERB_H

#include <stdio.h>

/* Exit codes of the program. */
typedef enum cli_exit {
    CLI_DONE = 0,         /* done and within budget */
    CLI_FAILED = 1,       /* could not run: bad input, input or output refused */
    CLI_EXCEEDED = 2,     /* ran, but a tolerance or budget was exceeded */
    CLI_INTERRUPTED = 130 /* stopped by SIGINT or SIGTERM; nothing was left behind */
} cli_exit;

/* One option of a verb. `id` is its letter where it has a short form, otherwise any number from 256;
 * 512 and above are taken by program/settings.h. */
typedef struct cli_option {
    int id;
    const char *name;    /* without the dashes; NULL ends a list */
    const char *value;   /* what its value is called in help, "FILE"; NULL: it takes none */
    const char *meaning; /* one line, with the default */
} cli_option;

typedef struct cli_verb {
    const char *name;
    const char *summary;       /* one line */
    const char *usage;         /* what follows `lacquer NAME`; one form a line */
    const cli_option *options; /* ends with {0} */
    void (*notes)(FILE *out);  /* more help, such as the tables of the catalogue; NULL: none */
    const char *examples;      /* worked examples, one a line */
    int (*run)(int argc, char **argv);
} cli_verb;

extern const cli_verb cli_verb_list;
extern const cli_verb cli_verb_eval;
extern const cli_verb cli_verb_precompute;
extern const cli_verb cli_verb_validate;
extern const cli_verb cli_verb_pca;
extern const cli_verb cli_verb_pack;
extern const cli_verb cli_verb_info;
extern const cli_verb cli_verb_fit;
extern const cli_verb cli_verb_bench;

/* All verbs in the order help shows them; NULL beyond the last. */
const cli_verb *cli_verb_at(size_t i);
/* NULL where there is none of that name. */
const cli_verb *cli_verb_find(const char *name);

#endif
