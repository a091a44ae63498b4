/* extend.h - options that begin with their size, from callers compiled with an older header. */
#ifndef LACQUER_SYSTEM_EXTEND_H
#define LACQUER_SYSTEM_EXTEND_H

#include "lacquer.h"

/* Copy what the caller's header knew of `given`, whose first member is its size in bytes, over the defaults
 * that `to`, of `size` bytes, holds; what that header did not have stays a default. `first`: bytes of the
 * struct in its first version. LQ_BAD_INPUT names `what` where the size is none that any version had. */
lq_status lq_extend(void *to, size_t size, const void *given, size_t first, const char *what,
                    lq_error *error);

#endif
