/* validate.h - what the parts of `lacquer validate` share: the request, the lists it compares. */
#ifndef LACQUER_PROGRAM_VALIDATE_VALIDATE_H
#define LACQUER_PROGRAM_VALIDATE_VALIDATE_H

#include "program/light.h"
#include "program/options.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/validate/certify.h"
#include "tables/origin.h"
#include "validate/compare.h"
#include "validate/draw.h"
#include "validate/entries.h"

#include <stdbool.h>

typedef struct validate_request {
    const char *file;
    bool walk, json;
    size_t samples, points, seed;
    double budget; /* 0: none */
    size_t threads;
    int format; /* of the option: text, json */
    /* Another table: --against OTHER, or FILE itself where it is a published one (other NULL, layout >= 0).
     */
    const char *other, *kind;
    int layout; /* of OTHER, or of FILE where there is none; -1: EXR */
    cli_settings settings;
    lq_trust trust;  /* which recorded NDFs may be opened: --ndf, --allow-plugin */
    cli_given given; /* the options, as the command gave them */
    bool points_given;
    certify_request certify;
    const char *axes;         /* a JSON text that says what FILE, of anybody's, is */
    bool diagnose;            /* FILE of this program, all of it, by the same report */
    const char *stack;        /* the description of one, against walks; `file` is the word "stack" */
    cli_light light;          /* what meets it */
    const char *slices;       /* folder for what walks through it leave, by direction */
    const char *set, *models; /* of `validate layered`; NULL: ba19, all models */
    const char *tables;       /* a pack, for its models that take one */
} validate_request;

/* The lists, in the order they are reported. */
enum { STORED_EXACT, BETWEEN_EXACT, STORED_WALK, BETWEEN_WALK, VALIDATE_LISTS };

/* One list: `channels` comparisons at each of its points, point by point. */
typedef struct validate_list {
    const char *key, *title;
    const lq_drawn *at;
    lq_compared *compared;
    size_t count;
    lq_comparison result;
    bool used, judged; /* judged: its scores decide; otherwise only the budget does */
} validate_list;

typedef struct validate_job {
    validate_request request;
    lq_table *table;
    lq_origin origin;
    int walk_threads;
    size_t channels, stored, between; /* points of either sort */
    lq_entries entries;               /* what all of them show without a solver */
    size_t suspects;                  /* entries that stick out of their neighbours, compared besides */
    char fault[256];                  /* the entry that is wrong; "": none */
    lq_drawn *at;                     /* the stored ones, then those between */
    validate_list lists[VALIDATE_LISTS];
} validate_job;

/* Read a table of this program and what made it. */
lq_status validate_load_file(const char *path, const lq_trust *trust, lq_table **table, lq_origin *origin,
                             lq_error *error);

/* The whole of `validate --against OTHER`; returns the exit code. */
int validate_against(const validate_request *request);

/* The whole of `validate hard-cases`; returns the exit code. */
int validate_hard_cases(const validate_request *request);

/* The stack of the request, whose tolerance is one that stacks accept. */
lq_status validate_stack_open(const validate_request *request, lq_stack **stack, lq_error *error);

/* The whole of `validate stack FILE.json`; returns the exit code. */
int validate_stack(const validate_request *request);

/* The whole of `validate stack FILE.json --slices DIR`; returns the exit code. */
int validate_slices(const validate_request *request);

/* The whole of `validate layered`; returns the exit code. */
int validate_layered(const validate_request *request);

/* Draw the points, compute everything at each and reduce the lists. */
lq_status validate_measure(validate_job *job, const lq_progress *progress, lq_error *error);
void validate_free(validate_job *job);

/* What is wrong, in a few words; NULL: nothing. */
const char *validate_complaint(const validate_job *job);

void validate_print_text(const validate_job *job);
/* False where the file's name or facts are not UTF-8, which JSON needs. */
bool validate_print_json(const validate_job *job);

#endif
