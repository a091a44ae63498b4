/* ticks.h - round values along an axis, where its own map puts them. */
#ifndef LACQUER_PICTURE_TICKS_H
#define LACQUER_PICTURE_TICKS_H

#include "lacquer.h"

enum { LQ_TICKS_MAX = 32, LQ_TICK_TEXT = 24 };

typedef struct lq_tick {
    double value, at; /* `at` in [0,1] along the axis */
    char text[LQ_TICK_TEXT];
} lq_tick;

/* Where `value` lies on an axis drawn in its own map: nodes are evenly spaced. 0 of an axis of one node. */
double lq_tick_at(const lq_axis *axis, double value);

/* Round values at least `gap` of the axis apart, in order: steps of 1, 2 and 5 as fine as fit everywhere,
 * then finer ones where the map leaves room. */
size_t lq_ticks(const lq_axis *axis, double gap, lq_tick ticks[LQ_TICKS_MAX]);

/* The same from `low` to `high` > low, evenly. */
size_t lq_ticks_linear(double low, double high, double gap, lq_tick ticks[LQ_TICKS_MAX]);

#endif
