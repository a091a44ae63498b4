/* general_source.h - materials that are textured in everything, put together from the tables of a pack.
 *
 * A function is there where the pack has all tables that it needs, over all of their axes and for GGX. Where
 * several will do, the first is taken.
 */
#ifndef LACQUER_PACK_GENERAL_SOURCE_H
#define LACQUER_PACK_GENERAL_SOURCE_H

#include "pack/atlas_source.h"

/* NULL: the pack has none. */
typedef struct lq_general {
    const lq_atlas_table *albedo;     /* of a single bounce, which lobes are normalised by */
    const lq_atlas_table *conductor;  /* FGD of metals */
    const lq_atlas_table *dielectric; /* R01 of eta > 1 */
    const lq_atlas_table *inside;     /* R01 of eta < 1 */
    const lq_atlas_table *pass;       /* TIR, for eta < 1 */
    const lq_atlas_table *f, *inverse;
    const lq_atlas_table *enters, *leaves, *returns; /* T01, T10 and R10 of D22 */
    const lq_atlas_table *variance;
} lq_general;

lq_general lq_general_find(const lq_atlas_contents *contents);

bool lq_general_has_conductor(const lq_general *general);
bool lq_general_has_coated_lambertian(const lq_general *general);
bool lq_general_has_layered(const lq_general *general);
static inline bool lq_general_any(const lq_general *general) {
    return lq_general_has_conductor(general) || lq_general_has_coated_lambertian(general) ||
           lq_general_has_layered(general);
}

/* After the functions of tables and the struct of lobes. */
void lq_say_general(FILE *out, lq_language language, const lq_general *general);

#endif
