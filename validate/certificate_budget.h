/* Error budgets: one a table and norm, from the command line or from a file, and the domain they hold on. */
#ifndef LACQUER_VALIDATE_CERTIFICATE_BUDGET_H
#define LACQUER_VALIDATE_CERTIFICATE_BUDGET_H

#include "validate/certificate_blocks.h"

typedef enum lq_norm { LQ_NORM_MAX, LQ_NORM_P99, LQ_NORM_RMS, LQ_NORM_MEAN, LQ_NORMS } lq_norm;

const char *lq_norm_name(lq_norm norm);

/* A bound for each norm; 0: none. */
typedef struct lq_budget {
    double bound[LQ_NORMS];
} lq_budget;

/* "mu=0.02:1": the part of one axis that counts. */
typedef struct lq_range {
    char axis[LQ_NAME_SIZE];
    double min, max;
} lq_range;

typedef struct lq_rule {
    char table[LQ_NAME_SIZE]; /* a kind or the name of a table in a pack; "": any other */
    lq_budget budget;
    int range_count;
    lq_range ranges[LQ_MAX_AXES];
} lq_rule;

enum { LQ_RULES_MAX = 64 };

/* Rule 0 is for any table that has none of its own. */
typedef struct lq_budgets {
    int count;
    lq_rule rules[LQ_RULES_MAX];
} lq_budgets;

/* "max=1e-2,p99=2e-3", or a single number for max. */
lq_status lq_budget_parse(lq_budget *budget, const char *text, lq_error *error);
/* "mu=0.02:1,tau=0.02:1" into a rule. */
lq_status lq_ranges_parse(lq_rule *rule, const char *text, lq_error *error);

/* A budget file, JSON:
 *   {"max": 1e-2, "p99": 2e-3, "on": {"mu": [0.02, 1]}, "tables": {"transmission": {"max": 5e-3}}}
 * What a table does not set it takes from the top. */
lq_status lq_budgets_read(lq_budgets *budgets, const char *path, lq_error *error);

/* The rule named `name`, else that of `kind`, else rule 0. */
const lq_rule *lq_budgets_rule(const lq_budgets *budgets, const char *name, const char *kind);

/* Cut the domain to the ranges of a rule whose axes the kind has. */
lq_status lq_domain_cut(lq_domain *domain, const lq_kind *kind, const lq_rule *rule, lq_error *error);

#endif
