/* terminal.h - what the program prints cannot steer the terminal, whatever the files hold that it comes from.
 */
#ifndef LACQUER_PROGRAM_TERMINAL_H
#define LACQUER_PROGRAM_TERMINAL_H

#include <stdbool.h>

/* From here on everything printed to stdout is cleaned on its way (system/utf8.h; line breaks and tabs stay).
 * False: no memory for that. Messages are cleaned where they are made. */
bool cli_guard_stdout(void);

#endif
