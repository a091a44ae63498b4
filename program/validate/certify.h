/* certify.h - `lacquer validate` with a certificate: its options, and what its parts share. */
#ifndef LACQUER_PROGRAM_VALIDATE_CERTIFY_H
#define LACQUER_PROGRAM_VALIDATE_CERTIFY_H

#include "program/verb.h"
#include "validate/certify.h"

enum {
    CERTIFY_FIRST = 300,
    CERTIFY_CERTIFICATE = CERTIFY_FIRST,
    CERTIFY_ON,
    CERTIFY_TABLE,
    CERTIFY_JUNIT,
    CERTIFY_REPORT,
    CERTIFY_PARTS,
    CERTIFY_LAST = CERTIFY_PARTS
};

/* Rows for the option list of the verb, in whose mode CERTIFIED they mean something. */
#define CERTIFY_OPTIONS                                                                                      \
    {CERTIFY_CERTIFICATE,                                                                                    \
     "certificate",                                                                                          \
     NULL,                                                                                                   \
     "certify: 100000 points against the solver, worst point, error parts, physics",                         \
     CLI_FLAG(validate_request, certify.wanted),                                                             \
     .modes = CERTIFIED},                                                                                    \
        {CERTIFY_ON,                                                                                         \
         "on",                                                                                               \
         "A=MIN:MAX,...",                                                                                    \
         "certify this part of the axes only (default: all of them)",                                        \
         CLI_READ(validate_request, certify, read_domain),                                                   \
         .modes = CERTIFIED},                                                                                \
        {CERTIFY_TABLE,                                                                                      \
         "table",                                                                                            \
         "FILE",                                                                                             \
         "the table that a factor file was made from, for its error parts",                                  \
         CLI_TEXT(validate_request, certify.asked.table),                                                    \
         .modes = CERTIFIED},                                                                                \
        {CERTIFY_PARTS,                                                                                      \
         "parts",                                                                                            \
         NULL,                                                                                               \
         "of a pack: compute those tables anew, for all error parts",                                        \
         CLI_FLAG(validate_request, certify.asked.parts),                                                    \
         .modes = CERTIFIED},                                                                                \
        {CERTIFY_JUNIT,                                                                                      \
         "junit",                                                                                            \
         "FILE",                                                                                             \
         "write the certificate's judgements as JUnit XML",                                                  \
         CLI_TEXT(validate_request, certify.junit),                                                          \
         .modes = CERTIFIED},                                                                                \
    {                                                                                                        \
        CERTIFY_REPORT, "report", "DIR",                                                                     \
            "write a web page, DIR/index.html: of a certificate, of layered models",                         \
            CLI_TEXT(validate_request, certify.report), .modes = CERTIFIED | LAYERED                         \
    }

typedef struct certify_request {
    lq_trust trust; /* which recorded NDFs may be opened */
    bool wanted;    /* any of these options, or a budget by norm */
    const char *path;
    lq_certifying asked;
    const char *junit, *report;
    bool json;
} certify_request;

/* --on, and a --budget that is no plain number; false: a line was printed. */
bool certify_take_domain(certify_request *request, const char *value);
bool certify_take_budget(certify_request *request, const char *value);

/* Is this something that only a certificate can be made of? A folder. */
bool certify_takes_alone(const char *path);

/* The whole of it; returns the exit code. */
int validate_certify(const certify_request *request);

void certify_print_text(const lq_certified *certified);
/* A line each. */
void certify_print_materials(const lq_certificates *made);

#endif
