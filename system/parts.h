/* parts.h - long work as numbered parts, each of which is made once and is read when it is wanted.
 *
 * They are kept in memory; beyond a limit in a file without a name, which goes with the process; or in a
 * folder beside the target. There a run that was killed leaves what it finished to the next one of the same
 * key, and the processes of a crew find what the others made. Parts depend on their number and the key alone,
 * so that what is made of them is the same, bit for bit, whoever made which.
 */
#ifndef LACQUER_SYSTEM_PARTS_H
#define LACQUER_SYSTEM_PARTS_H

#include "system/crew.h"

typedef struct lq_parts lq_parts;

/* {0}: in memory. */
typedef struct lq_parts_place {
    const char *folder;  /* made where it is missing; NULL: nothing is left to another run */
    const char *key;     /* of a folder: lines "name value" of all that decides what its parts are */
    const char *beside;  /* without one: the file in whose folder the file without a name is; NULL: none is */
    size_t most;         /* bytes in memory where there is `beside` */
    const lq_crew *crew; /* with a folder only */
} lq_parts_place;

/* LQ_BAD_INPUT: the folder has parts of another key, which are neither mixed in nor lost, is used by another
 * run, or is no folder of parts. */
lq_status lq_parts_open(lq_parts **parts, const lq_parts_place *place, lq_error *error);

/* Part `index`: memory, which is taken over, and its size. */
typedef lq_status lq_part_make(void *user, size_t index, int thread, void **bytes, size_t *size,
                               lq_error *error);

/* Make the parts of these numbers that are not there, on all cores as lq_parallel does and with the whole
 * crew; when it returns all of them can be read. */
lq_status lq_parts_make(lq_parts *parts, const size_t *index, size_t count, int threads, lq_part_make *make,
                        void *user, const lq_progress *progress, lq_error *error);

/* Bytes of a part from an offset on; several threads may do so at once. */
lq_status lq_parts_read(lq_parts *parts, size_t index, size_t offset, size_t size, void *bytes,
                        lq_error *error);
size_t lq_parts_size(lq_parts *parts, size_t index); /* 0: it cannot be read */

/* How many of those made in this process were there before. */
size_t lq_parts_found(const lq_parts *parts);

/* `whole`: what they were for is there, and the folder goes. NULL is fine. */
void lq_parts_close(lq_parts *parts, bool whole);

#endif
