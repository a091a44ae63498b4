/* Pictures of a certificate for its page: error over a pair of axes, and how errors are distributed. */
#ifndef LACQUER_VALIDATE_REPORT_MAPS_H
#define LACQUER_VALIDATE_REPORT_MAPS_H

#include "validate/certificate.h"

#include <stdio.h>

/* Colours of decades of error, as style rules for a page. */
extern const char lq_report_map_style[];

/* Largest |decoded - exact| of the last stage in cells over two axes, as an <svg> element. */
void lq_report_map(const lq_sampled *certificate, int axis_x, int axis_y, FILE *out);

/* Share of the points against |d|, one curve a stage, as an <svg> element. */
lq_status lq_report_histogram(const lq_sampled *certificate, FILE *out, lq_error *error);

#endif
