/* sweep_rows.c - rows of a table from the parts of its sweep. */
#include "precompute/sweep_state.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A row range, and what it needs: of every value of `along` that its nodes are made of, the same positions.
 */
typedef struct reading {
    const lq_sweep *sweep;
    size_t begin, end; /* entries of the table */
    size_t from, to;   /* positions in a slice */
    double **loaded;   /* of each value: channel after channel; NULL: not wanted so far */
    double *sum;       /* of one run */
} reading;

static size_t channels_of(const lq_sweep *s) {
    return (size_t)s->shape->channel_count;
}

static lq_status load(const reading *r, size_t value, lq_error *error) {
    const size_t count = r->to - r->from;
    if (r->loaded[value]) return LQ_OK;
    r->loaded[value] = malloc(channels_of(r->sweep) * count * sizeof(double));
    if (!r->loaded[value]) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", count);
    lq_status status = LQ_OK;
    for (size_t c = 0; status == LQ_OK && c < channels_of(r->sweep); c++)
        status = lq_sweep_read(r->sweep, value, c, r->from, r->to, r->loaded[value] + c * count, error);
    return status;
}

/* Entries at one node that lie side by side, from position `at` of a slice on. */
static lq_status read_run(const reading *r, size_t node, size_t at, size_t count, size_t place,
                          float *const *channels, lq_error *error) {
    const lq_sweep *s = r->sweep;
    double weight[LQ_ALONG_POINTS];
    size_t first;
    const size_t points = lq_along_weights(&s->along, node, &first, weight);
    lq_status status = LQ_OK;
    for (size_t k = 0; status == LQ_OK && k < points; k++) status = load(r, first + k, error);
    for (size_t c = 0; status == LQ_OK && c < channels_of(s); c++) {
        const size_t offset = c * (r->to - r->from) + at - r->from;
        memset(r->sum, 0, count * sizeof *r->sum);
        for (size_t k = 0; k < points; k++)
            for (size_t i = 0; i < count; i++) r->sum[i] += weight[k] * r->loaded[first + k][offset + i];
        const bool is_part = s->along.node[first] == node;
        for (size_t i = 0; i < count && !is_part; i++)
            r->sum[i] = fmin(fmax(r->sum[i], s->job.kind->value_min), s->job.kind->value_max);
        for (size_t i = 0; i < count; i++) channels[c][place + i] = (float)r->sum[i];
    }
    return status;
}

static lq_status read_runs(const reading *r, float *const *channels, lq_error *error) {
    const size_t inner = r->sweep->inner, nodes = r->sweep->along.size;
    lq_status status = LQ_OK;
    for (size_t e = r->begin, count; status == LQ_OK && e < r->end; e += count) {
        const size_t within = e % inner, node = e / inner % nodes, outer = e / inner / nodes;
        count = inner - within < r->end - e ? inner - within : r->end - e;
        status = read_run(r, node, outer * inner + within, count, e - r->begin, channels, error);
    }
    return status;
}

lq_status lq_sweep_read_rows(void *user, size_t first, size_t count, float *const *channels,
                             lq_error *error) {
    const lq_sweep *s = user;
    const size_t width = s->shape->axes[0].size, whole = s->inner * s->along.size;
    reading r = {.sweep = s, .begin = first * width, .end = (first + count) * width};
    r.from = r.begin / whole * s->inner;
    r.to = ((r.end - 1) / whole + 1) * s->inner;
    r.loaded = calloc(s->along.count, sizeof *r.loaded);
    r.sum = malloc(s->inner * sizeof *r.sum);
    const lq_status status = r.loaded && r.sum
                                 ? read_runs(&r, channels, error)
                                 : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu rows", count);
    for (size_t v = 0; r.loaded && v < s->along.count; v++) free(r.loaded[v]);
    free((void *)r.loaded);
    free(r.sum);
    return status;
}
