/* table.c - N-dimensional float tables in memory: creation, facts, interpolation. */
#define _POSIX_C_SOURCE 200809L /* sysconf */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "system/status.h"
#include "tables/axis.h"
#include "tables/facts.h"
#include "tables/rows.h"

/* 2^33 floats, 32 GiB a channel: eight times the largest table anyone has asked for, and far below where
 * any product of sizes overflows. */
#define MAX_ENTRIES ((size_t)1 << 33)

/* ------------------------------------------------------------------ creation */

static size_t physical_memory(void) {
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || size <= 0) return SIZE_MAX;
    return (size_t)pages * (size_t)size;
}

static lq_status check_counts(int axis_count, int channel_count, lq_error *error) {
    if (axis_count < 1 || axis_count > LQ_MAX_AXES)
        return lq_fail(error, LQ_BAD_INPUT, "a table of %d axes; accepted are 1 to %d", axis_count,
                       LQ_MAX_AXES);
    if (channel_count < 1 || channel_count > LQ_MAX_CHANNELS)
        return lq_fail(error, LQ_BAD_INPUT, "a table of %d channels; accepted are 1 to %d", channel_count,
                       LQ_MAX_CHANNELS);
    return LQ_OK;
}

static lq_status check_axes(const lq_axis *axes, int count, lq_error *error) {
    for (int i = 0; i < count; i++) {
        lq_status status = lq_name_check("axis", axes[i].name, error);
        if (status) return status;
        if (!axes[i].nodes || axes[i].size < 1 || axes[i].size > LQ_MAX_AXIS_SIZE)
            return lq_fail(error, LQ_BAD_INPUT, "axis '%s' of %zu nodes; accepted are 1 to %d", axes[i].name,
                           axes[i].nodes ? axes[i].size : 0, LQ_MAX_AXIS_SIZE);
        for (int j = 0; j < i; j++)
            if (strcmp(axes[i].name, axes[j].name) == 0)
                return lq_fail(error, LQ_BAD_INPUT, "two axes called '%s'; accepted are different names",
                               axes[i].name);
    }
    return LQ_OK;
}

static lq_status check_channels(const char *const *names, int count, lq_error *error) {
    for (int i = 0; i < count; i++) {
        lq_status status = lq_name_check("channel", names[i], error);
        if (status) return status;
        for (int j = 0; j < i; j++)
            if (strcmp(names[i], names[j]) == 0)
                return lq_fail(error, LQ_BAD_INPUT, "two channels called '%s'; accepted are different names",
                               names[i]);
    }
    return LQ_OK;
}

/* Entries of all channels together; sizes are at most 2^20 each, so that the product of two fits, and it
 * is checked before a third comes in. */
static lq_status check_entries(const lq_axis *axes, int axis_count, int channel_count, size_t memory,
                               lq_error *error) {
    size_t limit = memory / sizeof(float);
    if (limit > MAX_ENTRIES) limit = MAX_ENTRIES;
    double asked = channel_count;
    for (int i = 0; i < axis_count; i++) asked *= (double)axes[i].size;
    if (asked <= (double)limit) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT,
                   "a table of %.0f entries (%.1f GiB); accepted are at most %zu (%.1f GiB) on this machine",
                   asked, asked * sizeof(float) / 0x1p30, limit, (double)limit * sizeof(float) / 0x1p30);
}

static lq_status copy_shape(lq_table *table, const lq_axis *axes, int axis_count,
                            const char *const *channel_names, int channel_count, lq_error *error) {
    for (int i = 0; i < axis_count; i++) {
        lq_status status = lq_axis_copy(&table->axes[i], &axes[i], error);
        if (status) return status;
        table->axis_count++;
    }
    for (int i = 0; i < channel_count; i++)
        memcpy(table->channel_names[i], channel_names[i], strlen(channel_names[i]) + 1);
    table->channel_count = channel_count;
    return LQ_OK;
}

static lq_status allocate(lq_table *table, lq_error *error) {
    size_t entries = lq_table_entries(table);
    for (int i = 0; i < table->channel_count; i++) {
        table->channels[i] = calloc(entries, sizeof(float));
        if (!table->channels[i])
            return lq_fail(error, LQ_NO_MEMORY, "no memory for a table of %zu entries (%.1f MiB a channel)",
                           entries, (double)entries * sizeof(float) / 0x1p20);
    }
    return LQ_OK;
}

static lq_status describe(lq_table **table, const lq_axis *axes, int axis_count,
                          const char *const *channel_names, int channel_count, size_t memory,
                          lq_error *error) {
    *table = NULL;
    lq_status status = check_counts(axis_count, channel_count, error);
    if (status == LQ_OK) status = check_axes(axes, axis_count, error);
    if (status == LQ_OK) status = check_channels(channel_names, channel_count, error);
    if (status == LQ_OK) status = check_entries(axes, axis_count, channel_count, memory, error);
    if (status) return status;
    lq_table *made = calloc(1, sizeof *made);
    if (!made) return lq_fail(error, LQ_NO_MEMORY, "no memory for a table");
    status = copy_shape(made, axes, axis_count, channel_names, channel_count, error);
    if (status) lq_table_free(made);
    else *table = made;
    return status;
}

lq_status lq_table_describe(lq_table **table, const lq_axis *axes, int axis_count,
                            const char *const *channel_names, int channel_count, lq_error *error) {
    return describe(table, axes, axis_count, channel_names, channel_count, SIZE_MAX, error);
}

lq_status lq_table_create(lq_table **table, const lq_axis *axes, int axis_count,
                          const char *const *channel_names, int channel_count, lq_error *error) {
    lq_status status =
        describe(table, axes, axis_count, channel_names, channel_count, physical_memory(), error);
    if (status == LQ_OK) status = allocate(*table, error);
    if (status == LQ_OK) return LQ_OK;
    lq_table_free(*table);
    *table = NULL;
    return status;
}

void lq_table_free(lq_table *table) {
    if (!table) return;
    for (int i = 0; i < table->axis_count; i++) lq_axis_free(&table->axes[i]);
    for (int i = 0; i < table->channel_count; i++) free(table->channels[i]);
    lq_facts_free(table->facts, table->fact_count);
    free(table);
}

size_t lq_table_entries(const lq_table *table) {
    size_t entries = 1;
    for (int i = 0; i < table->axis_count; i++) entries *= table->axes[i].size;
    return entries;
}

int lq_table_axis(const lq_table *table, const char *name) {
    for (int i = 0; i < table->axis_count; i++)
        if (strcmp(table->axes[i].name, name) == 0) return i;
    return -1;
}

/* ------------------------------------------------------------------ facts */

const char *lq_table_fact(const lq_table *table, const char *key) {
    return lq_facts_find(table->facts, table->fact_count, key);
}

lq_status lq_table_set_fact(lq_table *table, const char *key, const char *value, lq_error *error) {
    return lq_facts_set(&table->facts, &table->fact_count, key, value, error);
}

/* ------------------------------------------------------------------ interpolation */

double lq_table_lookup(const lq_table *table, int channel, const double *point) {
    size_t base = 0, stride = 1, step[LQ_MAX_AXES];
    double fraction[LQ_MAX_AXES];
    for (int i = 0; i < table->axis_count; i++) {
        double index = lq_axis_locate(&table->axes[i], point[i]);
        size_t cell = (size_t)index;
        fraction[i] = index - (double)cell;
        base += cell * stride;
        step[i] = stride;
        stride *= table->axes[i].size;
    }
    double sum = 0;
    for (unsigned corner = 0; corner < 1u << table->axis_count; corner++) {
        double weight = 1;
        size_t offset = base;
        for (int i = 0; i < table->axis_count; i++) {
            bool upper = corner >> i & 1;
            weight *= upper ? fraction[i] : 1 - fraction[i];
            if (upper) offset += step[i];
        }
        if (weight != 0) /* corners past the last node have weight 0 and must not be read */
            sum += weight * (double)table->channels[channel][offset];
    }
    return sum;
}
