/* verb_pca_exact.c - exact values for the errors of `lacquer pca`: the solver at random points. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "cli/message.h"
#include "pca/measure.h"
#include "pca/verb_pca.h"
#include "tables/origin.h"
#include "tables/status.h"

void pca_exact_choose(pca_exact *exact, const pca_request *request, const lq_table *table,
                      const lq_table *against) {
    lq_origin origin;
    lq_error error = {""};
    *exact = (pca_exact){request, table, against, "the table's own nodes", false};
    if (against) {
        exact->from = request->against;
    } else if (!request->nodes_only) {
        exact->solver = lq_origin_of(table, &origin, &error) == LQ_OK;
        if (exact->solver) exact->from = "the solver at random points";
        else cli_message("errors are at the table's own nodes only: %s", error.text);
    }
}

/* In [0,1), the same for the same seed, axis and place: splitmix64 (Steele et al. 2014). */
static double uniform(uint64_t seed, uint64_t axis, uint64_t i) {
    uint64_t z = (seed * 64 + axis) * 0x100000001b3u + i * 0x9e3779b97f4a7c15u + 0x243f6a8885a308d3u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* Random nodes, one in each of `count` equal parts of the index of the axis inside the box: where its nodes
 * are dense there are more, as many as there is to get wrong. */
static lq_status random_axis(const lq_axis *axis, double min, double max, size_t count, uint64_t seed,
                             uint64_t a, lq_axis *made, lq_error *error) {
    double nodes[256];
    const double first = lq_axis_locate(axis, min), last = lq_axis_locate(axis, max);
    if (axis->size == 1 || !(max > min))
        return lq_axis_make(made, axis->name, min, min, 1, LQ_MAP_LINEAR, 1.0, error);
    for (size_t i = 0; i < count; i++) {
        const double index = first + (last - first) * ((double)i + uniform(seed, a, i)) / (double)count;
        const size_t below = index >= (double)(axis->size - 1) ? axis->size - 2 : (size_t)index;
        nodes[i] =
            axis->nodes[below] + (index - (double)below) * (axis->nodes[below + 1] - axis->nodes[below]);
    }
    return lq_axis_make_custom(made, axis->name, nodes, count, error);
}

/* A solve serves every cosine and every tau (every n and kappa): more of those cost little. */
static size_t nodes_of(const pca_request *request, const char *name) {
    const bool solved_for = strcmp(name, "alpha") == 0 || strcmp(name, "eta") == 0;
    return solved_for ? request->random : 2 * request->random;
}

static lq_status solve(const pca_exact *exact, const double *min, const double *max, lq_table **values,
                       lq_error *error) {
    lq_origin origin;
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_status status = lq_origin_of(exact->table, &origin, error);
    for (int a = 0; a < exact->table->axis_count && status == LQ_OK; a++)
        status = random_axis(&exact->table->axes[a], min[a], max[a],
                             nodes_of(exact->request, exact->table->axes[a].name), exact->request->seed,
                             (uint64_t)a, &axes[a], error);
    if (status == LQ_OK) {
        origin.settings.threads = (int)exact->request->threads;
        status = lq_precompute(origin.kind, &origin.settings, axes, NULL, values, error);
    }
    for (int a = 0; a < exact->table->axis_count; a++) lq_axis_free(&axes[a]);
    if (status != LQ_NOT_CONVERGED) return status;
    const char *estimate = lq_table_fact(*values, "error");
    cli_message("the exact values have an error estimate of %s", estimate ? estimate : "unknown");
    return LQ_OK; /* they still are the best there are */
}

lq_status pca_exact_values(void *user, const double *min, const double *max, lq_table **values,
                           lq_error *error) {
    const pca_exact *exact = user;
    if (exact->solver) return solve(exact, min, max, values, error);
    return lq_nodes_within(exact->against ? exact->against : exact->table, min, max, values, error);
}
