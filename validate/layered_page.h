/* layered_page.h - the page of models measured on a set of stacks: slices side by side. */
#ifndef LACQUER_VALIDATE_LAYERED_PAGE_H
#define LACQUER_VALIDATE_LAYERED_PAGE_H

#include "validate/layered_rows.h"

/* index.html in the report's folder. */
lq_status lq_layered_page(const lq_layered_request *request, json_t *figures, const lq_layered_sums *sums,
                          lq_error *error);

/* The median of the numbers among `count` values, of every `step`-th; NaN: there are none. */
double lq_layered_median(const double *values, size_t count, size_t step, const bool *used);

#endif
