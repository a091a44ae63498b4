/* weidlich.h - layers seen through smooth ones: the second family of layered models.
 *
 * Weidlich & Wilkie 2007 (WW07) follow one ray down to each interface and one up again, and add the BRDFs
 * that they find there, each F D G2 / (4 mu_i mu_o):
 *
 *     f = f_1(i, o) + T12 f_2(i', o') a t,    a = tau^(1/mu_i' + 1/mu_o'),    t = (1 - G) + T21 G
 *
 * with i' and o' refracted through the facet that reflects, whose normal is the half vector, and G of the
 * upper interface. Light is squeezed as it enters and spreads as it leaves; the model forgets that, and so
 * makes up to eta^2 times too much of it. Corrected, with i' and o' refracted through the surface:
 *
 *     f = f_1(i, o) + T(mu_i) T(mu_o) / eta^2 f_2(i', o') a
 *
 * which is exact for one bounce off any base under a smooth interface. More layers are f_2 in turn.
 */
#ifndef LACQUER_STACK_WEIDLICH_H
#define LACQUER_STACK_WEIDLICH_H

#include "stack/shape_lobe.h"

typedef struct lq_weidlich {
    const lq_stack *stack;
    bool corrected;
    double least_alpha;
} lq_weidlich;

/* LQ_BAD_INPUT: a stack that lets light through, for transmitted light is not modelled. */
lq_status lq_weidlich_check(const lq_stack *stack, lq_error *error);

/* Flux a solid angle that layer k sends into (x, y, z), z > 0. */
double lq_weidlich_value(const lq_weidlich *model, int channel, size_t k, lq_incidence from, double x,
                         double y, double z);

#endif
