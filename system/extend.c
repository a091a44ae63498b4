/* extend.c - a struct of any version, as far as it goes. */
#include "system/extend.h"

#include "system/status.h"

#include <string.h>

lq_status lq_extend(void *to, size_t size, const void *given, size_t first, const char *what,
                    lq_error *error) {
    size_t has;
    memcpy(&has, given, sizeof has);
    if (has < first || has > size)
        return lq_fail(error, LQ_BAD_INPUT,
                       "%s of another version, of %zu bytes; accepted: what its _default function gives",
                       what, has);
    memcpy(to, given, has);
    memcpy(to, &size, sizeof size);
    return LQ_OK;
}
