/* material.h - a material as a shader has it: a few lobes with the exact stack's energies.
 *
 * What the top interface reflects at once is one lobe, with that interface's roughness. Light that was inside
 * and comes back without having met a Lambertian base is another, whose roughness gives it the spread of the
 * exact stack across the plane of incidence. A Lambertian base forgets where light came from, so that what
 * comes back from it is through(mu) rho / (1 - rho back), D22 eq. 3 with any number of layers above: exact
 * for any albedo, which therefore needs no axis.
 */
#ifndef LACQUER_STACK_MATERIAL_H
#define LACQUER_STACK_MATERIAL_H

#include "stack/spread.h"

enum { LQ_MATERIAL_RANGES = 2, LQ_MATERIAL_COLOURS = LQ_STACK_CHANNELS };

/* Below this cosine no error is promised. */
#define LQ_MATERIAL_FROM 0.02

/* What is known of a material at a cosine and a set of its parameters; three numbers a colour each. */
enum {
    LQ_MATERIAL_TOP = 0,         /* energy that the top interface reflects at once */
    LQ_MATERIAL_INNER = 3,       /* energy that was inside and did not meet a Lambertian base */
    LQ_MATERIAL_INNER_ALPHA = 6, /* its roughness */
    LQ_MATERIAL_THROUGH = 7,     /* from outside to the base times from the base to outside; where rho is no
                                    range: the energy that leaves */
    LQ_MATERIAL_BACK = 10,       /* from the base back to it; where rho is no range: 0 */
    LQ_MATERIAL_BASE_ALPHA = 13, /* a lobe about the normal of this roughness spreads as what leaves */
    LQ_MATERIAL_NUMBERS = 14
};

/* A parameter that a texture spans. */
typedef struct lq_material_range {
    char path[40]; /* as lq_stack_set takes it: "1.alpha" */
    char name[48]; /* an identifier: "alpha", or "top_alpha" where another layer has one too */
    double min, max;
    bool roughness;
} lq_material_range;

typedef struct lq_material {
    const lq_stack *stack;
    int range_count;
    lq_material_range ranges[LQ_MATERIAL_RANGES]; /* without the albedo of a Lambertian base */
    bool lambertian;                              /* the base */
    bool open_rho;                                /* its albedo is a range, rho_min to rho_max */
    double rho_min, rho_max;
    int top_range;    /* which range is the roughness of the top; -1: it is */
    double top_alpha; /* this */
} lq_material;

/* LQ_BAD_INPUT: more ranges than a texture has axes besides the cosine, a stack that lets light through, an
 * NDF that is not ggx (the shader's lobes are), and what lq_stack_solve does not solve. The stack must
 * outlive the material. */
lq_status lq_material_describe(lq_material *material, const lq_stack *stack, lq_error *error);

/* numbers[m * LQ_MATERIAL_NUMBERS + k] at each cosine, `values` one a range. `spread` is of these cosines
 * and, after them, of cosine 1. `level` < 0: exact, to `tolerance`; otherwise of that level of resolution,
 * the coarsest (0) is as a rule right to some 1e-4. */
lq_status lq_material_solve(const lq_material *material, const double *values, const lq_spread *spread,
                            const double *mu, size_t count, int level, double tolerance, double *numbers,
                            lq_error *error);

/* The roughness of the top interface, `values` one a range. */
static inline double lq_material_top_alpha(const lq_material *m, const double *values) {
    return m->top_range < 0 ? m->top_alpha : values[m->top_range];
}

/* The energy that leaves a Lambertian base of albedo rho. */
static inline double lq_material_base(const double *numbers, int colour, const lq_material *m, double rho) {
    const double through = numbers[LQ_MATERIAL_THROUGH + colour], back = numbers[LQ_MATERIAL_BACK + colour];
    return m->open_rho ? through * rho / (1.0 - rho * back) : through;
}

#endif
