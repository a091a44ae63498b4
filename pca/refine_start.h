/* refine_start.h - a fit before its first sweep. */
#ifndef LACQUER_PCA_REFINE_START_H
#define LACQUER_PCA_REFINE_START_H

#include "pca/stream.h"

/* Allocate p and q of the streams, whose bases, columns and pairs are set. */
lq_status lq_fit_create(lq_fit *fit, lq_error *error);
void lq_fit_free(lq_fit *fit);

/* Singular vectors of the transformed samples. */
lq_status lq_fit_start(lq_fit *fit, lq_error *error);

#endif
