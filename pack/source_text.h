/* source_text.h - pieces of decode source that several functions are made of. */
#ifndef LACQUER_PACK_SOURCE_TEXT_H
#define LACQUER_PACK_SOURCE_TEXT_H

#include "pack/source.h"

#include <stdio.h>

/* Shortest text that reads back as the same float, with a decimal point. */
void lq_print_number(FILE *out, double value, lq_language language);

/* Where on an axis, in [0,1], the expression `value` is: clamped, through the inverse of the axis' map. */
void lq_print_coordinate(FILE *out, const lq_axis *axis, const char *value, lq_language language);

/* What stands before the functions: helpers they call. */
void lq_print_helpers(FILE *out, lq_language language);

#endif
