/* The parametric families of the mappings: cheap in a shader, with their published constants where a paper
 * has them. Shared with C++. */
#ifndef LACQUER_FIT_FAMILY_H
#define LACQUER_FIT_FAMILY_H

#ifdef __cplusplus
extern "C" {
#endif

enum { LQ_FAMILY_PARAMETERS = 5, LQ_FAMILY_COORDINATES = 4 };

typedef enum lq_mapping {
    LQ_MAP_VARIANCE,
    LQ_MAP_HG,
    LQ_MAP_TRANSMISSION,
    LQ_MAP_TAIL,
    LQ_MAPPINGS
} lq_mapping;

enum {
    LQ_FAMILY_RATIONAL,
    LQ_FAMILY_EXPONENTIAL,
    LQ_FAMILY_PHASE,
    LQ_FAMILY_PHASE_EXPONENTIAL,
    LQ_FAMILY_SLOPE,
    LQ_FAMILY_POWERS,
    LQ_FAMILY_POWER,
    LQ_FAMILY_TAIL,
    LQ_FAMILIES
};

typedef struct lq_family {
    const char *name; /* what --family takes */
    lq_mapping mapping;
    const char *formula, *inverse; /* in plain text; inverse NULL: there is none in closed form */
    int coordinates, parameters;
    const char *names; /* of the parameters, a letter each */
    double start[LQ_FAMILY_PARAMETERS], low[LQ_FAMILY_PARAMETERS], high[LQ_FAMILY_PARAMETERS];
    const double *published; /* the paper's constants, or NULL */
    const char *source;
} lq_family;

const lq_family *lq_family_at(int family); /* NULL beyond the last */
/* The family of a mapping by name, or with NULL its default; -1 where there is none. */
int lq_family_find(lq_mapping mapping, const char *name);
const char *lq_mapping_name(lq_mapping mapping);

double lq_family_value(int family, const double *p, const double *x);
/* Of one coordinate; NaN where the family has no closed inverse. */
double lq_family_inverse(int family, const double *p, double value);

#ifdef __cplusplus
}
#endif
#endif
