/* message.c - the one place that prints to stderr. */
#include "program/message.h"

#include "program/verb.h"
#include "system/utf8.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char *verb_name;

void cli_message_verb(const char *verb) {
    verb_name = verb;
}

/* Line breaks in user text must not turn one message into two lines, nor escapes steer the terminal. */
static void print_line(const char *format, va_list arguments) {
    char text[2 * LQ_MESSAGE_SIZE];
    vsnprintf(text, sizeof text, format, arguments);
    lq_utf8_clean(text, strlen(text), "");
    fflush(stdout); /* results printed so far come before the message where both go to one place */
    if (verb_name) fprintf(stderr, "lacquer %s: %s\n", verb_name, text);
    else fprintf(stderr, "lacquer: %s\n", text);
}

void cli_message(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line(format, arguments);
    va_end(arguments);
}

int cli_fail(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line(format, arguments);
    va_end(arguments);
    return CLI_FAILED;
}

static void put(const char *text) {
    size_t length = strlen(text);
    while (length > 0) {
        ssize_t wrote = write(STDERR_FILENO, text, length);
        if (wrote <= 0) return;
        text += wrote;
        length -= (size_t)wrote;
    }
}

void cli_message_interrupted(void) {
    put(verb_name ? "lacquer " : "lacquer");
    if (verb_name) put(verb_name);
    put(": interrupted\n");
}

int cli_fail_status(lq_status status, const lq_error *error) {
    if (status == LQ_CANCELLED) {
        cli_message_interrupted();
        return CLI_INTERRUPTED;
    }
    cli_message("%s", error->text[0] ? error->text : "failed without a message");
    return status == LQ_NOT_CONVERGED ? CLI_EXCEEDED : CLI_FAILED;
}
