/* lobes_measure.h - how far the texels of materials are from the exact stack, off their grids.
 */
#ifndef LACQUER_PACK_LOBES_MEASURE_H
#define LACQUER_PACK_LOBES_MEASURE_H

#include "pack/lobes.h"

typedef struct lq_lobes_measure {
    size_t points;               /* cosines times sets of parameters */
    double rms, p99, max;        /* over points and what lq_lobes_compare finds of each */
    double worst[LQ_LOBES_AXES]; /* the point of max: mu and the ranges */
} lq_lobes_measure;

/* As a GPU decodes them, at `sets` sets of parameters that follow no grid, 48 cosines from LQ_MATERIAL_FROM
 * up each (one set where nothing is open). `level` as in lq_material_solve: of a finer one than they were
 * made from, or < 0 for exact ones to `tolerance`. Energies count as they are, a roughness by how much light
 * has it. */
lq_status lq_lobes_measure_all(const lq_lobes *lobes, size_t count, size_t sets, int level, double tolerance,
                               int threads, const lq_progress *progress, lq_lobes_measure *measures,
                               lq_error *error);

#endif
