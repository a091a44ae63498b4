/* What every table kind is at alpha = 0: a smooth interface, in closed form or as one plain quadrature. */
#ifndef LACQUER_VALIDATE_SMOOTH_LIMIT_H
#define LACQUER_VALIDATE_SMOOTH_LIMIT_H

#include "lacquer.h"

/* `point` as for lq_eval; its alpha is taken for 0. `values`: one per channel, accurate to 1e-9. False where
 * no limit is known for the kind. */
bool lq_smooth_limit(const lq_kind *kind, const double *point, double *values);

#endif
