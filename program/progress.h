/* progress.h - the progress bar of a long job, and Ctrl-C.
 *
 *     cli_progress bar;
 *     cli_progress_begin(&bar, "fgd");
 *     status = lq_precompute(..., &bar.progress, ...);
 *     cli_progress_end(&bar);
 *     if (status != LQ_OK) return cli_fail_status(status, &error);   // LQ_CANCELLED: exit 130
 *
 * The bar shows on stderr when that is a terminal and the job takes more than a second. From begin to
 * end SIGINT and SIGTERM first set a flag, which makes the next report return false, so that the work is
 * taken down in order. If that takes over a second, at a second Ctrl-C, and at any time outside begin and
 * end, they print one line and exit with CLI_INTERRUPTED at once: a file being written has no name yet
 * (system/output.h), so nothing is left. */
#ifndef LACQUER_PROGRAM_PROGRESS_H
#define LACQUER_PROGRAM_PROGRESS_H

#include "lacquer.h"

typedef struct cli_progress {
    lq_progress progress; /* hand this to the library */
    const char *label;
    double start, shown; /* seconds of the monotonic clock */
    bool terminal;
} cli_progress;

void cli_progress_begin(cli_progress *bar, const char *label);
void cli_progress_end(cli_progress *bar);

/* The same for a call of several steps, each with a bar of its own; signals also wait where the call would
 * leave something behind, and its notes are printed. */
typedef struct cli_watch {
    lq_watch watch;
    cli_progress bar;
    char label[LQ_MESSAGE_SIZE];
} cli_watch;

const lq_watch *cli_watch_start(cli_watch *watch);

/* For main: from here on SIGINT and SIGTERM do as described above. */
void cli_catch_signals(void);

/* Between these a signal only sets the flag, for work that would leave something behind. */
void cli_signals_hold(void);
void cli_signals_release(void);

/* True once SIGINT or SIGTERM came, for loops of a verb's own. */
bool cli_interrupted(void);

/* Seconds of the monotonic clock. */
double cli_seconds(void);

#endif
