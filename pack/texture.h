/* texture.h - a table as one texture, and how a shader reads it. */
#ifndef LACQUER_PACK_TEXTURE_H
#define LACQUER_PACK_TEXTURE_H

#include "pack/image.h"

enum { LQ_TEXTURE_AXES = 3, LQ_TEXTURE_LARGEST = 16384 }; /* no GPU takes more texels along an axis */

/* Axes of one node are left out: what was fixed there is in the provenance. */
typedef struct lq_texture {
    char name[LQ_NAME_SIZE]; /* an identifier: "tir_pass" */
    int axis_count;
    lq_axis axes[LQ_TEXTURE_AXES]; /* x, y, z of the texture */
    int from[LQ_TEXTURE_AXES];     /* which axis of the table each was */
    int channel_count;             /* of the table; the image may have one more, 0 */
    char channels[4][LQ_NAME_SIZE];
    lq_image image;
} lq_texture;

/* LQ_BAD_INPUT: more than three axes of several nodes, nodes that no formula gives, values beyond half. */
lq_status lq_texture_make(lq_texture *texture, const lq_table *table, const char *name, lq_error *error);
void lq_texture_free(lq_texture *texture);

/* As lq_texture_make refuses, before the table is there. */
lq_status lq_texture_check(const char *name, const lq_axis *axes, int axis_count, int channel_count,
                           lq_error *error);

/* The texel below x on an axis, and the weight of the one above, in steps of 2^-fraction_bits; 0: exact. */
size_t lq_texel_below(const lq_axis *axis, double x, int fraction_bits, double *above);

/* What a GPU's sampler returns at a point of the table: float arithmetic on the stored halves, filter weights
 * of `fraction_bits` bits; 0: exact weights. */
void lq_texture_sample(const lq_texture *texture, const double *point, int fraction_bits, double *values);

/* The axis along which the texels bend most about a point of the table: where more of them would help. */
const char *lq_texture_bends(const lq_texture *texture, const double *point);

#endif
