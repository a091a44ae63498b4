/* lobes.h - a material's numbers as texels: the fewest that keep its budget, fitted to how GPUs filter.
 *
 * A texel is not the value at its node: texels are those whose linear interpolation is nearest, by least
 * squares, to the material between the nodes as well. Numbers that hardly vary become constants of the
 * source, and equal ones share a channel.
 */
#ifndef LACQUER_PACK_LOBES_H
#define LACQUER_PACK_LOBES_H

#include "pack/image.h"
#include "stack/bake.h"

enum { LQ_LOBES_AXES = 1 + LQ_MATERIAL_RANGES, LQ_LOBES_PER_TEXEL = 4, LQ_LOBES_BORDER = 2 };

typedef struct lq_lobes {
    const lq_material *material;
    int axis_count; /* mu, then the ranges */
    lq_axis axes[LQ_LOBES_AXES];
    int channel[LQ_MATERIAL_NUMBERS];     /* which holds a number; -1: it is */
    double constant[LQ_MATERIAL_NUMBERS]; /* this */
    int channel_count;
    size_t texels; /* RGBA each: channel c is channel c % 4 of texel c / 4 */
    /* Width mu, rows the first range, slices of the second below each other, lq_lobes_pitch rows apart; a
     * layer a texel. */
    lq_image image;
    double p99, max; /* over what the texels were fitted to */
} lq_lobes;

typedef struct lq_lobes_budget {
    double p99, max;
} lq_lobes_budget;

/* How many cosines, and where: those that lq_bake is to solve. */
enum { LQ_LOBES_COSINES = 96 };
void lq_lobes_cosines(double mu[LQ_LOBES_COSINES]);

/* LQ_NOT_CONVERGED: 64 texels an axis do not keep the budget; these are there. */
lq_status lq_lobes_make(lq_lobes *lobes, const lq_baked *baked, const lq_lobes_budget *budget,
                        lq_error *error);
/* Many texels in float32, for a reference: 64 cosines and 32 values a range (12 of each of two). */
lq_status lq_lobes_make_fine(lq_lobes *lobes, const lq_baked *baked, lq_error *error);
void lq_lobes_free(lq_lobes *lobes);

/* Its image, all 0, for axes and channels that are set: for a reader. */
lq_status lq_lobes_allocate(lq_lobes *lobes, lq_error *error);

/* What a manifest calls number `k` of LQ_MATERIAL_NUMBERS: "top.r". */
const char *lq_lobes_number_name(int k);

/* Rows from one slice to the next: those of a slice, and a border. */
size_t lq_lobes_pitch(const lq_lobes *lobes);

/* The numbers as a GPU decodes them, at one cosine and one value a range; exact filter weights with 0
 * `fraction_bits`. */
void lq_lobes_sample(const lq_lobes *lobes, double mu, const double *values, int fraction_bits,
                     double numbers[LQ_MATERIAL_NUMBERS]);

/* How far `numbers` are from `exact`, of the lobes that the material has: energies as they are (of a base
 * with an open albedo, at its ends and middle), roughness by how much light has it. How many `errors` there
 * are. */
enum { LQ_LOBES_ERRORS = 17 };
size_t lq_lobes_compare(const lq_material *material, const double *numbers, const double *exact,
                        double errors[LQ_LOBES_ERRORS]);

#endif
