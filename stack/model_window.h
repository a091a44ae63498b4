/* model_window.h - baked-window: light that was inside, as GGX lobes inside the medium above the base.
 *
 * Light and view are refracted by the flat surface of a medium of index n, a lobe is GGX between the
 * refracted directions, and what leaves is weighted with the surface's transmittance T and the ratio of solid
 * angles:
 *
 *     f_s cos theta_o ~ T(mu_o) D(h') G2(i', o') / (4 mu_i') mu_o / (n^2 mu_o')
 *
 * One bounce off a base under a smooth interface has exactly that form (Weidlich and Wilkie 2007 with 1/n^2).
 * The way in and all else are in the energy. There are two such lobes, of light that met the top interface
 * twice (in and out) and of all that met it more often; each has the exact stack's energy and the roughness
 * that spreads as far across the plane of incidence, for each colour.
 *
 * The top's own lobe and transmitted light are as in baked. n is the index of the medium above the last
 * interface; where that is below 1, light and view are not refracted.
 */
#ifndef LACQUER_STACK_MODEL_WINDOW_H
#define LACQUER_STACK_MODEL_WINDOW_H

#include "stack/shape_lobe.h"

enum { LQ_WINDOW_PARTS = 2 };

typedef struct lq_window {
    double n;      /* 0: there is none */
    double energy; /* of all parts */
    struct {
        double energy, alpha;
        double scale; /* energy / that of the formula */
    } part[LQ_WINDOW_PARTS];
} lq_window;

typedef struct lq_windowed {
    double top, through, through_alpha; /* energies, and the roughness of what goes through */
    lq_window inner;
} lq_windowed;

/* made[channel], of light at cosine mu. Roughness is `least_alpha` at least. LQ_BAD_INPUT: what
 * lq_model_check refuses, for model baked-window. */
lq_status lq_model_windowed(const lq_stack *stack, double mu, double least_alpha, int threads,
                            lq_windowed *made, lq_error *error);

/* Flux a solid angle at an outgoing direction above the horizon, light arriving from `from` outside. */
double lq_window_value(const lq_window *window, lq_incidence from, double x, double y, double z);

/* Energy and moments of that. */
lq_stack_lobe lq_window_light(const lq_window *window, double mu);

#endif
