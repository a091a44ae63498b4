/* The evaluators of the catalogue's kinds, each in the file named behind it. */
#ifndef LACQUER_PRECOMPUTE_KINDS_H
#define LACQUER_PRECOMPUTE_KINDS_H

#include "precompute/evaluator.h"

extern const lq_evaluator lq_evaluate_fgd;                  /* kind_fgd.c */
extern const lq_evaluator lq_evaluate_albedo;               /* kind_albedo.c */
extern const lq_evaluator lq_evaluate_albedo_average;       /* kind_albedo.c */
extern const lq_evaluator lq_evaluate_dfg;                  /* kind_albedo.c */
extern const lq_evaluator lq_evaluate_tir_pass;             /* kind_tir.c */
extern const lq_evaluator lq_evaluate_tir_loss;             /* kind_tir.c */
extern const lq_evaluator lq_evaluate_fgd_dielectric;       /* kind_dielectric.c */
extern const lq_evaluator lq_evaluate_transmission;         /* kind_dielectric.c */
extern const lq_evaluator lq_evaluate_diffuse_transmission; /* kind_diffuse.c */
extern const lq_evaluator lq_evaluate_diffuse_reflection;   /* kind_diffuse.c */
extern const lq_evaluator lq_evaluate_variance;             /* kind_diffuse.c */
extern const lq_evaluator lq_evaluate_coated_lambertian;    /* kind_coated.c */

#endif
