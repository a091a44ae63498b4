/* What made a stored table: its kind and settings, rebuilt from its facts. */
#ifndef LACQUER_TABLES_ORIGIN_H
#define LACQUER_TABLES_ORIGIN_H

#include "lacquer.h"

typedef struct lq_origin {
    const lq_kind *kind;
    lq_settings settings; /* its ndf, which may be opened, points into the facts or the trust */
} lq_origin;

/* The one place where a recorded NDF becomes one to open: LQ_BAD_INPUT where lq_ndf_trusted refuses it (trust
 * NULL: every file). LQ_FORMAT where a fact is missing or unknown, or axes and channels are not those of the
 * kind. */
lq_status lq_origin_of(const lq_table *table, const lq_trust *trust, lq_origin *origin, lq_error *error);

/* The same from the facts alone, whatever they are attached to. */
lq_status lq_origin_of_facts(const lq_fact *facts, size_t count, const lq_trust *trust, lq_origin *origin,
                             lq_error *error);

/* "fgd, ggx, multiple scattering": what determines the numbers, on one line. */
void lq_origin_describe(const lq_kind *kind, const lq_settings *settings, char *text, size_t size);

#endif
