/* slice_file.h - slices as files: EXR to compute with, PNG to look at. */
#ifndef LACQUER_VALIDATE_SLICE_FILE_H
#define LACQUER_VALIDATE_SLICE_FILE_H

#include "validate/goniometer.h"

/* What a slice is of, and what made it: the facts of its file, the titles of its picture. */
typedef struct lq_slice_label {
    const char *name;  /* of the stack */
    const char *stack; /* its description, as JSON */
    const char *interfaces, *from;
    uint64_t seed;
    int side;
    lq_slice_layout layout;
} lq_slice_label;

/* A table over theta, phi (degrees, the middles of the cells) and order (1: met the first interface once),
 * with a value and a standard error a colour. */
lq_status lq_slice_write_exr(const lq_gonio *gonio, const lq_slice_label *label, const char *path,
                             lq_error *error);

/* The logarithm of the value, averaged over the colours: all light, its noise, and each order. */
lq_status lq_slice_write_png(const lq_gonio *gonio, const lq_slice_label *label, const char *path,
                             lq_error *error);

#endif
