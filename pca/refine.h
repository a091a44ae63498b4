/* refine.h - all factors of a piece fitted together: weighted alternating least squares, Gauss-Newton through
 * the value transform, and reweighting towards the largest error. */
#ifndef LACQUER_PCA_REFINE_H
#define LACQUER_PCA_REFINE_H

#include "lacquer.h"

enum { LQ_MAX_BASES = 64, LQ_MAX_PAIRS = 8 };

/* One stream: p (rows x bases) q (columns x bases)^T. `column` says which of its columns a column of the
 * samples reads: the energy of a crossing does not depend on tau. */
typedef struct lq_stream {
    size_t bases, columns;
    int axes; /* which of the separated axes it depends on: bit 0 the first, bit 1 the second */
    size_t *column;
    double *p, *q;
    size_t size[2];   /* columns = size[0] * size[1], the texels along the one or two axes they have */
    size_t pairs;     /* each base of q is a sum of so many products of two lines; 0: it may be anything */
    double *lines[2]; /* with pairs: lines[a][(base * pairs + j) * size[a] + i] */
} lq_stream;

typedef struct lq_fit {
    size_t rows, columns;
    const float *samples;
    lq_value value;
    const double *depth; /* LQ_VALUE_BEER: log2 of tau, of each column */
    double power;        /* of the error that is minimised: 2 rms; more: nearer to the largest error */
    int stream_count;
    lq_stream streams[LQ_MAX_STREAMS];
} lq_fit;

/* Allocate p and q of the streams, whose bases, columns and pairs are set. */
lq_status lq_fit_create(lq_fit *fit, lq_error *error);
void lq_fit_free(lq_fit *fit);

/* Singular vectors of the transformed samples. */
lq_status lq_fit_start(lq_fit *fit, lq_error *error);

/* `sweeps` passes over all streams. With `only_p` what q is stays (it has been rounded). */
lq_status lq_fit_refine(lq_fit *fit, int sweeps, bool only_p, const lq_progress *progress, lq_error *error);

/* Largest and rms error over the samples. */
lq_status lq_fit_errors(const lq_fit *fit, double *largest, double *rms, lq_error *error);

#endif
