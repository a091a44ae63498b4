/* adding.c - B18 eq. 28-31, 34-35, 38, 47-51. */
#include "stack/adding.h"

#include <math.h>

lq_model_sum lq_model_nothing(void) {
    return (lq_model_sum){.t0i.energy = 1.0, .ti0.energy = 1.0, .j0i = 1.0, .ji0 = 1.0};
}

void lq_model_reflect_back(lq_model_sum *sum, double pass) {
    sum->ri0.energy += (1.0 - pass) * sum->ti0.energy;
    sum->ti0.energy *= pass;
}

/* Two lobes taken for one: energies add, and variances by energy (eq. 38). */
static lq_flow blend(lq_flow a, lq_flow b) {
    const double energy = a.energy + b.energy;
    if (!(energy > 0.0)) return (lq_flow){0};
    return (lq_flow){energy, (a.energy * a.variance + b.energy * b.variance) / energy};
}

/* The pole of f is a large number and not infinity (model_mapping.h); many layers must not make it one. */
static void bound(lq_flow *flow) {
    flow->variance = fmin(flow->variance, 1e200);
}

/* Between the layers and the interface light goes to and fro: energies of eq. 28-31 have all rounds,
 * variances the mean number of them, `again`. */
lq_flow lq_model_add(lq_model_sum *s, const lq_model_interface *i) {
    const double left = 1.0 - s->ri0.energy * i->r12.energy, rounds = left > 0.0 ? 1.0 / left : 0.0;
    const double again = s->ri0.energy * i->r12.energy * rounds;
    const double round = again * (i->r12.variance + s->ri0.variance);
    const lq_flow lobe = {s->t0i.energy * i->r12.energy * s->ti0.energy * rounds,
                          s->ti0.variance + s->j0i * (s->t0i.variance + i->r12.variance + round)};
    const lq_flow inner = {i->t21.energy * s->ri0.energy * i->t12.energy * rounds,
                           i->t12.variance + i->j12 * (i->t21.variance + s->ri0.variance + round)};
    s->r0i = blend(s->r0i, lobe);
    s->ri0 = blend(i->r21, inner);
    s->t0i = (lq_flow){s->t0i.energy * i->t12.energy * rounds,
                       i->j12 * s->t0i.variance + i->t12.variance + i->j12 * round};
    s->ti0 = (lq_flow){i->t21.energy * s->ti0.energy * rounds,
                       s->ji0 * i->t21.variance + s->ti0.variance + s->ji0 * round};
    bound(&s->r0i);
    bound(&s->ri0);
    bound(&s->t0i);
    bound(&s->ti0);
    s->j0i *= i->j12;
    s->ji0 *= i->j21;
    return lobe;
}

/* An interface that reflects nothing and bends nothing. */
void lq_model_cross(lq_model_sum *sum, lq_flow crossing) {
    const lq_model_interface medium = {.t12 = crossing, .t21 = crossing, .j12 = 1.0, .j21 = 1.0};
    lq_model_add(sum, &medium);
}
