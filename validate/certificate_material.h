/* certificate_material.h - what a certificate of a pack says of a material of a scene. */
#ifndef LACQUER_VALIDATE_CERTIFICATE_MATERIAL_H
#define LACQUER_VALIDATE_CERTIFICATE_MATERIAL_H

#include "pack/lobes_measure.h"
#include "validate/certificate_checks.h"

typedef struct lq_certified_material {
    char name[LQ_NAME_SIZE];
    int range_count;
    char ranges[LQ_MATERIAL_RANGES][48]; /* names of what is open */
    lq_budget budget;
    lq_lobes_measure measure; /* against the exact stack */
} lq_certified_material;

/* Judgement by one of the norms max, p99 and rms, noted where it has no bound. */
enum { LQ_MATERIAL_NORMS = LQ_NORM_MEAN };
lq_check lq_material_check(const lq_certified_material *material, lq_norm norm);

/* Whether it is within its budget: NULL, or the norm that is not. */
const char *lq_material_failure(const lq_certified_material *material);

/* "mu=0.15 alpha=0.3" of its worst point. */
void lq_material_worst(const lq_certified_material *material, char *text, size_t size);

#endif
