/* claims.h - who of a crew does which numbered piece of work: files in a folder that all of them see. */
#ifndef LACQUER_SYSTEM_CLAIMS_H
#define LACQUER_SYSTEM_CLAIMS_H

#include "system/crew.h"

/* Remove those of a run before: the first of the crew, before all meet. */
void lq_claims_clear(const char *folder);

/* May this process do it? Each number is given away once, and none after lq_claims_stop. Alone (`crew` NULL):
 * always. */
bool lq_claim(const char *folder, const lq_crew *crew, size_t index);
void lq_claims_stop(const char *folder, const lq_crew *crew);

#endif
