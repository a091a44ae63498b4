/* report_parts.h - what the files of a certificate's page share. */
#ifndef LACQUER_VALIDATE_REPORT_PARTS_H
#define LACQUER_VALIDATE_REPORT_PARTS_H

#include "validate/report.h"

#include <stdio.h>

/* The class that colours an outcome. */
const char *lq_report_word(lq_outcome outcome);

/* The larger of what the sample and the search found is certificate.max; where that was. */
const double *lq_report_worst(const lq_sampled *certificate);

/* The section of one table, number `number`: what a reader looks for first, and the rest behind a click. */
lq_status lq_report_table(FILE *out, const lq_certified *certified, size_t number, lq_error *error);

#endif
