/* Gauss-Legendre rules on [0,1]. */
#ifndef LACQUER_MICROFACET_GAUSS_H
#define LACQUER_MICROFACET_GAUSS_H

enum { LQ_GAUSS_MAX = 64 };

typedef struct lq_gauss {
    int count;
    double node[LQ_GAUSS_MAX];
    double weight[LQ_GAUSS_MAX];
} lq_gauss;

/* The rule of `count` nodes, 1 <= count <= LQ_GAUSS_MAX, exact for polynomials of degree
 * 2 count - 1; nodes ascending, accurate to rounding. */
void lq_gauss_make(lq_gauss *rule, int count);

#endif
