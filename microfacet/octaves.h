/* A function on [floor, 1] as cubics over cells that divide every octave evenly.
 *
 * The first bits of a double are its octave and its cell, so that a look-up is a shift, four loads and three
 * multiply-adds, and a function that changes over its argument's own size (a power, the core of a narrow
 * lobe) is resolved alike from `floor`, a power of two, to 1. Both tables of profile.h have this form.
 */
#ifndef LACQUER_MICROFACET_OCTAVES_H
#define LACQUER_MICROFACET_OCTAVES_H

#include <stddef.h>
#include <stdint.h>

typedef struct lq_octaves {
    double floor; /* 2^-k */
    int shift;    /* of the bits of x: what is left counts cells */
    int64_t first;
    size_t cells;
    double (*cubic)[4]; /* of each cell, in x minus its start */
} lq_octaves;

/* Cells of 2^bits to the octave; `values` has 3 a cell, at its thirds (see lq_octaves_at), and one more for
 * x = 1. 0, without memory. */
int lq_octaves_make(lq_octaves *o, int octaves, int bits);
void lq_octaves_free(lq_octaves *o);

/* Position of sample i in [0, 3 cells]. */
double lq_octaves_at(const lq_octaves *o, size_t i);
/* The cubics through samples at those positions. */
void lq_octaves_fit(lq_octaves *o, const double *samples);

/* Start of a cell, and integral of its cubic over [start, start + offset]. */
double lq_octaves_start(const lq_octaves *o, size_t cell);
double lq_octaves_integral(const lq_octaves *o, size_t cell, double offset);
double lq_octaves_value(const lq_octaves *o, double x);

#endif
