/* A certificate for machines and for readers: JSON, JUnit XML, and a web page. */
#ifndef LACQUER_VALIDATE_REPORT_H
#define LACQUER_VALIDATE_REPORT_H

#include "validate/certificate_checks.h"
#include "validate/certificate_material.h"

typedef struct lq_report {
    const char *name; /* of the file, folder or pack */
    const char *date; /* "2026-11-26"; pages tell it, JSON and JUnit depend on what was certified alone */
    size_t count;
    const lq_certified *list;
    size_t material_count;
    const lq_certified_material *materials;
} lq_report;

/* How many of its tables and materials failed. */
size_t lq_report_failures(const lq_report *report);

/* *text is to be freed. */
lq_status lq_report_json(const lq_report *report, char **text, lq_error *error);
/* One test case a judgement; files appear whole or not at all. */
lq_status lq_report_junit(const lq_report *report, const char *path, lq_error *error);
/* folder/index.html, a page that needs no other file; the folder is made where it does not exist. */
lq_status lq_report_html(const lq_report *report, const char *folder, lq_error *error);

#endif
