/* normal.h - small systems of normal equations. */
#ifndef LACQUER_PCA_NORMAL_H
#define LACQUER_PCA_NORMAL_H

#include <stdbool.h>
#include <stddef.h>

/* step <- normal^-1 step for a packed symmetric n x n matrix; `full` has room for n x n. False: nothing to
 * solve, or no solution. */
bool lq_normal_solve(const float *packed, size_t n, double *full, double *step);

#endif
