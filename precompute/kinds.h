/* The evaluators of the catalogue's kinds, each in the file named behind it. */
#ifndef LACQUER_PRECOMPUTE_KINDS_H
#define LACQUER_PRECOMPUTE_KINDS_H

#include "precompute/evaluator.h"

extern const lq_evaluator lq_evaluate_fgd;            /* kind_fgd.c */
extern const lq_evaluator lq_evaluate_albedo;         /* kind_albedo.c */
extern const lq_evaluator lq_evaluate_albedo_average; /* kind_albedo.c */
extern const lq_evaluator lq_evaluate_dfg;            /* kind_albedo.c */

#endif
