/* model_tables.h - what the statistical model takes from tables, computed exactly: its interfaces, a share of
 * total reflection, a coated Lambertian base. */
#ifndef LACQUER_STACK_MODEL_TABLES_H
#define LACQUER_STACK_MODEL_TABLES_H

#include "stack/adding.h"
#include "stack/model_mapping.h"

/* The paper, or its released implementation where that departs from it (model.h). */
typedef enum lq_model_variant { LQ_MODEL_PAPER, LQ_MODEL_RELEASED } lq_model_variant;

/* Light on its way down one channel's layers. */
typedef struct lq_model_ray {
    double cosine,
        index; /* of the mean direction, and of the medium it is in; cosine 0: it goes no further */
} lq_model_ray;

/* Values looked up, for the channels of a stack, which share most of them. */
typedef struct lq_model_memo {
    size_t count;
    struct {
        const char *kind;
        double point[4], values[2];
    } entry[32]; /* those of more than 32 are looked up again */
} lq_model_memo;

/* Where values come from other than lq_eval: `value` is called by several threads. */
typedef struct lq_model_source {
    void *user;
    lq_status (*value)(void *user, const lq_kind *kind, const double *point, double *values, lq_error *error);
} lq_model_source;

typedef struct lq_model_tables {
    lq_model_variant variant;
    const lq_model_mapping *mapping;
    double tolerance;              /* of a table; 0: what its kind has */
    lq_model_memo *memo;           /* of this thread; NULL: none */
    const lq_model_source *source; /* NULL: exact */
} lq_model_tables;

/* The roughness at which FGD and TIR are looked up: the interface's own, or (released) that of all light that
 * meets it, whose variance on the way down is `arriving`. */
double lq_model_lookup_alpha(const lq_model_tables *tables, double arriving, double alpha);

/* The share of 1 - F over the lobe of a base, in a medium below one of index `above`: tir-pass. */
lq_status lq_model_pass(const lq_model_tables *tables, lq_model_ray ray, double above, double looked_up,
                        double *pass, lq_error *error);

/* A dielectric into index n; *ray goes on below it. Light that cannot refract there (Snell) leaves no mean
 * direction: t12 is 0 then, as released, and what passes all the same by its facets is lost. */
lq_status lq_model_dielectric(const lq_model_tables *tables, lq_model_ray *ray, double n, double alpha,
                              double looked_up, lq_model_interface *interface, lq_error *error);
lq_status lq_model_conductor(const lq_model_tables *tables, lq_model_ray ray, double n, double kappa,
                             double alpha, double looked_up, lq_model_interface *interface, lq_error *error);

/* How far an interface of roughness `alpha` spreads light: what it reflects, and what it lets down and up,
 * between a ray above it and the refracted one below. */
typedef struct lq_model_spread {
    double reflected, down, up;
} lq_model_spread;
lq_model_spread lq_model_spread_of(const lq_model_tables *tables, double alpha, lq_model_ray above,
                                   lq_model_ray below);

/* One crossing of a medium at a cosine. */
lq_flow lq_model_medium(const lq_model_tables *tables, const lq_medium *medium, int channel, double cosine);

/* The lobe of a Lambertian base below one coat, D22 eq. 3: T01 rho / (1 - rho R10) T10, about the normal.
 * `energy` and `alpha`: of its roughness (D22 sec. 3.3). */
typedef struct lq_model_coat {
    double mu, eta, alpha, tau, rho;
} lq_model_coat;
lq_status lq_model_diffuse(const lq_model_tables *tables, const lq_model_coat *coat, double *energy,
                           double *alpha, lq_error *error);

#endif
