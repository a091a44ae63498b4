/* Stratified random points of a table: the low ends of mu and alpha get their share on any grid. */
#include "validate/draw.h"

#include "validate/stream.h"

#include <math.h>
#include <string.h>

static const double low_end = 0.1;

/* Key words of the streams; walks use small numbers. */
enum { DRAW_ENTRY = 0x656e7472, DRAW_BETWEEN = 0x62747765 };

/* Is this axis held to its low end for point i? The strata of mu and alpha cross. */
static bool held_low(const lq_axis *axis, size_t i) {
    if (axis->min > low_end) return false;
    if (strcmp(axis->name, "mu") == 0) return i % 3 == 0;
    if (strcmp(axis->name, "alpha") == 0) return i / 3 % 3 == 0;
    return false;
}

static size_t draw_node(const lq_axis *axis, size_t i, lq_stream *stream) {
    size_t count = axis->size;
    if (held_low(axis, i))
        while (count > 1 && axis->nodes[count - 1] > low_end) count--;
    return (size_t)(lq_stream_uniform(stream) * (double)count);
}

static double draw_value(const lq_axis *axis, size_t i, lq_stream *stream) {
    const double max = held_low(axis, i) ? fmin(axis->max, low_end) : axis->max;
    return axis->min + (max - axis->min) * lq_stream_uniform(stream);
}

lq_drawn lq_draw_entry(const lq_axis *axes, int axis_count, uint64_t seed, size_t i) {
    lq_stream stream = lq_stream_open(seed, DRAW_ENTRY, i);
    lq_drawn drawn = {.entry = 0};
    size_t stride = 1;
    for (int a = 0; a < axis_count; a++) {
        drawn.index[a] = draw_node(&axes[a], i, &stream);
        drawn.at[a] = axes[a].nodes[drawn.index[a]];
        drawn.entry += stride * drawn.index[a];
        stride *= axes[a].size;
    }
    return drawn;
}

lq_drawn lq_draw_between(const lq_axis *axes, int axis_count, uint64_t seed, size_t i) {
    lq_stream stream = lq_stream_open(seed, DRAW_BETWEEN, i);
    lq_drawn drawn = {.entry = 0};
    for (int a = 0; a < axis_count; a++) drawn.at[a] = draw_value(&axes[a], i, &stream);
    return drawn;
}
