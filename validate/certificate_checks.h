/* The judgements of a certificate: each one line with a value, its limit and where, passed or failed. */
#ifndef LACQUER_VALIDATE_CERTIFICATE_CHECKS_H
#define LACQUER_VALIDATE_CERTIFICATE_CHECKS_H

#include "validate/certificate_budget.h"
#include "validate/certificate_subject.h"

/* The stored entries against the solver at a tenth of their tolerance; the entry that is furthest out counts
 * for `max`. count 0: there is no stored table. */
typedef struct lq_integration {
    size_t count;
    double max, rms;
} lq_integration;

/* One table with its certificate and everything judged. */
typedef struct lq_certified {
    lq_subject subject;
    lq_budget budget;
    lq_sampled certificate;
    lq_integration integration;
    int check_count, check_room;
    lq_check *checks;
    bool check_lost; /* there was no memory for one: the certificate has failed */
} lq_certified;

/* Adds one: failed where value > limit or NaN, noted where limit is NaN. `format` makes the detail; may be
 * NULL. */
void lq_check_add(lq_certified *certified, const char *name, double value, double limit, const char *format,
                  ...) __attribute__((format(printf, 5, 6)));

/* "mu=0.1 alpha=0.5" of a point, into `text`. */
void lq_point_text(const lq_kind *kind, const double *point, char *text, size_t size);

/* Stands for the judgements that could not be kept. */
extern const lq_check lq_check_lost;

/* The first failed check, or NULL. A judgement that could not be kept has failed. */
const lq_check *lq_certified_failure(const lq_certified *certified);

/* What a whole certificate is made of. */
typedef struct lq_judging {
    lq_rule rule;     /* budget and domain */
    size_t points;    /* 0: LQ_CERTIFICATE_POINTS, or fewer where every value costs a solve */
    double tolerance; /* of the exact values; 0: that of the kind */
    uint64_t seed;
    int threads;
} lq_judging;

enum { LQ_CERTIFICATE_POINTS = 100000, LQ_CERTIFICATE_SOLVES = 1024, LQ_CERTIFICATE_STARTS = 4 };

/* Sample, search and judge the subject that is in `certified`. */
lq_status lq_certified_make(lq_certified *certified, const lq_judging *options, const lq_progress *progress,
                            lq_error *error);
void lq_certified_free(lq_certified *certified);

/* Parts of the above, each in a file of its own. */
void lq_check_budget(lq_certified *certified);
void lq_check_physics(lq_certified *certified);
lq_status lq_check_stored(lq_certified *certified, lq_error *error);
/* Only where something failed: what it looks like. */
void lq_check_sampling(lq_certified *certified);
lq_status lq_check_definition(lq_certified *certified, lq_error *error);
lq_status lq_check_texels(lq_certified *certified, lq_error *error);
lq_status lq_check_bands(lq_certified *certified, lq_error *error);

#endif
