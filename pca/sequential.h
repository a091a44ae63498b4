/* sequential.h - the plain scheme of D22 sec. 4. */
#ifndef LACQUER_PCA_SEQUENTIAL_H
#define LACQUER_PCA_SEQUENTIAL_H

#include "pca/assemble.h"

/* Separate what `options` says from the samples of a grid whose rest is in that order. Free with
 * lq_chain_free. */
lq_status lq_sequential(const float *samples, const lq_grid *grid, const lq_pca_options *options,
                        lq_chain *chain, lq_error *error);
void lq_chain_free(lq_chain *chain);

#endif
