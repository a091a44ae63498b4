/* stream.h - the unknowns of a fit: streams, each a product of two thin matrices. */
#ifndef LACQUER_PCA_STREAM_H
#define LACQUER_PCA_STREAM_H

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

#endif
