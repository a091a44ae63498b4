/* The cosines at which the solvers hold their unknowns, and interpolation between them.
 *
 * Nodes are Chebyshev points of x, which is logarithmic in the cosine down to alpha and linear below:
 * energies change over mu ~ alpha (shadowing) and over mu ~ 1 (Fresnel). Rising rays take twice the tangent
 * of half the elevation for the cosine, because what they hit near the zenith goes like theta, not theta^2.
 * Falling ones go like theta^3 there and like mu log mu at grazing: rooted, their axis has the half angle too
 * and, from grazing up, the root of what is logarithmic, in which both are smooth.
 * An axis can be divided at a cosine where the energy changes abruptly (a critical angle); each element has
 * its own points. The axis of a medium between interfaces has no roughness of its own: its elements run in
 * the root of the distance to their lower end, where refraction and roughness of any scale change fastest.
 */
#ifndef LACQUER_PRECOMPUTE_NODES_H
#define LACQUER_PRECOMPUTE_NODES_H

#include "precompute/kernels.h"

#include <stdbool.h>

typedef enum lq_sense { LQ_FALLING, LQ_RISING, LQ_FALLING_ROOTED } lq_sense;

enum { LQ_ELEMENTS_MAX = 12 };

typedef struct lq_node_axis {
    int count;                         /* of all nodes */
    int elements;                      /* at least 1 */
    int nodes;                         /* of one element */
    double bound[LQ_ELEMENTS_MAX + 1]; /* cosines */
    lq_cosine_map map[LQ_ELEMENTS_MAX];
    double mu[LQ_NODES_MAX]; /* the nodes, ascending */
    double *basis;           /* node values to Chebyshev coefficients, [m * nodes + i] */
} lq_node_axis;

/* `count` nodes (even where divided, at most LQ_NODES_MAX); `split` in (0,1), or 0 for one element. False
 * without memory; free it in either case. */
bool lq_node_axis_make(lq_node_axis *axis, double alpha, lq_sense sense, int count, double split);

/* The same, divided at `split_count` cosines, ascending in (0,1), fewer than LQ_ELEMENTS_MAX; `nodes` an
 * element. */
bool lq_node_axis_make_divided(lq_node_axis *axis, double alpha, lq_sense sense, const double *splits,
                               int split_count, int nodes);

/* An element of an axis in roots: from where the one below ends up to `to`, in the root of the distance to
 * its lower end, or to its upper one. */
typedef struct lq_root_element {
    double to;
    bool from_above;
} lq_root_element;

/* An axis in roots of at most LQ_ELEMENTS_MAX elements, the last one up to 1, and at most LQ_NODES_MAX nodes
 * in all, `nodes` an element. False without memory; free it in either case. */
bool lq_node_axis_make_roots(lq_node_axis *axis, const lq_root_element *elements, int count, int nodes);

void lq_node_axis_free(lq_node_axis *axis);

/* Add weighted cosines, running monotonically, to the Chebyshev moments of the axis, [element * nodes + m].
 * Returns the sum of their weights. */
double lq_node_axis_moments(const lq_node_axis *axis, const lq_solver_kernels *kernels, size_t count,
                            const double *cosine, const double *weight, double *moments);

/* The same of three weights of each cosine. */
void lq_node_axis_moments3(const lq_node_axis *axis, const lq_solver_kernels *kernels, size_t count,
                           const double *cosine, const double *const weight[3], double *const moments[3]);

/* From moments to weights on the nodes: sum_i weights[i] f(mu_i) stands for the weighted sum of f. */
void lq_node_axis_project(const lq_node_axis *axis, const double *moments, double *weights);

/* Interpolation weights at one cosine. */
void lq_node_axis_weights(const lq_node_axis *axis, double mu, double *weights);

/* The same of a function that is 0 at mu = 0. */
void lq_node_axis_weights_from_zero(const lq_node_axis *axis, double mu, double *weights);

/* Weights of the mean over cosine-weighted directions, 2 mu dmu, of an axis in roots; they add up to 1. */
void lq_node_axis_cosine_mean(const lq_node_axis *axis, double *weights);

/* 1 / area, or 0 where an NDF that falls like exp(-slope^2) shows a rising ray no facet at all: it has no
 * next hit (its Lambda is 0 too) and needs no row. */
double lq_inverse_area(double area);

/* `count` doubles, zero, aligned to a vector; NULL without memory. */
double *lq_zeros(size_t count);

#endif
