/* status.h - the one place where the messages of the library are made. */
#ifndef LACQUER_SYSTEM_STATUS_H
#define LACQUER_SYSTEM_STATUS_H

#include "lacquer.h"

/* Put a message into `error` (which may be NULL) and return `status`, so that a function fails in one
 * line: return lq_fail(error, LQ_IO, "%s: ...", path). Text that does not fit is cut, line breaks and
 * other control characters become spaces. The arguments may include error->text itself. */
lq_status lq_fail(lq_error *error, lq_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Append `word` to a comma-separated list of what is accepted, at first an empty string of `size` bytes; what
 * does not fit is cut. */
void lq_list_add(char *list, size_t size, const char *word);

#endif
