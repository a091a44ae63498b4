/* verb_pca.h - what the parts of `lacquer pca` share. */
#ifndef LQ_PCA_VERB_PCA_H
#define LQ_PCA_VERB_PCA_H

#include "cli/settings.h"
#include "lacquer.h"

typedef enum pca_norm { PCA_MAX, PCA_RMS, PCA_P99 } pca_norm;

/* The command line. */
typedef struct pca_request {
    const char *input, *output, *separate, *split, *bases, *channel, *against, *csv, *svg;
    const char *texels[LQ_MAX_AXES];
    int texel_count;
    bool nodes_only;
    size_t points; /* random points an axis that shares a solve */
    size_t seed;
    double budget; /* 0: none */
    size_t bytes;  /* 0: none */
    pca_norm norm;
    bool plain_given;
    lq_pca_options options;
    int threads;
} pca_request;

/* What was tried, in the order of bytes. */
typedef struct pca_try {
    lq_pca_options options;
    size_t bytes;
    lq_pca_errors errors;
} pca_try;

/* Options that name axes of the table, once it is read. False: a line was printed. */
bool pca_resolve(pca_request *request, const lq_table *table, int *channel);

/* Exact values at random points inside the table's range, or NULL and a reason where nothing computes them.
 */
lq_status pca_reference(const pca_request *request, const lq_table *table, lq_table **reference,
                        const char **why_not, lq_error *error);

#endif
