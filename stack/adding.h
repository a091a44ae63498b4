/* adding.h - adding layers on four energies and four variances: the statistical model of B18, sec. 5.1.
 *
 * Of everything above an interface, seen from outside (down) and from the medium over that interface (up),
 * the model knows how much it reflects and lets through and how far either is spread, by linear variances f
 * (model_mapping.h). One interface is added at a time: energies by eq. 28-31, variances by eq. 38 and 47-51.
 */
#ifndef LACQUER_STACK_ADDING_H
#define LACQUER_STACK_ADDING_H

typedef struct lq_flow {
    double energy, variance;
} lq_flow;

/* One interface: 1 above, 2 below. */
typedef struct lq_model_interface {
    lq_flow r12, t12, r21, t21;
    double j12, j21; /* Jacobians of refraction between projected discs: eta cos_t / cos_i, and its inverse */
} lq_model_interface;

/* All layers so far: 0 outside, i the lowest medium. */
typedef struct lq_model_sum {
    lq_flow r0i, t0i, ri0, ti0;
    double j0i, ji0; /* products over the interfaces */
} lq_model_sum;

lq_model_sum lq_model_nothing(void);

/* Totally reflected light (eq. 34-35): of what the layers let out, the base's lobe passes the share `pass`.
 */
void lq_model_reflect_back(lq_model_sum *sum, double pass);

/* A medium below all: what a crossing leaves, and how far it spreads it (eq. 15-24). */
void lq_model_cross(lq_model_sum *sum, lq_flow crossing);

/* One more interface; the lobe that it adds to what comes back. */
lq_flow lq_model_add(lq_model_sum *sum, const lq_model_interface *interface);

#endif
