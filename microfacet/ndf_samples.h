/* An NDF from samples of D over theta: one measured distribution, or a family over alpha. */
#ifndef LACQUER_MICROFACET_NDF_SAMPLES_H
#define LACQUER_MICROFACET_NDF_SAMPLES_H

#include "microfacet/ndf.h"

/* Columns of D, in any scale each, over common angles in radians: rising within [0, pi/2], at least
 * LQ_NDF_SAMPLES_MIN of them, D finite, >= 0 and not 0 everywhere. */
typedef struct lq_ndf_samples {
    size_t count, columns;
    const double *theta;
    const double *d; /* [column * count + i] */
    const double
        *alpha;       /* of each column, rising in (0,1]; NULL for a single one, whose roughness is found */
    const char *id;   /* these three are copied */
    const char *name; /* of the source, for the note */
} lq_ndf_samples;

enum { LQ_NDF_SAMPLES_MIN = 4 };

/* Between angles log D is a cubic spline in theta, with slopes limited so that it is monotone wherever the
 * samples are (Hyman 1983); towards a sample of 0, D itself goes there smoothly. Beyond the last angle log D
 * goes on in a straight line, never rising. Between two columns log(alpha^2 cos^4 D) is interpolated in
 * log alpha at equal tan(theta)/alpha: two of one shape give that shape. */
lq_status lq_ndf_samples_make(const lq_ndf **ndf, const lq_ndf_samples *samples, lq_error *error);

#endif
