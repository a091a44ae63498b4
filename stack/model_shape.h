/* model_shape.h - a model as a function of directions: the flux that it sends into them.
 *
 * Light of one cosine arrives travelling towards +x and down. Its lobes are those of model.h, each
 *
 *     f_s cos theta_o = E D(h) G2(i, o) / (4 mu_i) / A(mu_i, alpha)
 *
 * with GGX and height-correlated masking, mu_i the cosine that mirrors to the lobe's mean direction (a lobe
 * about the normal has 1) and A the albedo of the same with F = 1, so that its energy over the hemisphere is
 * E. B18 takes lobes without A, which are short of E by what they mask; `masked` has them so.
 *
 * b18-symmetric (B18 sec. 6.2) takes for E, alpha and A those of the cosine between light and half vector,
 * which are the same when light and view change places. Nothing normalises that to any energy: what it sends
 * altogether is what comes of it (lq_model_shape_light). Transmitted light has the half vector of its
 * direction mirrored up and the refracted light's, and Snell takes the angle between them outside.
 *
 * Anisotropic lobes (y19) are normalised by a sum of their own, to some 1e-3.
 *
 * baked-window has lobes inside a medium (model_window.h).
 *
 * weidlich-wilkie and weidlich-wilkie-corrected are in weidlich.h.
 *
 * The first lobe of any model can be the BRDF of the top interface itself, F(h) D G2 / (4 mu_i mu_o), instead
 * (Ba19 eq. 6): of one scattering, which loses what it masks, or scaled to what the model's own lobe has.
 */
#ifndef LACQUER_STACK_MODEL_SHAPE_H
#define LACQUER_STACK_MODEL_SHAPE_H

#include "stack/model_window.h"
#include "stack/model_y19.h"
#include "stack/shape_grid.h"
#include "stack/weidlich.h"

/* The first lobe: the model's, the top interface's BRDF, or that with the energy of the model's. */
typedef enum lq_first_lobe { LQ_FIRST_OF_MODEL, LQ_FIRST_EXACT, LQ_FIRST_SCALED } lq_first_lobe;

/* Sharper lobes are taken for ones this rough: sums over cells of a fifth of a degree still have their
 * energy, to 2e-4 at mu >= 0.3; nearer the horizon, where lobes are narrower still, they lack more (at 0.15
 * 3 %). */
#define LQ_SHAPE_LEAST_ALPHA 1e-2

typedef struct lq_shape_lobe {
    double energy, alpha;
    double scale;      /* energy / A */
    lq_window window;  /* in place of a lobe of `alpha`, where its n is above 0 */
    lq_incidence from; /* what mirrors to its mean */
    bool turned;       /* anisotropic: `alpha` is the geometric mean of two */
    lq_turned_ggx ggx;
} lq_shape_lobe;

typedef struct lq_shape_query {
    lq_model_id model;
    lq_model_variant variant;
    lq_model_f f;
    const lq_model_mapping *mapping; /* that f, made for many shapes; NULL: made for this one */
    const lq_model_source *source;   /* of tables; NULL: they are computed exactly */
    bool masked;
    lq_first_lobe first;
    double azimuth;     /* of the light's travel from the x axis of the layers, in degrees: for y19 */
    double least_alpha; /* 0: LQ_SHAPE_LEAST_ALPHA */
    int threads;        /* 0: one per core */
} lq_shape_query;

/* Read alone once made, by any number of threads. */
typedef struct lq_model_shape {
    const lq_stack *stack;
    lq_shape_query query;
    int channels;
    size_t count;         /* lobes a channel, the last that of transmitted light */
    lq_shape_lobe *lobes; /* [channel * count + k], in the direction of a mirror */
    lq_shape_grid grid;   /* without nodes: lobes are the same in all directions */
    lq_weidlich rays;     /* of a model of rays, and of a first lobe that is a BRDF */
    double sharpest; /* the least alpha of a lobe with any energy, before least_alpha; 1 where none has */
} lq_model_shape;

/* The stack must outlive the shape. LQ_BAD_INPUT: what lq_model_solve refuses, and what the model refuses
 * besides (model_kind.h). Free the shape, also after a failure. */
lq_status lq_model_shape_make(lq_model_shape *shape, const lq_stack *stack, const lq_shape_query *query,
                              double mu, lq_error *error);
void lq_model_shape_free(lq_model_shape *shape);

/* The same for light of another cosine. What all cosines share is kept: the shapes of a symmetric model are
 * one. */
lq_status lq_model_shape_aim(lq_model_shape *shape, double mu, lq_error *error);

/* Flux a solid angle in the direction of travel (x, y, z), a unit vector: reflected where z > 0, transmitted
 * into the lowest medium where z < 0. `direct` is what the top interface sends there itself, without light
 * that was inside: of transmitted light that of a stack of one interface. `rest` is all else. Three values,
 * the same where the shape has one channel. */
void lq_model_shape_value(const lq_model_shape *shape, double x, double y, double z,
                          double direct[LQ_STACK_CHANNELS], double rest[LQ_STACK_CHANNELS]);

/* Lobe k of a channel, in a direction of its own side: z > 0. */
double lq_model_shape_lobe(const lq_model_shape *shape, int channel, size_t k, double x, double y, double z);

/* Energy and moments of one such lobe and of all of a channel, summed over directions to some 1e-3. */
lq_stack_lobe lq_model_shape_moments(const lq_model_shape *shape, int channel, size_t k);
lq_stack_light lq_model_shape_light(const lq_model_shape *shape, int channel);

#endif
