/* facts.c - lists of facts: key and value, in the order they were set. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "tables/facts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/number.h"
#include "system/status.h"
#include "tables/axis.h"

const char *lq_facts_find(const lq_fact *facts, size_t count, const char *key) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(facts[i].key, key) == 0) return facts[i].value;
    return NULL;
}

/* Takes over `key` and `value` when it succeeds. */
static bool append(lq_fact **facts, size_t *count, char *key, char *value) {
    lq_fact *longer = realloc(*facts, (*count + 1) * sizeof *longer);
    if (!longer) return false;
    *facts = longer;
    longer[(*count)++] = (lq_fact){key, value};
    return true;
}

lq_status lq_facts_set(lq_fact **facts, size_t *count, const char *key, const char *value, lq_error *error) {
    lq_status status = lq_name_check("fact", key, error);
    if (status) return status;
    if (!value) return lq_fail(error, LQ_BAD_INPUT, "fact '%s' without a value; accepted is any text", key);
    char *new_value = strdup(value);
    for (size_t i = 0; new_value && i < *count; i++) {
        if (strcmp((*facts)[i].key, key) != 0) continue;
        free((*facts)[i].value);
        (*facts)[i].value = new_value;
        return LQ_OK;
    }
    if (new_value && *count == LQ_MAX_FACTS) {
        free(new_value);
        return lq_fail(error, LQ_BAD_INPUT, "fact '%s' is one too many; accepted are %d", key, LQ_MAX_FACTS);
    }
    char *new_key = new_value ? strdup(key) : NULL;
    if (new_key && append(facts, count, new_key, new_value)) return LQ_OK;
    free(new_key);
    free(new_value);
    return lq_fail(error, LQ_NO_MEMORY, "no memory for fact '%s'", key);
}

void lq_facts_free(lq_fact *facts, size_t count) {
    for (size_t i = 0; i < count; i++) {
        free(facts[i].key);
        free(facts[i].value);
    }
    free(facts);
}

lq_status lq_table_set_number(lq_table *table, const char *key, double value, lq_error *error) {
    char text[32];
    lq_print(text, sizeof text, "%.3g", value);
    return lq_facts_set(&table->facts, &table->fact_count, key, text, error);
}

lq_status lq_table_set_bound(lq_table *table, const char *key, double value, lq_error *error) {
    const double unit = value > 0.0 ? pow(10.0, floor(log10(value)) - 2.0) : 1.0;
    return lq_table_set_number(table, key, ceil(value / unit * (1.0 - 1e-12)) * unit, error);
}
