/* sweep_part.c - one value of a sweep: how it is solved, kept and read again. */
#include "precompute/sweep_state.h"

#include "system/status.h"

#include <stdlib.h>
#include <string.h>

/* A node of the table is kept as the table has it. */
bool lq_sweep_is_node(const lq_sweep *s, size_t value) {
    return s->along.node[value] < s->along.size;
}

static size_t number_size(const lq_sweep *s, size_t value) {
    return lq_sweep_is_node(s, value) ? sizeof(float) : sizeof(double);
}

/* Values that were solved in place of numbers of a part: floats need half the room. */
static void narrow(void *bytes, size_t count) {
    const double *from = bytes;
    float *to = bytes;
    for (size_t i = 0; i < count; i++) {
        const float value = (float)from[i];
        memcpy(&to[i], &value, sizeof value);
    }
}

lq_status lq_sweep_make_part(void *user, size_t value, int thread, void **bytes, size_t *size,
                             lq_error *error) {
    (void)thread;
    const lq_sweep *s = user;
    const size_t count = (size_t)s->job.kind->channel_count * s->entries;
    double *part = malloc((1 + count) * sizeof *part), *values[LQ_MAX_CHANNELS];
    *bytes = part;
    if (!part) return lq_fail(error, LQ_NO_MEMORY, "no memory for a slice of %zu entries", s->entries);
    for (size_t c = 0; c < (size_t)s->job.kind->channel_count; c++) values[c] = part + 1 + c * s->entries;
    lq_status status = lq_job_prepare(&s->job, s->evaluator, value, error);
    if (status == LQ_OK) status = s->evaluator->slice(&s->job, s->state, value, values, part, error);
    if (status == LQ_OK && lq_sweep_is_node(s, value)) narrow(part + 1, count);
    *size = sizeof *part + count * number_size(s, value);
    return status;
}

lq_status lq_sweep_read(const lq_sweep *s, size_t value, size_t channel, size_t from, size_t to,
                        double *values, lq_error *error) {
    const size_t part = s->along.same[value], size = number_size(s, part), count = to - from;
    char *bytes = (char *)values + (sizeof(double) - size) * count;
    const lq_status status = lq_parts_read(
        s->parts, part, sizeof(double) + (channel * s->entries + from) * size, count * size, bytes, error);
    for (size_t i = 0; size < sizeof(double) && i < count; i++) {
        float narrow;
        memcpy(&narrow, bytes + i * sizeof narrow, sizeof narrow);
        values[i] = (double)narrow;
    }
    return status;
}
