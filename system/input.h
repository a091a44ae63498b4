/* input.h - whole files into memory. */
#ifndef LACQUER_SYSTEM_INPUT_H
#define LACQUER_SYSTEM_INPUT_H

#include "lacquer.h"

/* All bytes of a regular file, with a zero byte behind them; free them. LQ_IO otherwise. */
lq_status lq_input_read(const char *path, char **bytes, size_t *size, lq_error *error);

#endif
