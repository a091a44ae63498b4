/* model_kind.h - which models of layered materials there are, by name. */
#ifndef LACQUER_STACK_MODEL_KIND_H
#define LACQUER_STACK_MODEL_KIND_H

#include <stdbool.h>

#include "lacquer.h"

typedef enum lq_model_id {
    LQ_MODEL_B18_FORWARD,
    LQ_MODEL_B18_SYMMETRIC,
    LQ_MODEL_Y19,
    LQ_MODEL_WEIDLICH_WILKIE,
    LQ_MODEL_WEIDLICH_WILKIE_CORRECTED,
    LQ_MODEL_BAKED,
    LQ_MODEL_BAKED_WINDOW,
    LQ_MODELS
} lq_model_id;

typedef struct lq_model_kind {
    const char *title;
    bool varied;      /* has variants and takes a mapping (model.h) */
    bool one_coat;    /* over a Lambertian base, and no more */
    bool scattering;  /* of media, forward */
    bool anisotropic; /* of interfaces; model_shape.h alone has it */
    bool windowed;    /* lobes inside a medium: model_shape.h alone has it */
    bool of_pairs;    /* each pair of directions has lobes of its own: model_shape.h alone has it */
} lq_model_kind;

extern const lq_model_kind lq_model_kinds[LQ_MODELS];

/* Names, by lq_model_id, and NULL: as a choice on the command line. */
extern const char *const lq_model_names[LQ_MODELS + 1];

/* LQ_BAD_INPUT: no model of that name; the message lists those there are. */
lq_status lq_model_find(const char *name, lq_model_id *id, lq_error *error);

#endif
