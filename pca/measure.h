/* measure.h - what errors are measured against where nothing computes exact values. */
#ifndef LQ_PCA_MEASURE_H
#define LQ_PCA_MEASURE_H

#include "lacquer.h"

/* The nodes of a table inside a box, as a table. */
lq_status lq_nodes_within(const lq_table *table, const double *min, const double *max, lq_table **values,
                          lq_error *error);

#endif
