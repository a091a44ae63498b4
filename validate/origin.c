/* Rebuilds kind and settings from the facts of a table, refusing what it does not understand. */
#include "validate/origin.h"

#include "tables/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Puts the index of a fact's value among two choices into `choice`. */
static lq_status read_choice(const lq_table *table, const char *key, const char *first, const char *second,
                             int *choice, lq_error *error) {
    const char *value = lq_table_fact(table, key);
    if (!value) return lq_fail(error, LQ_FORMAT, "the table does not say its %s", key);
    if (strcmp(value, first) != 0 && strcmp(value, second) != 0)
        return lq_fail(error, LQ_FORMAT, "unknown %s '%s' in the table; known: %s, %s", key, value, first,
                       second);
    *choice = strcmp(value, second) == 0;
    return LQ_OK;
}

static lq_status read_tolerance(const lq_table *table, double *tolerance, lq_error *error) {
    const char *text = lq_table_fact(table, "tolerance");
    if (!text) return lq_fail(error, LQ_FORMAT, "the table does not say its tolerance");
    char *end;
    *tolerance = strtod(text, &end);
    if (end == text || *end || !(*tolerance > 0.0 && *tolerance <= 1.0))
        return lq_fail(error, LQ_FORMAT, "tolerance '%s' in the table is not a number in (0, 1]", text);
    return LQ_OK;
}

static lq_status check_shape(const lq_table *table, const lq_kind *kind, lq_error *error) {
    if (table->axis_count != kind->axis_count || table->channel_count != kind->channel_count)
        return lq_fail(error, LQ_FORMAT, "%d axes and %d channels, but table '%s' has %d and %d",
                       table->axis_count, table->channel_count, kind->id, kind->axis_count,
                       kind->channel_count);
    for (int i = 0; i < kind->axis_count; i++)
        if (strcmp(table->axes[i].name, kind->axes[i].name) != 0)
            return lq_fail(error, LQ_FORMAT, "axis %d is '%s', but '%s' in table '%s'", i + 1,
                           table->axes[i].name, kind->axes[i].name, kind->id);
    for (int i = 0; i < kind->channel_count; i++)
        if (strcmp(table->channel_names[i], kind->channels[i]) != 0)
            return lq_fail(error, LQ_FORMAT, "channel %d is '%s', but '%s' in table '%s'", i + 1,
                           table->channel_names[i], kind->channels[i], kind->id);
    return LQ_OK;
}

static lq_status read_settings(const lq_table *table, const lq_kind *kind, lq_settings *settings,
                               lq_error *error) {
    *settings = lq_settings_default();
    settings->ndf = lq_table_fact(table, "ndf");
    if (!settings->ndf) return lq_fail(error, LQ_FORMAT, "the table does not say its ndf");
    lq_status status = read_tolerance(table, &settings->tolerance, error);
    int choice = 0;
    if (status == LQ_OK && (kind->takes & LQ_TAKES_SCATTERING)) {
        status = read_choice(table, "scattering", "single", "multiple", &choice, error);
        settings->scattering = choice ? LQ_MULTIPLE : LQ_SINGLE;
    }
    if (status == LQ_OK && (kind->takes & LQ_TAKES_MASKING)) {
        status = read_choice(table, "masking", "correlated", "separable", &choice, error);
        settings->masking = choice ? LQ_SEPARABLE : LQ_CORRELATED;
    }
    return status;
}

lq_status lq_origin_of(const lq_table *table, lq_origin *origin, lq_error *error) {
    const char *id = lq_table_fact(table, "table");
    if (!id) return lq_fail(error, LQ_FORMAT, "the table does not say of which kind it is");
    origin->kind = lq_kind_find(id, error);
    if (!origin->kind) return LQ_FORMAT;
    const lq_status status = check_shape(table, origin->kind, error);
    return status == LQ_OK ? read_settings(table, origin->kind, &origin->settings, error) : status;
}

/* Masking is a matter of single scattering: the walk of all orders has none of its own. */
void lq_origin_describe(const lq_kind *kind, const lq_settings *settings, char *text, size_t size) {
    const bool multiple = (kind->takes & LQ_TAKES_SCATTERING) && settings->scattering == LQ_MULTIPLE;
    const char *scattering = multiple                            ? ", multiple scattering"
                             : kind->takes & LQ_TAKES_SCATTERING ? ", single scattering"
                                                                 : "";
    const char *masking = multiple || !(kind->takes & LQ_TAKES_MASKING) ? ""
                          : settings->masking == LQ_SEPARABLE           ? ", separable masking"
                                                                        : ", correlated masking";
    snprintf(text, size, "%s, %s%s%s", kind->id, settings->ndf, scattering, masking);
}
