/* model_mapping.h - roughness as a linear variance f, which bounces add (B18 sec. 4.1). */
#ifndef LACQUER_STACK_MODEL_MAPPING_H
#define LACQUER_STACK_MODEL_MAPPING_H

#include "fit/curve.h"

typedef enum lq_model_f {
    LQ_MODEL_F_EXACT, /* fit/curve.h */
    LQ_MODEL_F_B18    /* B18's fit, alpha^1.1 / (1 - alpha^1.1) */
} lq_model_f;

/* Plain data; `curve` is filled for LQ_MODEL_F_EXACT alone. */
typedef struct lq_model_mapping {
    lq_model_f f;
    lq_curve curve;
} lq_model_mapping;

/* Of GGX. */
lq_status lq_model_mapping_make(lq_model_mapping *mapping, lq_model_f f, lq_error *error);

/* Finite for every alpha, so that no energy 0 meets an infinity: the pole at 1, and what lies beyond, is a
 * large number. */
double lq_model_variance(const lq_model_mapping *mapping, double alpha);
/* sigma_g, what a Henyey-Greenstein phase function of mean cosine g in (0,1) spreads (B18 eq. 21): f of the
 * lobe with the same E[sin^2 theta] over its forward hemisphere, or B18's fit of that, ((1 - g) / g)^0.8 / (1
 * + g). */
double lq_model_phase(const lq_model_mapping *mapping, double g);

/* 1 for that number and above. */
double lq_model_roughness(const lq_model_mapping *mapping, double variance);

#endif
