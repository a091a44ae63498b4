/* layered.h - models of layered materials measured on a set of stacks: by slices against walks, by energies
 * and moments against the exact solver. docs/layered.md says how and what comes out.
 *
 * What is known of one stack is a JSON object of its own, which is kept with the settings that made it, so
 * that a report that was interrupted goes on where it was.
 */
#ifndef LACQUER_VALIDATE_LAYERED_H
#define LACQUER_VALIDATE_LAYERED_H

#include "stack/model_shape.h"
#include "system/json.h"
#include "validate/layered_set.h"

#include <stdint.h>

/* "b18-forward", and with what departs from its defaults: "+exact-first" or "+scaled-first" (the first lobe
 * is the top interface's BRDF, Ba19 eq. 6, or that with the model's energy); of the B18 models "+released",
 * "+fit" (B18's own f), "+masked" (lobes without their albedo), "+tables" (coefficients by a pack). */
typedef struct lq_layered_model {
    char label[64];
    lq_shape_query query;
    bool tables; /* `source` of the request, for computed ones */
} lq_layered_model;

enum { LQ_LAYERED_MODELS = 24 };

lq_status lq_layered_model_parse(lq_layered_model *model, const char *label, lq_error *error);

typedef struct lq_layered_request {
    const lq_layered_set *set;
    const lq_layered_model *models;
    size_t model_count;
    size_t samples;
    uint64_t seed;
    int threads;
    const char *folder;            /* of the report; with a folder "slices" */
    const lq_model_source *source; /* for models that take one; NULL: there is none */
    const char *source_sum;        /* which tables these are: text that changes with them */
} lq_layered_request;

/* What a stack's figures depend on. NULL: no memory. */
json_t *lq_layered_settings(const lq_layered_request *request, const lq_layered_stack *stack);

/* Figures of one stack, and its pictures as files. */
lq_status lq_layered_measure(const lq_layered_request *request, const lq_layered_stack *stack,
                             json_t **figures, const lq_progress *progress, lq_error *error);

/* From figures of all stacks, in the order of the set: figures.csv, figures.json and index.html. `figures`
 * is an array, which is freed. */
lq_status lq_layered_report(const lq_layered_request *request, json_t *figures, lq_error *error);

/* Whether a figures object is of these settings. */
bool lq_layered_fits(json_t *figures, const json_t *settings);

/* The picture of a slice below the report's folder; label NULL: as measured. */
void lq_layered_picture(char *path, size_t size, const char *set, const char *stack, double theta, int side,
                        const char *label);

#endif
