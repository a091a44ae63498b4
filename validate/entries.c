/* entries.c - finite and in range: one pass over all entries. */
#include "validate/entries.h"

#include <math.h>

double lq_out_of_range(const lq_kind *kind, double x) {
    /* A kind without an upper bound, such as f at its pole, may be infinite. */
    if (isnan(x) || x == -INFINITY) return INFINITY;
    if (isinf(x)) return isinf(kind->value_max) ? 0.0 : INFINITY;
    return fmax(fmax(kind->value_min - x, x - kind->value_max), 0.0);
}

void lq_entry_point(const lq_table *table, size_t index, double *at) {
    for (int a = 0; a < table->axis_count; a++) {
        const lq_axis *axis = &table->axes[a];
        at[a] = axis->nodes[index % axis->size];
        index /= axis->size;
    }
}

lq_entries lq_entries_look(const lq_table *table, const lq_kind *kind) {
    const size_t entries = lq_table_entries(table);
    lq_entries found = {.looked_at = entries * (size_t)table->channel_count};
    for (int c = 0; c < table->channel_count; c++)
        for (size_t i = 0; i < entries; i++) {
            const double value = (double)table->channels[c][i], out = lq_out_of_range(kind, value);
            found.faults += out > LQ_RANGE_SLACK;
            if (!(out > found.worst)) continue;
            found.worst = out;
            found.value = value;
            found.index = i;
            found.channel = c;
        }
    lq_entry_point(table, found.index, found.at);
    return found;
}
