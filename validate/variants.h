/* Which definition does a table follow? The known other ones are computed on a part of its nodes and
 * compared. */
#ifndef LACQUER_VALIDATE_VARIANTS_H
#define LACQUER_VALIDATE_VARIANTS_H

#include "lacquer.h"

enum { LQ_MAX_VARIANTS = 40 };

typedef struct lq_variant {
    char what[112]; /* "separable masking"; "as stated" */
    double rms; /* of the best 95 % of the entries compared, so that a few wrong ones do not hide the rest */
} lq_variant;

typedef struct lq_variants {
    size_t count;
    lq_variant list[LQ_MAX_VARIANTS]; /* the closest first */
    double stated;                    /* rms of what the table is said to be */
    size_t entries;                   /* compared, all channels */
    bool other;                       /* the closest is not that, and at most half as far away */
} lq_variants;

/* `table` is said to be `kind` made with `settings`. Tried are: other scattering and masking, other NDFs,
 * alpha for its square or root, an axis the other way round, mu linear in angle, 1/eta, 1 - x, radiance for
 * flux (eta^2), the other one of the two TIR conventions, channels swapped. */
lq_status lq_variants_try(const lq_table *table, const lq_kind *kind, const lq_settings *settings,
                          const lq_progress *progress, lq_variants *variants, lq_error *error);

#endif
