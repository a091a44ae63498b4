/* Physics that several tables of a folder owe each other, as they are decoded. */
#ifndef LACQUER_VALIDATE_CERTIFICATE_PACK_H
#define LACQUER_VALIDATE_CERTIFICATE_PACK_H

#include "validate/certificate_checks.h"

/* Where the tables are there, made with one NDF and all orders of scattering, at tau = 1:
 *   R01 + T01 <= 1
 *   T10 = T01bar / eta^2 and R10 = 1 - (1 - R01bar) / eta^2: reciprocity
 *   R01 + T01 T10 / (1 - R10) = 1: a white base under a clear coating, the furnace
 * Each judgement goes to the last table it needs. The bound of `max` is the limit where one is set: the exact
 * values obey all four. */
void lq_check_pack(lq_certified *list, size_t count);

#endif
