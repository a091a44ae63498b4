/* output.h - can a file be written there? Asked before the work, not after it. */
#ifndef LACQUER_PROGRAM_OUTPUT_H
#define LACQUER_PROGRAM_OUTPUT_H

#include <stdbool.h>

/* The folder of `path` exists and takes new files, and `path` itself is not a folder and not protected.
 * False: a line was printed. */
bool cli_output_check(const char *path);

/* What follows the last slash. */
const char *cli_basename(const char *path);

#endif
