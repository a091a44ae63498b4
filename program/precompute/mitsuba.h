/* mitsuba.h - the three tables of a Mitsuba transmittance file, made and written in one go.
 */
#ifndef LACQUER_PROGRAM_PRECOMPUTE_MITSUBA_H
#define LACQUER_PROGRAM_PRECOMPUTE_MITSUBA_H

#include "lacquer.h"

/* Replace the default axes of `transmission` by those of a file: power4, eta from 1 to 4, tau = 1. */
lq_status precompute_mitsuba_axes(lq_axis *axes, lq_error *error);

/* Seen from outside over `axes`, from inside over their 1/eta, and cosine-weighted means; into `path`.
 * `entries` and `estimate` (of the largest error) are of all three. LQ_NOT_CONVERGED: written, but above the
 * tolerance. */
lq_status precompute_mitsuba(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                             const char *path, size_t *entries, double *estimate, lq_error *error);

#endif
