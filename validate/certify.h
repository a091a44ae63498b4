/* certify.h - the certificates of whatever is at a path: a table, factors, a folder of them, a pack. */
#ifndef LACQUER_VALIDATE_CERTIFY_H
#define LACQUER_VALIDATE_CERTIFY_H

#include "system/watch.h"
#include "validate/certificate_material.h"

/* lq_certify_options, read. */
typedef struct lq_certifying {
    lq_budgets budgets;
    bool has_budget; /* otherwise a pack's own holds */
    lq_rule domain;  /* its ranges go before those of the budgets */
    const char *table;
    bool parts;
    size_t points;
    double tolerance;
    uint64_t seed;
    int threads;
    lq_trust trust;
    lq_watch watch;
} lq_certifying;

struct lq_certificates {
    char name[256]; /* of the file, folder or pack */
    size_t count, material_count;
    lq_certified *tables;
    lq_certified_material *materials;
};

/* As lq_certify, of options that were read. What is in `made` on failure is valid as well. */
lq_status lq_certify_read(const lq_certifying *asked, const char *path, lq_certificates **made,
                          lq_error *error);

/* The materials of a pack, against its budgets or those asked for. */
lq_status lq_certify_materials(const lq_certifying *asked, const lq_pack *pack, lq_certificates *made,
                               lq_error *error);

#endif
