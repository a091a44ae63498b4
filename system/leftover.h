/* leftover.h - temporary files beside a target that a run which was killed could not take away. */
#ifndef LACQUER_SYSTEM_LEFTOVER_H
#define LACQUER_SYSTEM_LEFTOVER_H

#include <stdbool.h>
#include <stddef.h>

/* Names are LQ_TEMPORARY PID-NUMBER; one that is in use is locked by who uses it. */
#define LQ_TEMPORARY ".lacquer-"

/* Lock a temporary file before it gets its name, so that nobody takes it for a leftover; the lock is another
 * descriptor of the file, closed when the name is gone. -1: not to be had, which is no reason to stop. */
int lq_leftover_lock(int file);

/* Remove what nobody uses: regular files of this user's by such names. `folder`: its first `length` bytes are
 * the path, 0 the current one. */
void lq_leftovers_clear(const char *folder, size_t length);

#endif
