/* Tables of `lacquer fit bounces`, `anisotropic` and `transmitted`: printed, and returned as JSON rows. */
#ifndef LACQUER_PROGRAM_FIT_BOUNCES_H
#define LACQUER_PROGRAM_FIT_BOUNCES_H

#include "program/fit/fit.h"
#include "system/json.h"

/* NULL: interrupted. `job` has its curve; fit_bounces also its fit. */
json_t *fit_bounces(const fit_job *job, size_t samples);
json_t *fit_anisotropic(const fit_job *job, size_t samples);
json_t *fit_transmitted(const fit_job *job);

/* Takes `rows`. False: a line was printed. */
bool fit_write_rows(const fit_job *job, const char *table, size_t samples, json_t *rows);

#endif
