/* crew.h - processes that run the same program on the same arguments and share its long work. */
#ifndef LACQUER_SYSTEM_CREW_H
#define LACQUER_SYSTEM_CREW_H

#include "lacquer.h"

/* NULL stands for a process that is alone. What they share of files lies in one folder that all of them see.
 */
typedef struct lq_crew {
    int rank, size; /* this process, 0 <= rank < size; rank 0 reads what all have made, and writes */
    void *user;
    /* Wait for all. Where some failed, all get the status and the message of the lowest of them. */
    lq_status (*meet)(void *user, lq_status status, lq_error *error);
    /* Bytes of rank 0 to all. */
    void (*share)(void *user, void *bytes, size_t size);
} lq_crew;

#endif
