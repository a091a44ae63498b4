/* lobes_measure.h - how far the texels of materials are from the exact stack, off their grids.
 */
#ifndef LACQUER_PACK_LOBES_MEASURE_H
#define LACQUER_PACK_LOBES_MEASURE_H

#include "pack/lobes.h"

enum { LQ_EXACT_COSINES = 48 };

/* Materials solved at `sets` sets of their parameters that follow no grid (one where nothing is open), at 48
 * cosines from LQ_MATERIAL_FROM up each. */
typedef struct lq_lobes_exact {
    const lq_material *const *materials; /* which stay as long as this */
    size_t count, sets;
    double mu[LQ_EXACT_COSINES];
    double *numbers; /* [((material * sets + set) * cosines + m) * LQ_MATERIAL_NUMBERS + k] */
} lq_lobes_exact;

/* `level` as in lq_material_solve: of a finer one than lobes were made from, or < 0 for exact ones to
 * `tolerance`. Free it in any case. */
lq_status lq_lobes_exact_make(lq_lobes_exact *exact, const lq_material *const *materials, size_t count,
                              size_t sets, int level, double tolerance, int threads,
                              const lq_progress *progress, lq_error *error);
void lq_lobes_exact_free(lq_lobes_exact *exact);

typedef struct lq_lobes_measure {
    size_t points;               /* cosines times sets of parameters */
    double rms, p99, max;        /* over points and what lq_lobes_compare finds of each */
    double worst[LQ_LOBES_AXES]; /* the point of max: mu and the ranges */
} lq_lobes_measure;

/* Material `i` as a GPU decodes it. Energies count as they are, a roughness by how much light has it. */
lq_status lq_lobes_measure_one(const lq_lobes_exact *exact, size_t i, const lq_lobes *lobes,
                               lq_lobes_measure *measure, lq_error *error);

#endif
