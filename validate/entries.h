/* entries.h - every stored entry of a table looked at, for what costs nothing: finite, and in physical range.
 */
#ifndef LACQUER_VALIDATE_ENTRIES_H
#define LACQUER_VALIDATE_ENTRIES_H

#include "lacquer.h"

/* What is wrong with the entries of a table, all channels. */
typedef struct lq_entries {
    size_t looked_at, faults;
    double worst; /* how far the worst is out of range; INFINITY: it is not finite; 0: none is out */
    double value; /* the worst, as all below */
    size_t index; /* its offset in the data of `channel` */
    int channel;
    double at[LQ_MAX_AXES];
} lq_entries;

/* What float32 may add to a bound of the range. */
#define LQ_RANGE_SLACK 1e-7

/* How far `x` is out of the range of the kind; INFINITY for what is no number. */
double lq_out_of_range(const lq_kind *kind, double x);

/* A fault is an entry out of range by more than LQ_RANGE_SLACK. */
lq_entries lq_entries_look(const lq_table *table, const lq_kind *kind);

/* The coordinates of an entry. */
void lq_entry_point(const lq_table *table, size_t index, double *at);

#endif
