/* cache.h - tables computed before, under a name made of all that determines them. */
#ifndef LACQUER_PACK_CACHE_H
#define LACQUER_PACK_CACHE_H

#include "lacquer.h"

/* Whether the entries of `folder` are safe from other users: it is absent, the user's own, or sticky. LQ_IO
 * names it. */
lq_status lq_cache_check(const char *folder, lq_error *error);

/* Remove what runs that were killed left in it, and no run at work uses: once, before a run. */
void lq_cache_clear(const char *folder);

/* The table stored for `key`, or NULL. A file that is a link, not a file of the user's own, damaged, of
 * another key or over other axes than these is no table. */
lq_table *lq_cache_find(const char *folder, const char *key, const lq_axis *axes, int axis_count);

/* Store it; it gets the facts "cache-key" and "cache-sum". Two runs may do so at once: each file appears
 * whole, and both write the same. The folder is made where it is missing. LQ_IO: it cannot be written. */
lq_status lq_cache_store(const char *folder, const char *key, lq_table *table, lq_error *error);

/* The same for factors, of a table between the ends of these axes. */
lq_factored *lq_cache_find_factored(const char *folder, const char *key, const lq_axis *axes, int axis_count);
lq_status lq_cache_store_factored(const char *folder, const char *key, lq_factored *factored,
                                  lq_error *error);

/* What the numbers depend on and no option names: a hash of the program that computes them. */
const char *lq_cache_build(char *text, size_t size);

#endif
