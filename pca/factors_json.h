/* factors_json.h - the structure of a factored table as JSON text; the texels lie beside it. */
#ifndef LACQUER_PCA_FACTORS_JSON_H
#define LACQUER_PCA_FACTORS_JSON_H

#include "lacquer.h"

/* Allocated; NULL where memory ran out. Doubles keep every bit. */
char *lq_factored_to_json(const lq_factored *factored);

/* Fills what the text describes into an empty `factored`, with bases of zeros; what was made when it fails
 * stays in there, for lq_factored_free. `most`: of the texel values that lie beside the text; a structure of
 * more is refused before there is memory for them. The message names no file. */
lq_status lq_factored_from_json(const char *text, size_t most, lq_factored *factored, lq_error *error);

#endif
