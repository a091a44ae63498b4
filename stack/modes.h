/* modes.h - what light of a stack is counted by: the first three harmonics of its azimuth.
 *
 * A reward for leaving at cosine mu and azimuth phi, counted from the direction away from the light, is one
 * of
 *
 *     mode 0: g(mu)         mode 1: sin theta g(mu) cos phi         mode 2: g(mu) cos 2 phi
 *
 * and so is what light arriving at cosine mu is worth (interfaces are isotropic): every map between the two
 * acts on functions of mu, one map a mode. Mode 1 carries the quotient by sin theta, because what is worth
 * sin theta cos phi vanishes like sin theta itself at normal incidence, which nodes in the root of mu do not
 * resolve.
 */
#ifndef LACQUER_STACK_MODES_H
#define LACQUER_STACK_MODES_H

enum { LQ_MODES = 3 };

/* Of light that a facet turns: the harmonics of the turn of its azimuth, as the modes carry them. `forward`:
 * the component of the new direction along the old one's projection; sine_i, sine_o of the old and the new
 * one. */
static inline void lq_mode_turns(double forward, double sine_i, double sine_o2, double turns[LQ_MODES]) {
    turns[0] = 1.0;
    turns[1] = forward / sine_i;
    turns[2] = sine_o2 > 0.0 ? 2.0 * forward * forward / sine_o2 - 1.0 : 0.0;
}

#endif
