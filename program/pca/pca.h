/* pca.h - what the parts of `lacquer pca` share. */
#ifndef LACQUER_PROGRAM_PCA_PCA_H
#define LACQUER_PROGRAM_PCA_PCA_H

#include "lacquer.h"
#include "program/verb.h"

/* The command line. */
typedef struct pca_request {
    const char *input, *output, *separate, *split, *bases, *channel, *against, *csv, *svg;
    cli_texts texels;
    bool nodes_only;
    size_t random; /* random nodes of an axis in the table of exact values */
    size_t seed;
    double budget; /* 0: none */
    size_t bytes;  /* 0: any */
    lq_pca_norm norm;
    size_t sweeps;
    lq_pca_options options;
    size_t threads; /* 0: one per core */
    lq_trust trust; /* which recorded NDF may be opened */
    char *command;
} pca_request;

/* Options that name axes of the table, once it is read. False: a line was printed. */
bool pca_resolve(pca_request *request, const lq_table *table, int *channel);

/* Where exact values come from: the solver at random points, another table, or the table's own nodes. */
typedef struct pca_exact {
    const pca_request *request;
    const lq_table *table, *against;
    const char *from; /* for messages */
    bool solver;
} pca_exact;

/* `against` may be NULL. A line on stderr where the solver cannot be asked; false where that is because the
 * NDF is not trusted. */
bool pca_exact_choose(pca_exact *exact, const pca_request *request, const lq_table *table,
                      const lq_table *against);
/* As lq_pca_goal wants it; `user` is a pca_exact. */
lq_status pca_exact_values(void *user, const double *min, const double *max, lq_table **values,
                           lq_error *error);

/* "beer tau,eta, bases 4+8, pairs 3": how a try was made. */
void pca_describe(const lq_table *table, const lq_pca_options *options, char *text, size_t size);

/* The table of tries on stdout, and the files asked for. False: a line was printed. */
bool pca_report(const pca_request *request, const lq_table *table, const lq_pca_try *tries, size_t count,
                const pca_exact *exact);

#endif
