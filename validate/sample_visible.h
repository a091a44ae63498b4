/* Draws microfacet normals as a ray sees them: from D_v(m) = <v.m>+ D(m) / sigma(v), v on the whole sphere.
 *
 * The ray travels along -v. Its frame has v in the xz plane, v = (v_s, 0, v_z) with v_s >= 0; v_z < 0 means
 * that the ray goes up and looks at the facets that it meets from below the horizon.
 */
#ifndef LACQUER_VALIDATE_SAMPLE_VISIBLE_H
#define LACQUER_VALIDATE_SAMPLE_VISIBLE_H

#include "microfacet/ndf.h"
#include "validate/stream.h"

#include <stdbool.h>

typedef struct lq_facet {
    double x, y, z; /* m; its y only up to sign, which an isotropic surface does not show */
    double cosine;  /* v.m > 0 */
} lq_facet;

enum { LQ_VISIBLE_OCTAVES = 52, LQ_VISIBLE_CELLS = 4 * LQ_VISIBLE_OCTAVES };

/* Made once per (ndf, alpha); plain data, shared by threads. */
typedef struct lq_visible {
    const lq_ndf *ndf;
    double alpha;
    bool closed_form;
    /* Rejection only: 1 - xi at the cell bounds, falling; the largest slope in each cell; and from the
     * last cell backwards the sum of (cell width) x (largest slope). */
    double rest[LQ_VISIBLE_CELLS + 1], slope[LQ_VISIBLE_CELLS], tail[LQ_VISIBLE_CELLS + 1];
} lq_visible;

/* alpha > 0. `closed_form` false: rejection even where a closed form is known (tests compare the two). */
void lq_visible_make(lq_visible *visible, const lq_ndf *ndf, double alpha, bool closed_form);

void lq_visible_sample(const lq_visible *visible, double v_z, double v_s, lq_stream *stream, lq_facet *facet);

#endif
