/* slice_cells.h - the cells of a slice: where light that leaves is counted, 90 x 360 to a side (Ba19
 * sec. 4.1).
 *
 *     classic  theta_o and phi_o of the direction light leaves in, one degree each; phi_o = 0 is away from
 *              the light, so that a mirror's peak lies at (theta_i, 0)
 *     half     theta_h and phi_h of the half vector of that direction and the one to the light; a mirror's
 *              peak lies at theta_h = 0. Transmitted light is mirrored at the surface first, so that light
 *              which goes straight through a slab lies there too.
 *
 * The value of a cell is its flux over the solid angle of outgoing directions that the cell stands for: the
 * mean of f cos theta_o. d omega_o = 4 (omega_i . h) d omega_h; of a cell of half vectors that lead below the
 * horizon, no light comes back there and the solid angle still counts.
 */
#ifndef LACQUER_VALIDATE_SLICE_CELLS_H
#define LACQUER_VALIDATE_SLICE_CELLS_H

#include <stddef.h>

typedef enum lq_slice_layout { LQ_SLICE_CLASSIC, LQ_SLICE_HALF, LQ_SLICE_LAYOUTS } lq_slice_layout;
extern const char *const lq_slice_layout_names[LQ_SLICE_LAYOUTS];

enum {
    LQ_SLICE_THETA = 90,
    LQ_SLICE_PHI = 360,
    LQ_SLICE_CELLS = LQ_SLICE_THETA * LQ_SLICE_PHI, /* cell theta * LQ_SLICE_PHI + phi */
    LQ_SLICE_SUB = 5                                /* sub-cells each way that a function is averaged over */
};

/* The cell of a direction above the surface, (x, y, z) with z >= 0 and the light travelling to +x at cosine
 * mu. */
size_t lq_slice_cell(lq_slice_layout layout, double mu, double x, double y, double z);

/* The middles of a cell's sub-cells as directions light leaves in, and the solid angle of such directions;
 * z <= 0: none does, they are below the horizon (the solid angle counts all the same). */
enum { LQ_SLICE_POINTS = LQ_SLICE_SUB * LQ_SLICE_SUB };
typedef struct lq_slice_point {
    double x, y, z, solid;
} lq_slice_point;
void lq_slice_points(lq_slice_layout layout, double mu, size_t cell, lq_slice_point points[LQ_SLICE_POINTS]);

/* Of each cell. */
void lq_slice_solids(lq_slice_layout layout, double mu, double *solid);

#endif
