/* A certificate for machines and for readers: JSON, JUnit XML, and a web page. */
#ifndef LACQUER_VALIDATE_REPORT_H
#define LACQUER_VALIDATE_REPORT_H

#include "validate/certificate_checks.h"

/* *text is to be freed. */
lq_status lq_report_json(const lq_certified *list, size_t count, char **text, lq_error *error);
/* One test case a judgement; files appear whole or not at all. */
lq_status lq_report_junit(const lq_certified *list, size_t count, const char *path, lq_error *error);
/* folder/index.html, a page that needs no other file; the folder is made where it does not exist. */
lq_status lq_report_html(const lq_certified *list, size_t count, const char *folder, lq_error *error);

#endif
