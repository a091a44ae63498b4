/* Pictures of a certificate for its page: error over pairs of axes, and how errors are distributed. */
#ifndef LACQUER_VALIDATE_REPORT_MAPS_H
#define LACQUER_VALIDATE_REPORT_MAPS_H

#include "validate/certificate_checks.h"

#include <stdio.h>

/* Largest |decoded - exact| of the last stage in cells over every pair of axes, as <svg> elements, and their
 * scale, which goes from the least of these cells to the worst point. Axes are drawn in their own map, the
 * worst point is marked and named. */
lq_status lq_report_maps(const lq_certified *certified, FILE *out, lq_error *error);

/* Share of the points against |d|, one curve a stage, as an <svg> element. */
lq_status lq_report_histogram(const lq_sampled *certificate, FILE *out, lq_error *error);

#endif
