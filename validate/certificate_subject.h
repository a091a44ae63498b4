/* What a certificate is made for: a stored table, or factors, with what made them and how they are decoded.
 */
#ifndef LACQUER_VALIDATE_CERTIFICATE_SUBJECT_H
#define LACQUER_VALIDATE_CERTIFICATE_SUBJECT_H

#include "validate/certificate.h"
#include "tables/origin.h"

typedef struct lq_subject {
    char name[256];
    lq_table *table;        /* the stored table; beside factors, the one they were made from, or NULL */
    lq_factored *factored;  /* or NULL */
    lq_factored *unrounded; /* the factors with every texel moved at random within what rounds to its half */
    lq_origin origin;
} lq_subject;

/* A table or a factor file, whichever it is. Free it in every case. */
lq_status lq_subject_read(lq_subject *subject, const char *path, lq_error *error);
/* The table that the factors were made from: its interpolation becomes a part of its own. */
lq_status lq_subject_add_table(lq_subject *subject, const char *path, lq_error *error);
void lq_subject_free(lq_subject *subject);

/* The whole of its axes. */
lq_domain lq_subject_domain(const lq_subject *subject);

/* The chain of decoders; returns their number. */
int lq_subject_stages(const lq_subject *subject, lq_stage *stages);

#endif
