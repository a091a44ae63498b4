/* matched.h - says before the work that indices which nearly match cost much. */
#ifndef LACQUER_PROGRAM_MATCHED_H
#define LACQUER_PROGRAM_MATCHED_H

#include "lacquer.h"

/* A line on stderr where some pair of a roughness and a relative index over `axes` (those of the kind) is one
 * that takes the two-sided solver long: it says how many and how long. */
void cli_warn_matched(const lq_kind *kind, const lq_axis *axes);
/* The same for a point; true: there was something to say. */
bool cli_warn_matched_at(const lq_kind *kind, const double *point);

#endif
