/* progress.c - draws the bar, and turns SIGINT and SIGTERM into a flag the work can see. */
#include "program/progress.h"

#include "program/message.h"
#include "program/verb.h"

#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 30 };
static const double SHOW_AFTER = 1.0; /* seconds: shorter jobs stay silent */
static const double SHOW_EVERY = 0.1; /* seconds between two drawings */

/* A signal handler can reach nothing but globals. */
static volatile sig_atomic_t interrupted, bar_on_screen;

static const char ERASE_LINE[] = "\r\033[K";
enum { PATIENCE = 1 }; /* seconds that the work gets to stop in order */

static void exit_now(int number) {
    (void)number;
    if (bar_on_screen && write(STDERR_FILENO, ERASE_LINE, sizeof ERASE_LINE - 1) < 0) _exit(CLI_INTERRUPTED);
    cli_message_interrupted();
    _exit(CLI_INTERRUPTED);
}

/* Work between two reports can be long: after a while, or at the second Ctrl-C, it is cut short. */
static void ask_to_stop(int number) {
    if (interrupted) exit_now(number);
    interrupted = 1;
    alarm(PATIENCE);
}

static void note(int number) {
    (void)number;
    interrupted = 1;
}

bool cli_interrupted(void) {
    return interrupted != 0;
}

double cli_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void format_time(char *text, size_t size, double seconds) {
    long whole = (long)(seconds + 0.5);
    if (whole >= 3600) snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    else snprintf(text, size, "%ld:%02ld", whole / 60, whole % 60);
}

static void draw(const cli_progress *bar, double fraction, double elapsed) {
    char left[32] = "-:--", filled[BAR_WIDTH + 1];
    if (fraction > 0) format_time(left, sizeof left, elapsed * (1 - fraction) / fraction);
    for (int i = 0; i < BAR_WIDTH; i++) filled[i] = i < (int)(fraction * BAR_WIDTH) ? '=' : ' ';
    filled[BAR_WIDTH] = '\0';
    fprintf(stderr, "\r%s [%s] %3d %%, %s left\033[K", bar->label, filled, (int)(100 * fraction), left);
    fflush(stderr);
}

static bool report(void *user, double fraction) {
    cli_progress *bar = user;
    double now = cli_seconds();
    if (bar->terminal && now - bar->start >= SHOW_AFTER && now - bar->shown >= SHOW_EVERY) {
        draw(bar, fraction, now - bar->start);
        bar->shown = now;
        bar_on_screen = 1;
    }
    return !interrupted;
}

static void on_signals(void (*handler)(int)) {
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    action.sa_handler = exit_now;
    sigaction(SIGALRM, &action, NULL);
}

void cli_catch_signals(void) {
    on_signals(exit_now);
}

void cli_signals_hold(void) {
    on_signals(note);
}

void cli_signals_release(void) {
    on_signals(exit_now);
}

void cli_progress_begin(cli_progress *bar, const char *label) {
    *bar = (cli_progress){.label = label, .start = cli_seconds(), .terminal = isatty(STDERR_FILENO) == 1};
    bar->progress = (lq_progress){.report = report, .user = bar};
    on_signals(ask_to_stop);
}

void cli_progress_end(cli_progress *bar) {
    alarm(0);
    on_signals(exit_now);
    if (bar->shown > 0) fputs(ERASE_LINE, stderr);
    bar_on_screen = 0;
}

static void begin_step(void *user, const char *step) {
    cli_watch *w = user;
    snprintf(w->label, sizeof w->label, "%s", step);
    cli_progress_begin(&w->bar, w->label);
}

static bool report_step(void *user, double fraction) {
    cli_watch *w = user;
    return report(&w->bar, fraction);
}

static void end_step(void *user) {
    cli_watch *w = user;
    cli_progress_end(&w->bar);
}

static void print_note(void *user, const char *line) {
    (void)user;
    cli_message("%s", line);
}

static void hold(void *user, bool held) {
    (void)user;
    if (held) cli_signals_hold();
    else cli_signals_release();
}

static bool go_on(void *user) {
    (void)user;
    return !interrupted;
}

const lq_watch *cli_watch_start(cli_watch *watch) {
    *watch = (cli_watch){
        .watch = {sizeof(lq_watch), begin_step, report_step, end_step, print_note, hold, go_on, watch}};
    return &watch->watch;
}
