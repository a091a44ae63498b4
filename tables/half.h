/* half.h - binary16 as textures store it: round to nearest, ties to even. */
#ifndef LACQUER_TABLES_HALF_H
#define LACQUER_TABLES_HALF_H

#include <stdint.h>

#define LQ_HALF_MAX 65504.0f

/* From 65520 up: infinity. NaN stays one. */
uint16_t lq_half_from_float(float value);
float lq_half_to_float(uint16_t half);

/* The half next to `value`, as a float. */
float lq_half_round(float value);

#endif
