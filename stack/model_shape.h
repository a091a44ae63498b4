/* model_shape.h - a model as a function of directions: the flux that it sends into them.
 *
 * Light of one cosine arrives travelling towards +x and down. Its lobes are those of model.h, each
 *
 *     f_s cos theta_o = E D(h) G2(i, o) / (4 mu_i) / A(mu_i, alpha)
 *
 * with GGX and height-correlated masking, mu_i the cosine that mirrors to the lobe's mean direction (a lobe
 * about the normal has 1) and A the albedo of the same with F = 1, so that its energy over the hemisphere is
 * E. B18 takes lobes without A, which are short of E by what they mask; `masked` has them so.
 */
#ifndef LACQUER_STACK_MODEL_SHAPE_H
#define LACQUER_STACK_MODEL_SHAPE_H

#include "stack/model.h"

/* Sharper lobes are taken for ones this rough: sums over cells of a fifth of a degree still have their
 * energy, to 2e-4 at mu >= 0.3; nearer the horizon, where lobes are narrower still, they lack more (at 0.15 3
 * %). */
#define LQ_SHAPE_LEAST_ALPHA 1e-2

typedef struct lq_shape_lobe {
    double energy, alpha;
    double cosine, sine; /* of the incidence that mirrors to its mean */
    double scale;        /* energy / A */
} lq_shape_lobe;

typedef struct lq_shape_query {
    lq_model_id model;
    lq_model_variant variant;
    lq_model_f f;
    const lq_model_mapping *mapping; /* that f, made for many shapes; NULL: made for this one */
    bool masked;
    double least_alpha; /* 0: LQ_SHAPE_LEAST_ALPHA */
} lq_shape_query;

/* Plain data but for `lobes`; read alone once made, by any number of threads. */
typedef struct lq_model_shape {
    int channels;
    size_t count;         /* lobes a channel, the last that of transmitted light */
    lq_shape_lobe *lobes; /* [channel * count + k] */
    double sharpest; /* the least alpha of a lobe with any energy, before least_alpha; 1 where none has */
} lq_model_shape;

/* LQ_BAD_INPUT: what lq_model_solve refuses. Free the shape, also after a failure. */
lq_status lq_model_shape_make(lq_model_shape *shape, const lq_stack *stack, const lq_shape_query *query,
                              double mu, lq_error *error);
void lq_model_shape_free(lq_model_shape *shape);

/* Flux a solid angle in the direction of travel (x, y, z), a unit vector: reflected where z > 0, transmitted
 * into the lowest medium where z < 0. `direct` is what the top interface sends there itself, without light
 * that was inside: of transmitted light that of a stack of one interface. `rest` is all else. Three values,
 * the same where the shape has one channel. */
void lq_model_shape_value(const lq_model_shape *shape, double x, double y, double z,
                          double direct[LQ_STACK_CHANNELS], double rest[LQ_STACK_CHANNELS]);

#endif
