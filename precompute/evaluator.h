/* How a table kind is computed: one evaluator an id, found by the sweep and by lq_eval.
 *
 * A kind is computed slice by slice along one axis (the roughness, as a rule), because a solve at one
 * roughness serves every value of the other axes. Slices are independent, so their results cannot depend on
 * how many threads share them.
 */
#ifndef LACQUER_PRECOMPUTE_EVALUATOR_H
#define LACQUER_PRECOMPUTE_EVALUATOR_H

#include "lacquer.h"
#include "microfacet/ndf.h"

/* What is to be computed: the settings with every default filled in, and the nodes of every axis. */
typedef struct lq_job {
    const lq_kind *kind;
    const lq_ndf *ndf;
    const lq_ndf *own; /* the same where the job opened it, otherwise NULL */
    lq_scattering scattering;
    lq_masking masking;
    double tolerance;
    size_t size[LQ_MAX_AXES];
    const double *nodes[LQ_MAX_AXES];
} lq_job;

typedef struct lq_evaluator {
    const char *id;
    int slice_axis;
    /* Of the series in the logarithm of the roughness (along.h): coefficient m is this times rho^-m and less.
     */
    double series_scale;
    /* Work that all slices share; *state is handed to the others. This and release are NULL where there is
     * none. */
    lq_status (*prepare)(const lq_job *job, void **state, lq_error *error);
    /* All values of slice `index`: values[channel] has the product of the other axes, first axis fastest.
     * *estimate is of the largest error among them. */
    lq_status (*slice)(const lq_job *job, const void *state, size_t index, double *const *values,
                       double *estimate, lq_error *error);
    void (*release)(void *state);
} lq_evaluator;

const lq_evaluator *lq_evaluator_find(const char *id);

/* Entries of one slice. */
size_t lq_slice_entries(const lq_job *job, const lq_evaluator *evaluator);

/* Fill a job and check it: settings the kind takes, a known NDF, a tolerance it reaches, nodes in range. */
lq_status lq_job_make(lq_job *job, const lq_kind *kind, const lq_settings *settings, const size_t *size,
                      const double *const *nodes, lq_error *error);
/* Only after a job that was made. */
void lq_job_free(lq_job *job);

/* What slice `index` of the roughness needs of the NDF, made where it can still fail. */
lq_status lq_job_prepare(const lq_job *job, const lq_evaluator *evaluator, size_t index, lq_error *error);

#endif
