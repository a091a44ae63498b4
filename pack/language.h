/* language.h - shading languages, and one text that becomes source in each of them.
 *
 * In such a text
 *     $1 $2 $3 $4     are a scalar and vectors of floats, $L the lobes of a material, $B a truth value
 *     $c2( $c3( $c4(  make a vector
 *     $=1 x           declares x, $~1 x one that changes
 *     $f              ends a literal: 0.5$f
 *     @sqrt( @pow(    are the language's functions: sqrt, pow, exp2, floor, min, max, clamp, mix
 *     $a              are the arguments that the atlas comes as
 *     $(1 name|A|1 x$) is the head of a function of the atlas and x that returns a scalar
 * and vectors are only ever read and written by component: C has no others.
 */
#ifndef LACQUER_PACK_LANGUAGE_H
#define LACQUER_PACK_LANGUAGE_H

#include "lacquer.h"

#include <stdio.h>

/* The first three also serve packs of single textures. */
typedef enum lq_language {
    LQ_GLSL,   /* ES 3.00 and 4.50, combined samplers */
    LQ_HLSL,   /* SM 5 and 6 */
    LQ_C,      /* C99 and C++ */
    LQ_VULKAN, /* GLSL 4.50 with separate textures and samplers */
    LQ_WGSL,
    LQ_METAL,
    LQ_LANGUAGES
} lq_language;

/* "decode.glsl", "decode.hlsl", "decode.h", ... */
const char *lq_language_file(lq_language language);

/* Write a text in a language; `format` is that of printf, expanded first, to less than LQ_SAY_SIZE bytes. */
enum { LQ_SAY_SIZE = 4096 };
void lq_say(FILE *out, lq_language language, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* A number as a literal, the shortest that reads back as the same float. */
enum { LQ_LITERAL_SIZE = 48 };
const char *lq_literal(double value, lq_language language, char text[LQ_LITERAL_SIZE]);

#endif
