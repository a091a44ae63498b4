/* factored.h - a factored table as texture arrays, and the source that decodes it. */
#ifndef LACQUER_PACK_FACTORED_H
#define LACQUER_PACK_FACTORED_H

#include "pack/source.h"

#include <stdio.h>

enum { LQ_BASES_PER_LAYER = 4 };

/* The bases of one factor: RGBA half, base b in channel b % 4 of layer b / 4. */
typedef struct lq_bases {
    int piece, factor;
    char suffix[24]; /* of its files and arguments: "0_1", piece and factor */
    lq_image image;
} lq_bases;

typedef struct lq_factored_textures {
    char name[LQ_NAME_SIZE]; /* an identifier */
    char stem[LQ_NAME_SIZE]; /* of its files: STEM.0_1.ktx2 */
    const lq_factored *factored;
    size_t count;
    lq_bases bases[LQ_MAX_PIECES * LQ_MAX_FACTORS];
} lq_factored_textures;

lq_status lq_factored_layout(lq_factored_textures *textures, const lq_factored *factored, const char *name,
                             lq_error *error);
void lq_factored_textures_free(lq_factored_textures *textures);

/* Of all of them, as a GPU holds them. */
size_t lq_factored_textures_bytes(const lq_factored_textures *textures);

/* Append the decode function. It clamps its arguments to the table's ranges, takes the first piece that holds
 * them, and sums products of bases. */
void lq_factored_source(FILE *out, lq_language language, const lq_factored_textures *textures,
                        const lq_kind *kind);

#endif
