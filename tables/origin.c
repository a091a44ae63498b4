/* Rebuilds kind and settings from the facts of a table, refusing what it does not understand. */
#include "tables/origin.h"

#include "system/number.h"
#include "system/status.h"
#include "tables/facts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The facts of a file. */
typedef struct facts {
    const lq_fact *list;
    size_t count;
} facts;

static const char *fact(const facts *from, const char *key) {
    return lq_facts_find(from->list, from->count, key);
}

/* Puts the index of a fact's value among two choices into `choice`. */
static lq_status read_choice(const facts *from, const char *key, const char *first, const char *second,
                             int *choice, lq_error *error) {
    const char *value = fact(from, key);
    if (!value) return lq_fail(error, LQ_FORMAT, "the table does not say its %s", key);
    if (strcmp(value, first) != 0 && strcmp(value, second) != 0)
        return lq_fail(error, LQ_FORMAT, "unknown %s '%s' in the table; known: %s, %s", key, value, first,
                       second);
    *choice = strcmp(value, second) == 0;
    return LQ_OK;
}

static lq_status read_tolerance(const facts *from, double *tolerance, lq_error *error) {
    const char *text = fact(from, "tolerance");
    if (!text) return lq_fail(error, LQ_FORMAT, "the table does not say its tolerance");
    char *end;
    *tolerance = lq_strtod(text, &end);
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

static lq_status read_settings(const facts *from, const lq_kind *kind, const lq_trust *trust,
                               lq_settings *settings, lq_error *error) {
    *settings = lq_settings_default();
    const char *ndf = fact(from, "ndf");
    if (!ndf) return lq_fail(error, LQ_FORMAT, "the table does not say its ndf");
    lq_status status = lq_ndf_trusted(ndf, trust, &settings->ndf, error);
    if (status == LQ_OK) status = read_tolerance(from, &settings->tolerance, error);
    int choice = 0;
    if (status == LQ_OK && (kind->takes & LQ_TAKES_SCATTERING)) {
        status = read_choice(from, "scattering", "single", "multiple", &choice, error);
        settings->scattering = choice ? LQ_MULTIPLE : LQ_SINGLE;
    }
    if (status == LQ_OK && (kind->takes & LQ_TAKES_MASKING)) {
        status = read_choice(from, "masking", "correlated", "separable", &choice, error);
        settings->masking = choice ? LQ_SEPARABLE : LQ_CORRELATED;
    }
    return status;
}

lq_status lq_origin_of_facts(const lq_fact *list, size_t count, const lq_trust *trust, lq_origin *origin,
                             lq_error *error) {
    const facts from = {list, count};
    const char *id = fact(&from, "table");
    if (!id) return lq_fail(error, LQ_FORMAT, "the table does not say of which kind it is");
    if (strcmp(id, "stack") == 0) /* the layers say how it was made, not the facts read here */
        return lq_fail(error, LQ_FORMAT, "it is a table of a stack, not of one of the kinds of lacquer list");
    origin->kind = lq_kind_find(id, error);
    return origin->kind ? read_settings(&from, origin->kind, trust, &origin->settings, error) : LQ_FORMAT;
}

lq_status lq_origin_of(const lq_table *table, const lq_trust *trust, lq_origin *origin, lq_error *error) {
    const lq_status status = lq_origin_of_facts(table->facts, table->fact_count, trust, origin, error);
    return status == LQ_OK ? check_shape(table, origin->kind, error) : status;
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

lq_status lq_table_settings(const lq_table *table, const lq_trust *trust, const lq_kind **kind,
                            lq_settings *settings, lq_error *error) {
    lq_origin origin;
    const lq_trust none = {0};
    const lq_status status = lq_origin_of(table, trust ? trust : &none, &origin, error);
    if (status != LQ_OK) return status;
    *kind = origin.kind;
    *settings = origin.settings;
    return LQ_OK;
}
