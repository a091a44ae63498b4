/* exact.c - exact values for the errors of `lacquer pca`: the solver at random points. */
#include "pca/measure.h"
#include "program/message.h"
#include "program/pca/pca.h"
#include "system/status.h"
#include "tables/origin.h"

bool pca_exact_choose(pca_exact *exact, const pca_request *request, const lq_table *table,
                      const lq_table *against) {
    lq_origin origin;
    lq_error error = {""};
    *exact = (pca_exact){request, table, against, "the table's own nodes", false};
    if (against) {
        exact->from = request->against;
    } else if (!request->nodes_only) {
        const lq_status status = lq_origin_of(table, &request->trust, &origin, &error);
        exact->solver = status == LQ_OK;
        if (status == LQ_BAD_INPUT)
            return cli_message("%s: %s; or --nodes-only", request->input, error.text), false;
        if (exact->solver) exact->from = "the solver at random points";
        else cli_message("errors are at the table's own nodes only: %s", error.text);
    }
    return true;
}

static lq_status solve(const pca_exact *exact, const double *min, const double *max, lq_table **values,
                       lq_error *error) {
    lq_origin origin;
    lq_axis axes[LQ_MAX_AXES] = {0};
    lq_status status = lq_origin_of(exact->table, &exact->request->trust, &origin, error);
    if (status == LQ_OK)
        status = lq_random_axes(exact->table->axes, exact->table->axis_count, min, max,
                                exact->request->random, exact->request->seed, axes, error);
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
