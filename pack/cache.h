/* cache.h - tables computed before, under a name made of all that determines them. */
#ifndef LACQUER_PACK_CACHE_H
#define LACQUER_PACK_CACHE_H

#include "lacquer.h"

/* The folder to use when none is named: lacquer in XDG_CACHE_HOME or ~/.cache. False: neither is set. */
bool lq_cache_default(char *folder, size_t size);

/* The table stored for `key`, or NULL. A file that is damaged or belongs to another key is no table. */
lq_table *lq_cache_find(const char *folder, const char *key);

/* Store it; it gets the fact "cache-key". Two runs may do so at once: each file appears whole, and both write
 * the same. The folder is made where it is missing. */
lq_status lq_cache_store(const char *folder, const char *key, lq_table *table, lq_error *error);

/* The same for factors. */
lq_factored *lq_cache_find_factored(const char *folder, const char *key);
lq_status lq_cache_store_factored(const char *folder, const char *key, lq_factored *factored,
                                  lq_error *error);

/* What the numbers depend on and no option names: a hash of the program that computes them. */
const char *lq_cache_build(char *text, size_t size);

#endif
