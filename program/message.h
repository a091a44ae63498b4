/* message.h - the one place that prints to stderr: `lacquer VERB: message`, always one line. */
#ifndef LACQUER_PROGRAM_MESSAGE_H
#define LACQUER_PROGRAM_MESSAGE_H

#include "lacquer.h"

/* The verb named by the messages from here on; NULL: none. `verb` must outlive the program's run. */
void cli_message_verb(const char *verb);

/* Print one line; cli_fail returns CLI_FAILED so that a verb can write `return cli_fail(...)`. */
void cli_message(const char *format, ...) __attribute__((format(printf, 1, 2)));
int cli_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Print that a signal stopped the verb; may be called by a signal handler. */
void cli_message_interrupted(void);

/* Report a status of the library that is not LQ_OK and give the exit code it stands for. */
int cli_fail_status(lq_status status, const lq_error *error);

#endif
