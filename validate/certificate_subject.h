/* What a certificate is made for: a stored table, or factors, with what made them and how they are decoded.
 */
#ifndef LACQUER_VALIDATE_CERTIFICATE_SUBJECT_H
#define LACQUER_VALIDATE_CERTIFICATE_SUBJECT_H

#include "pack/read.h"
#include "tables/origin.h"
#include "validate/certificate.h"

typedef struct lq_subject {
    char name[256];
    lq_table *table;        /* the stored table; beside factors, the one they were made from, or NULL */
    lq_factored *factored;  /* or NULL */
    lq_factored *unrounded; /* the factors with every texel moved at random within what rounds to its half */
    lq_origin origin;
    /* Of a pack: */
    lq_texture texture;        /* that holds the table in halves; no axes: it is in floats */
    lq_table *unrounded_table; /* the table, its entries moved likewise */
    lq_curve *curve;           /* of a mapping */
    bool relative;             /* its errors are */
    size_t files, altered;     /* files read, those that are not as the manifest says */
    size_t differing;          /* texels that are not the same in all of them */
    char suspect[128];         /* the first such file */
} lq_subject;

/* A table or a factor file, whichever it is. Free it in every case. */
lq_status lq_subject_read(lq_subject *subject, const char *path, const lq_trust *trust, lq_error *error);
/* A table of a pack, whose contents it takes over. */
lq_status lq_subject_ship(lq_subject *subject, lq_shipped *shipped, const lq_trust *trust, lq_error *error);
/* Compute the table anew that the factors of a pack were made from, over these axes. */
lq_status lq_subject_make_table(lq_subject *subject, const lq_axis *axes, const lq_progress *progress,
                                lq_error *error);
/* The table that the factors were made from: its interpolation becomes a part of its own. */
lq_status lq_subject_add_table(lq_subject *subject, const char *path, const lq_trust *trust, lq_error *error);
void lq_subject_free(lq_subject *subject);

/* The whole of its axes. */
lq_domain lq_subject_domain(const lq_subject *subject);

/* The chain of decoders; returns their number. */
int lq_subject_stages(const lq_subject *subject, lq_stage *stages);

#endif
