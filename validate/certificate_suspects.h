/* Entries of a table that stick out of their neighbours, as one damaged entry does.
 *
 * A single damaged entry of millions is not met by chance. But it departs from the cubic through its
 * neighbours along every axis at once, where the values themselves depart along some axes only, and where
 * they do along all, they do so beside it as well.
 */
#ifndef LACQUER_VALIDATE_CERTIFICATE_SUSPECTS_H
#define LACQUER_VALIDATE_CERTIFICATE_SUSPECTS_H

#include "lacquer.h"

enum { LQ_LISTED = 16, LQ_SUSPECTS = 2 * LQ_LISTED };

typedef struct lq_suspect {
    size_t index;
    int channel;
    double score; /* 0: an empty place of a list */
} lq_suspect;

/* The LQ_LISTED entries that depart most, and as many that depart most compared with what is beside them.
 * Departures up to `tolerance` mean nothing. */
void lq_suspects_find(const lq_table *table, double tolerance, lq_suspect list[LQ_SUSPECTS]);

#endif
