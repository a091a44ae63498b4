/* slice_model.h - a model's lobes in the cells of a slice, and how far they are from what was measured there.
 *
 * The average of f cos theta_o over 5 x 5 sub-cells. Interfaces are isotropic, so that cells phi and 359 -
 * phi hold the same: slices are folded, measured ones to less noise.
 *
 * RMSE (Ba19 eq. 4) is the root of the mean over all cells and colours of (model - measured)^2. What the
 * noise of the measured adds to that mean is known, cell by cell, and is taken off: it is the model's own
 * error that is left, up to the chance of that sum.
 */
#ifndef LACQUER_VALIDATE_SLICE_MODEL_H
#define LACQUER_VALIDATE_SLICE_MODEL_H

#include "stack/model_shape.h"
#include "validate/goniometer.h"

enum { LQ_FOLDED_PHI = LQ_SLICE_PHI / 2, LQ_FOLDED_CELLS = LQ_SLICE_THETA * LQ_FOLDED_PHI };

/* The top interface's own light, and light that was inside. */
enum { LQ_PART_DIRECT, LQ_PART_REST, LQ_PARTS };

/* One colour, one part; cell theta * LQ_FOLDED_PHI + phi. */
typedef float lq_folded[LQ_FOLDED_CELLS];

typedef struct lq_slice_pair {
    lq_folded value[LQ_PARTS][LQ_STACK_CHANNELS];
    lq_folded variance[LQ_PARTS][LQ_STACK_CHANNELS]; /* measured: of the noise; a model: 0 */
} lq_slice_pair;

/* Which orders are a part: `inside`, all of this side's light was (what leaves below a stack of several
 * interfaces); otherwise what met the first interface once is direct. */
lq_gonio_part lq_slice_part(int side, bool inside, int part, int channel);

void lq_slice_fold(const lq_gonio *gonio, int side, bool inside, lq_slice_layout layout, const double *solid,
                   lq_slice_pair *pair);

/* The same of a model, and (where not NULL) energy and moments of each part in every colour, summed over the
 * sub-cells. */
typedef lq_stack_lobe lq_part_lobes[LQ_PARTS][LQ_STACK_CHANNELS];
lq_status lq_slice_of_model(const lq_model_shape *shape, double mu, int side, lq_slice_layout layout,
                            const double *solid, int threads, lq_slice_pair *pair, lq_part_lobes *lobes,
                            lq_error *error);

typedef struct lq_slice_error {
    double rmse, noise; /* noise: root mean square of the standard errors */
} lq_slice_error;

/* Of light that was inside, or of all. */
lq_slice_error lq_slice_compare(const lq_slice_pair *model, const lq_slice_pair *measured, int channels,
                                bool with_direct);

#endif
