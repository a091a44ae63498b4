/* facts.h - lists of facts, of whatever carries its provenance with it. */
#ifndef LACQUER_TABLES_FACTS_H
#define LACQUER_TABLES_FACTS_H

#include "lacquer.h"

/* NULL where there is none. */
const char *lq_facts_find(const lq_fact *facts, size_t count, const char *key);
/* Set or replace; texts are copied. */
lq_status lq_facts_set(lq_fact **facts, size_t *count, const char *key, const char *value, lq_error *error);
/* A number of a table, in three digits. */
lq_status lq_table_set_number(lq_table *table, const char *key, double value, lq_error *error);
/* Three digits, never below the value, for an error must not be rounded down, and no further above it than
 * the next of three digits: what kept a tolerance must not seem to break it. */
lq_status lq_table_set_bound(lq_table *table, const char *key, double value, lq_error *error);

/* Half a unit in the last place of values up to 1, in float32. */
#define LQ_STORAGE_ROUNDING 3e-8

void lq_facts_free(lq_fact *facts, size_t count);

#endif
