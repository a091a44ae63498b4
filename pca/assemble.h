/* assemble.h - bases of any scheme into the half-float textures of a piece. */
#ifndef LACQUER_PCA_ASSEMBLE_H
#define LACQUER_PCA_ASSEMBLE_H

#include "pca/refine.h"
#include "pca/unfold.h"

/* The parts of a fit rounded to half, the plane's fitted again to what the rest was rounded to. */
lq_status lq_assemble_fit(lq_fit *fit, const lq_grid *grid, lq_piece *piece, lq_error *error);

/* Bases of the sequential scheme as it finds them: texels of each factor, and the terms over them. */
typedef struct lq_chain {
    size_t levels;                  /* of separation; the plane is one more */
    size_t texels[LQ_MAX_AXES + 1]; /* of a base at each */
    size_t bases[LQ_MAX_AXES + 1];
    double *data[LQ_MAX_AXES + 1]; /* data[level][base * texels + i] */
} lq_chain;

lq_status lq_assemble_chain(const lq_chain *chain, const lq_grid *grid, const lq_pca_options *options,
                            lq_piece *piece, lq_error *error);

#endif
