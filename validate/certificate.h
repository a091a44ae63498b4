/* Certificates: how far what a renderer decodes is from the exact solver, anywhere in a domain, and how sure
 * that is.
 *
 * A decoder is any function of a point; a chain of them, each one step nearer to what a GPU does, divides the
 * error: the difference of two in a row, at the same points, is the part of that step. The last is judged.
 */
#ifndef LACQUER_VALIDATE_CERTIFICATE_H
#define LACQUER_VALIDATE_CERTIFICATE_H

#include "validate/certificate_blocks.h"

enum { LQ_STAGES_MAX = 6, LQ_STARTS_MAX = 16 };

/* Called from several threads at once. */
typedef double lq_decode(const void *subject, int channel, const double *point);

typedef struct lq_stage {
    const char *name; /* "table", "factors", "gpu" */
    const char *part; /* what its difference to the stage before (the first: to the solver) is: "filter" */
    lq_decode *decode;
    const void *subject;
} lq_stage;

typedef struct lq_sample_request {
    const lq_kind *kind;
    lq_settings settings;  /* of the exact values */
    const lq_curve *curve; /* of a mapping (pack/mapping.h): what its values are computed from */
    bool relative; /* errors are, of the exact value: decoded values and exact ones are divided by it */
    lq_domain domain;
    lq_stage stages[LQ_STAGES_MAX];
    int stage_count;
    size_t points; /* at least so many exact values */
    size_t starts; /* of the directed search, at most LQ_STARTS_MAX */
    uint64_t seed;
    int threads; /* 0: one per core; results do not depend on it */
} lq_sample_request;

/* Errors over the points: d = decoded - exact, or the part of one stage. */
typedef struct lq_figures {
    double bias, mean, rms, p99, max; /* of d, |d|, d^2, |d|, |d| */
    size_t worst;                     /* the point of max */
    double effective;                 /* independent points that would give p99 as well */
    double p99_limit; /* p99 of the domain is below, with LQ_CONFIDENCE; INFINITY: not known */
} lq_figures;

/* The largest error a search found, started at the worst points. */
typedef struct lq_found {
    double at[LQ_MAX_AXES];
    int channel;
    double decoded, exact, error; /* error = |decoded - exact| */
    size_t evaluations;           /* exact values the search took */
} lq_found;

typedef struct lq_sampled {
    lq_sample_request request;
    lq_block_plan plan;
    size_t points;
    double *at;                                       /* [i * axis_count + a] */
    double *exact;                                    /* [channel * points + i] */
    double *decoded[LQ_STAGES_MAX];                   /* likewise */
    double estimate;                                  /* largest error estimate of the exact values */
    lq_figures error[LQ_STAGES_MAX][LQ_MAX_CHANNELS]; /* of each stage against the solver */
    lq_figures part[LQ_STAGES_MAX][LQ_MAX_CHANNELS];  /* against the stage before */
    lq_figures total; /* of the last stage, over all channels; `worst` counts as in exact */
    double unseen;    /* with LQ_CONFIDENCE no larger share of the domain is off by more than total.max */
    lq_found found;
    double max; /* the larger of total.max and found.error */
} lq_sampled;

/* Free it in every case. */
lq_status lq_sample(const lq_sample_request *request, const lq_progress *progress, lq_sampled *certificate,
                    lq_error *error);
void lq_sampled_free(lq_sampled *certificate);

/* The directed search alone: fills `found`. */
lq_status lq_sampled_search(lq_sampled *certificate, lq_error *error);

/* Decoders: a stored table between its nodes, factors in double, and a texture and factors as a GPU filters
 * them. */
double lq_decode_table(const void *table, int channel, const double *point);
double lq_decode_factored(const void *factored, int channel, const double *point);
double lq_decode_texture(const void *texture, int channel, const double *point);
double lq_decode_gpu(const void *factored, int channel, const double *point);

#endif
