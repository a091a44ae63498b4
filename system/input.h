/* input.h - whole files into memory. */
#ifndef LACQUER_SYSTEM_INPUT_H
#define LACQUER_SYSTEM_INPUT_H

#include <stdio.h>

#include "lacquer.h"

/* Open a regular file of at most `largest` bytes for reading. LQ_IO for anything else: a device or a pipe
 * (which is not waited for), a larger file. */
lq_status lq_input_open(FILE **in, const char *path, size_t largest, lq_error *error);

/* All bytes of such a file, with a zero byte behind them; free them. LQ_IO otherwise. */
lq_status lq_input_read_within(const char *path, size_t largest, char **bytes, size_t *size, lq_error *error);
/* Of any size. */
lq_status lq_input_read(const char *path, char **bytes, size_t *size, lq_error *error);

#endif
