/* Departures from local cubics over all entries, and the largest of them. */
#include "validate/certificate_suspects.h"

#include <math.h>
#include <string.h>

/* |v - cubic through the four nearest others| along an axis, from the values `v`, `stride` apart, at place i
 * of n >= 5: at the ends the cubic is an extrapolation. */
static double departure(const float *v, size_t i, size_t n, size_t stride) {
    const double at = (double)v[i * stride];
    if (i >= 2 && i + 2 < n)
        return fabs(at - (4.0 * ((double)v[(i - 1) * stride] + (double)v[(i + 1) * stride]) -
                          (double)v[(i - 2) * stride] - (double)v[(i + 2) * stride]) /
                             6.0);
    const bool low = i < 2;
    const size_t end = low ? 0 : n - 1;
    const double w[2][5] = {{0, 4, -6, 4, -1}, {0.25, 0, 1.5, -1.0, 0.25}};
    const size_t place = low ? i : end - i;
    double sum = 0.0;
    for (size_t k = 0; k < 5; k++) sum += w[place][k] * (double)v[(low ? k : end - k) * stride];
    return fabs(at - sum);
}

/* Along one axis, at an entry. */
static double departure_at(const lq_table *table, int channel, size_t index, int axis) {
    size_t stride = 1;
    for (int a = 0; a < axis; a++) stride *= table->axes[a].size;
    const size_t n = table->axes[axis].size, i = index / stride % n;
    return departure(table->channels[channel] + (index - i * stride), i, n, stride);
}

/* The least departure over the axes of five nodes or more; 0 where there is none. */
static double sticks_out(const lq_table *table, int channel, size_t index) {
    double least = INFINITY;
    for (int a = 0; a < table->axis_count; a++)
        if (table->axes[a].size >= 5) least = fmin(least, departure_at(table, channel, index, a));
    return isfinite(least) ? least : 0.0;
}

/* Largest departure along `axis` on the lines beside an entry, which do not hold it. */
static double beside(const lq_table *table, int channel, size_t index, int axis) {
    double most = 0.0;
    size_t stride = 1;
    for (int a = 0; a < table->axis_count; stride *= table->axes[a++].size) {
        const size_t n = table->axes[a].size, i = index / stride % n;
        if (a == axis) continue;
        if (i > 0) most = fmax(most, departure_at(table, channel, index - stride, axis));
        if (i + 1 < n) most = fmax(most, departure_at(table, channel, index + stride, axis));
    }
    return most;
}

/* The same relative to what is beside, along the axis that tells most: where values are rough along one, they
 * are smooth along another. `floor` is a departure that means nothing. */
static double stands_alone(const lq_table *table, int channel, size_t index, double floor) {
    double most = 0.0;
    for (int a = 0; a < table->axis_count; a++) {
        const double out = table->axes[a].size >= 5 ? departure_at(table, channel, index, a) : 0.0;
        if (out > most * floor) most = fmax(most, out / (floor + beside(table, channel, index, a)));
    }
    return most;
}

/* Insert where it belongs among the `count` largest. */
static void keep(lq_suspect *list, size_t count, lq_suspect e) {
    if (!(e.score > list[count - 1].score)) return;
    size_t at = count - 1;
    for (; at > 0 && list[at - 1].score < e.score; at--) list[at] = list[at - 1];
    list[at] = e;
}

void lq_suspects_find(const lq_table *table, double tolerance, lq_suspect list[LQ_SUSPECTS]) {
    const size_t entries = lq_table_entries(table);
    memset(list, 0, LQ_SUSPECTS * sizeof *list);
    for (int c = 0; c < table->channel_count; c++)
        for (size_t i = 0; i < entries; i++) {
            const double out = sticks_out(table, c, i);
            if (!(out > tolerance)) continue;
            keep(list, LQ_LISTED, (lq_suspect){i, c, out});
            keep(list + LQ_LISTED, LQ_LISTED, (lq_suspect){i, c, stands_alone(table, c, i, tolerance)});
        }
}
