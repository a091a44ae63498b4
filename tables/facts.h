/* facts.h - lists of facts, of whatever carries its provenance with it. */
#ifndef LACQUER_TABLES_FACTS_H
#define LACQUER_TABLES_FACTS_H

#include "lacquer.h"

/* NULL where there is none. */
const char *lq_facts_find(const lq_fact *facts, size_t count, const char *key);
/* Set or replace; texts are copied. */
lq_status lq_facts_set(lq_fact **facts, size_t *count, const char *key, const char *value, lq_error *error);
void lq_facts_free(lq_fact *facts, size_t count);

#endif
