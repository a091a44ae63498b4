/* main.c - the lacquer program: finds the verb, prints help, checks that output arrived. */
#include "lacquer.h"
#include "program/crew.h"
#include "program/message.h"
#include "program/options.h"
#include "program/progress.h"
#include "program/terminal.h"
#include "program/verb.h"
#include "system/status.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

static const char usage[] = "Usage: lacquer VERB [arguments]\n"
                            "\n"
                            "Make, store and check the look-up tables of layered-material renderers.\n"
                            "\n"
                            "Verbs:\n";

static const char usage_end[] =
    "\n"
    "`lacquer VERB --help`, or `lacquer help VERB`, shows its options, their defaults and worked examples.\n"
    "\n"
    "Options:\n"
    "  -h, --help     this text\n"
    "      --version  the version\n"
    "\n"
    "Exit codes:\n"
    "  0    done, within tolerance and budget\n"
    "  1    could not run: one line on stderr says why and what is accepted\n"
    "  2    ran, but a tolerance or budget was exceeded\n"
    "  130  stopped by Ctrl-C (SIGINT) or SIGTERM; no partial file is left\n"
    "\n"
    "Examples:\n"
    "  lacquer list\n"
    "  lacquer eval fgd mu=0.3 alpha=0.5 n=0.2 kappa=3.9\n"
    "  lacquer precompute albedo -o albedo.exr\n";

static void print_usage(void) {
    fputs(usage, stdout);
    for (size_t i = 0; cli_verb_at(i); i++)
        printf("  %-11s %s\n", cli_verb_at(i)->name, cli_verb_at(i)->summary);
    fputs(usage_end, stdout);
}

static void list_verbs(char *list, size_t size) {
    list[0] = '\0';
    for (size_t i = 0; cli_verb_at(i); i++) lq_list_add(list, size, cli_verb_at(i)->name);
}

static bool is_help(const char *word) {
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
}

static bool asks_help(int argc, char **argv) {
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (is_help(argv[i])) return true;
    return false;
}

/* `help`, or `help VERB`. */
static int help(int argc, char **argv, const char *known) {
    const cli_verb *verb = argc > 1 && !is_help(argv[1]) ? cli_verb_find(argv[1]) : NULL;
    if (argc > 2) return cli_fail("unexpected '%s'; help takes one verb: %s", argv[2], known);
    if (argc > 1 && !verb && !is_help(argv[1]))
        return cli_fail("unknown verb '%s'; known: %s", argv[1], known);
    if (verb) cli_print_help(verb);
    else print_usage();
    return CLI_DONE;
}

static int run(int argc, char **argv) {
    char known[256];
    list_verbs(known, sizeof known);
    if (argc < 2) return cli_fail("no verb; known: %s; see lacquer --help", known);
    if (is_help(argv[1]) || strcmp(argv[1], "help") == 0) return help(argc - 1, argv + 1, known);
    if (strcmp(argv[1], "--version") == 0) {
        puts("lacquer " LQ_VERSION);
        return CLI_DONE;
    }
    const cli_verb *verb = cli_verb_find(argv[1]);
    if (!verb && argv[1][0] == '-')
        return cli_fail("unknown option '%s'; accepted before a verb: --help, --version", argv[1]);
    if (!verb) return cli_fail("unknown verb '%s'; known: %s", argv[1], known);
    cli_message_verb(verb->name);
    if (asks_help(argc - 1, argv + 1)) {
        cli_print_help(verb);
        return CLI_DONE;
    }
    if (cli_crew() && !verb->shares)
        return cli_fail("is work for one process; accepted of several: precompute, validate layered");
    return verb->run(argc - 1, argv + 1);
}

/* A closed stream's number would be given to the next file that is opened. Open the other way about, it still
 * fails where it is used. */
static void fill_closed_streams(void) {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
            return;
}

static int run_whole(int argc, char **argv) {
    /* A write beyond a file size limit must come back as an error that cleans up, not as a kill. */
    signal(SIGXFSZ, SIG_IGN);
    cli_catch_signals();
    if (!cli_guard_stdout()) return cli_fail("no memory to print with");
    int code = run(argc, argv);
    if (code == CLI_FAILED || code == CLI_INTERRUPTED) return code; /* one line is said already */
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    return cli_fail("cannot write to standard output: %s",
                    errno ? strerror(errno) : "an earlier write failed");
}

int main(int argc, char **argv) {
    fill_closed_streams();
    cli_crew_begin(&argc, &argv);
    return cli_crew_end(run_whole(argc, argv));
}
