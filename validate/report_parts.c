/* report_parts.c - the smallest pieces of a certificate's page. */
#include "validate/report_parts.h"

const char *lq_report_word(lq_outcome outcome) {
    return outcome == LQ_PASSED ? "passed" : outcome == LQ_FAILED ? "failed" : "noted";
}

const double *lq_report_worst(const lq_sampled *c) {
    const size_t axes = (size_t)c->request.kind->axis_count;
    return c->found.error >= c->total.max ? c->found.at : c->at + c->total.worst % c->points * axes;
}
