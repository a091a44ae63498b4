/* layered_picture.h - slices as small images in colour. */
#ifndef LACQUER_VALIDATE_LAYERED_PICTURE_H
#define LACQUER_VALIDATE_LAYERED_PICTURE_H

#include "validate/slice_model.h"

/* The brightest cell, all light: what the scales of its pictures end with. */
double lq_slice_peak(const lq_slice_pair *pair, int channels);

/* All light, four decades below `peak` in the colours it has; below it, where `against` is not NULL, what it
 * differs by, red where it is more: white to the full colour at a tenth of the peak. phi from 0 to 180
 * degrees to the right, theta from 0 at the bottom. */
lq_status lq_slice_picture(const lq_slice_pair *pair, const lq_slice_pair *against, int channels, double peak,
                           const char *path, lq_error *error);

#endif
