/* Draws the points at which a table is checked: stored entries, and points anywhere between them. */
#ifndef LACQUER_VALIDATE_DRAW_H
#define LACQUER_VALIDATE_DRAW_H

#include "lacquer.h"

#include <stdint.h>

typedef struct lq_drawn {
    double at[LQ_MAX_AXES];
    size_t index[LQ_MAX_AXES]; /* of a stored entry; unused between them */
    size_t entry;              /* its offset in the data of a channel */
} lq_drawn;

/* The point number `i` of a seed. A third of all points has mu <= 0.1 and, independently, a third has
 * alpha <= 0.1, where tables are hardest; otherwise every node or value of an axis is as likely. */
lq_drawn lq_draw_entry(const lq_axis *axes, int axis_count, uint64_t seed, size_t i);
lq_drawn lq_draw_between(const lq_axis *axes, int axis_count, uint64_t seed, size_t i);

#endif
