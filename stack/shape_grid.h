/* shape_grid.h - the lobes of a model over cosines of incidence, for models that take the angle to the half
 * vector, theta_d, for that of incidence (B18 sec. 6.2). */
#ifndef LACQUER_STACK_SHAPE_GRID_H
#define LACQUER_STACK_SHAPE_GRID_H

#include "stack/model.h"

typedef struct lq_grid_lobe {
    double energy, scale, alpha; /* scale: energy / albedo of the lobe */
} lq_grid_lobe;

/* Nodes lie evenly in the root of the cosine, closer towards the horizon. */
typedef struct lq_shape_grid {
    size_t nodes, width; /* width: lobes of all channels */
    lq_grid_lobe *lobes; /* [node * width + i] */
    double gap;          /* the largest change halfway between the nodes of before the last refinement */
} lq_shape_grid;

/* Of `query` without its cosines, lobes no sharper than least_alpha; `masked`: scale is the energy. Nodes are
 * doubled until halfway between them nothing is off by more than 5e-3, so that the last are right to
 * a quarter of it. Free the grid, also after a
 * failure. */
lq_status lq_shape_grid_make(lq_shape_grid *grid, const lq_stack *stack, const lq_model_query *query,
                             double least_alpha, bool masked, lq_error *error);
void lq_shape_grid_free(lq_shape_grid *grid);

lq_grid_lobe lq_shape_grid_at(const lq_shape_grid *grid, size_t lobe, double cosine);

#endif
