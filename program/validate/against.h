/* against.h - what `lacquer validate --against FILE` shares with its report. */
#ifndef LACQUER_PROGRAM_VALIDATE_AGAINST_H
#define LACQUER_PROGRAM_VALIDATE_AGAINST_H

#include "program/validate/validate.h"
#include "validate/pattern.h"
#include "validate/variants.h"

/* `other` is judged against `reference`: FILE itself where it has the same nodes, else what FILE says it is,
 * computed at the nodes of `other`. With --points only the drawn entries of both are filled in. */
typedef struct against_job {
    const validate_request *request;
    lq_table *file, *other, *computed; /* owned; file or computed may be NULL */
    const char *other_name;
    lq_origin origin;
    double allowance; /* of one difference, by what both files state */
    size_t entries;   /* compared, of each channel */
    bool patterned;   /* every entry was compared: neighbours are known */
    lq_compared worst_pair[LQ_MAX_CHANNELS];
    lq_comparison result[LQ_MAX_CHANNELS];
    lq_pattern pattern[LQ_MAX_CHANNELS];
    lq_drawn worst_at[LQ_MAX_CHANNELS];
    lq_variants variants; /* none where the two agree */
} against_job;

const char *against_complaint(const against_job *job);
void against_print_text(const against_job *job);
bool against_print_json(const against_job *job);

#endif
