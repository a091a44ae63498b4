/* refine.h - all factors of a piece fitted together: weighted alternating least squares, Gauss-Newton through
 * the value transform, and reweighting towards the largest error. */
#ifndef LACQUER_PCA_REFINE_H
#define LACQUER_PCA_REFINE_H

#include "pca/stream.h"

/* `sweeps` passes over all streams. With `only_p` what q is stays (it has been rounded). */
lq_status lq_fit_refine(lq_fit *fit, int sweeps, bool only_p, const lq_progress *progress, lq_error *error);

/* Largest and rms error over the samples. */
lq_status lq_fit_errors(const lq_fit *fit, double *largest, double *rms, lq_error *error);

#endif
