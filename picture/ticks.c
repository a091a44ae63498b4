/* ticks.c - steps of 1, 2 and 5 from coarse to fine. */
#include "picture/ticks.h"
#include "system/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* On an uneven axis a finer step goes as far as its multiples are round numbers: 0.15, not 0.34.
 * More than the finest step of a usual range has; those of a range no wider than rounding have no end. */
enum { MULTIPLES_MAX = 1 << 15, STEPS = 12, ROUND = 10 };

/* Places this close are one. */
static const double same = 1e-9;

/* A range of values and where they lie. */
typedef struct ruler {
    const lq_axis *axis; /* NULL: linear */
    bool even;           /* nothing lies closer to its neighbours than anything else */
    double low, high, gap;
    lq_tick *ticks;
    size_t count;
} ruler;

double lq_tick_at(const lq_axis *axis, double value) {
    return axis->size > 1 ? lq_axis_locate(axis, value) / (double)(axis->size - 1) : 0.0;
}

static double place(const ruler *r, double value) {
    return r->axis ? lq_tick_at(r->axis, value) : (value - r->low) / (r->high - r->low);
}

/* Step number `i` of a falling sequence 10, 5, 2, 1, 0.5, ... of powers of ten. */
static double step_of(double start, int i) {
    static const double lead[] = {1.0, 0.5, 0.2};
    return start * lead[i % 3] * pow(10.0, -floor(i / 3.0));
}

/* The multiples of a step within the range: number `i` of `count`. */
typedef struct multiples {
    double step, first;
    int count;
} multiples;

static multiples of_step(const ruler *r, double step) {
    const double first = ceil(r->low / step - 1e-9), last = floor(r->high / step + 1e-9);
    return (multiples){step, first, (int)fmin(last - first + 1.0, MULTIPLES_MAX)};
}

static double multiple(const multiples *m, int i) {
    return m->first + i == 0.0 ? 0.0 : (m->first + i) * m->step;
}

/* How many ticks lie before a place: which interval between them it is in; *room is how far the nearest is.
 */
static size_t interval(const ruler *r, double at, double *room) {
    size_t before = 0;
    *room = INFINITY;
    for (size_t i = 0; i < r->count; i++) {
        before += r->ticks[i].at < at;
        *room = fmin(*room, fabs(r->ticks[i].at - at));
    }
    return before;
}

/* Which intervals have no room for all the multiples in them; how many there are. */
static size_t find_full(const ruler *r, const multiples *m, bool full[LQ_TICKS_MAX + 1]) {
    double last = -INFINITY, room = 0.0;
    size_t count = 0;
    for (size_t i = 0; i <= LQ_TICKS_MAX; i++) full[i] = false;
    for (int i = 0; i < m->count; i++) {
        const double at = place(r, multiple(m, i));
        const size_t k = interval(r, at, &room);
        if (room < same) { /* a tick already */
            last = at;
            continue;
        }
        if ((room < r->gap || at - last < r->gap) && !full[k]) {
            full[k] = true;
            count++;
        }
        last = at;
    }
    return count;
}

static void add(ruler *r, const multiples *m, const bool full[LQ_TICKS_MAX + 1]) {
    const ruler before = *r;
    double from_ticks = 0.0, room = 0.0;
    for (int i = 0; i < m->count && r->count < LQ_TICKS_MAX; i++) {
        const double value = multiple(m, i), at = place(r, value);
        const size_t k = interval(&before, at, &from_ticks);
        interval(r, at, &room);
        if (from_ticks < same || room < r->gap || (r->even ? full[k] : value - r->low > ROUND * m->step))
            continue;
        lq_tick *tick = &r->ticks[r->count++];
        *tick = (lq_tick){.value = value, .at = at};
        lq_print(tick->text, sizeof tick->text, "%.6g", value);
    }
}

static int by_place(const void *a, const void *b) {
    const double x = ((const lq_tick *)a)->at, y = ((const lq_tick *)b)->at;
    return (x > y) - (x < y);
}

/* From coarse to fine: as long as a step has no room anywhere, the coarser ones stand. */
static size_t fill(ruler *r) {
    const double start = pow(10.0, ceil(log10(r->high - r->low)));
    bool full[LQ_TICKS_MAX + 1];
    r->gap = fmax(r->gap, 1.0 / (LQ_TICKS_MAX - 2)) * (1.0 - 1e-9); /* rounding is no lack of room */
    for (int i = 0; i < STEPS; i++) {
        const multiples m = of_step(r, step_of(start, i));
        const ruler empty = {r->axis, r->even, r->low, r->high, r->gap, r->ticks, 0};
        if (find_full(&empty, &m, full) == 0) r->count = 0;
        find_full(r, &m, full);
        add(r, &m, full);
        qsort(r->ticks, r->count, sizeof *r->ticks, by_place);
    }
    return r->count;
}

/* The one value of an axis of one node. */
static size_t alone(double value, lq_tick *tick) {
    *tick = (lq_tick){.value = value, .at = 0.0};
    lq_print(tick->text, sizeof tick->text, "%.6g", value);
    return 1;
}

size_t lq_ticks(const lq_axis *axis, double gap, lq_tick ticks[LQ_TICKS_MAX]) {
    if (axis->size < 2) return alone(axis->min, ticks);
    ruler r = {axis, axis->map == LQ_MAP_LINEAR, axis->min, axis->max, gap, ticks, 0};
    return fill(&r);
}

size_t lq_ticks_linear(double low, double high, double gap, lq_tick ticks[LQ_TICKS_MAX]) {
    ruler r = {NULL, true, low, high, gap, ticks, 0};
    return fill(&r);
}
