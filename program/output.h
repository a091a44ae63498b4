/* output.h - can a file be written there? Asked before the work, not after it. */
#ifndef LACQUER_PROGRAM_OUTPUT_H
#define LACQUER_PROGRAM_OUTPUT_H

#include <stdbool.h>

#include "system/json.h"

/* The folder of `path` exists and takes new files, and `path` itself is not a folder and not protected.
 * False: a line was printed. */
bool cli_output_check(const char *path);

/* The folder of a page: it is made where it does not exist, and takes its index.html. False: a line was
 * printed. */
bool cli_report_folder(const char *folder);

/* Print `root`, which is freed, on stdout, with jansson's `flags`. False, and a line on stderr: no memory,
 * and nothing was printed. */
bool cli_print_json(json_t *root, size_t flags);

/* What follows the last slash. */
const char *cli_basename(const char *path);

#endif
