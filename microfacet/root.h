/* Where a rising function crosses zero, in few evaluations. */
#ifndef LACQUER_MICROFACET_ROOT_H
#define LACQUER_MICROFACET_ROOT_H

typedef double lq_gap(const void *user, double x);

/* The zero of `gap` between `low`, where it is below < 0, and `high`, where it is above > 0, to 1e-14 in x or
 * `rounding` in the gap: the Illinois variant of regula falsi. */
double lq_root(lq_gap *gap, const void *user, double low, double below, double high, double above,
               double rounding);

#endif
