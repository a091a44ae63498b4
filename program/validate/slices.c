/* slices.c - `lacquer validate stack FILE --slices DIR`: walks counted in the cells of a virtual
 * goniophotometer, their energies against the exact solver, order by order. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "program/message.h"
#include "program/output.h"
#include "program/validate/validate.h"
#include "system/output.h"
#include "validate/slice_file.h"

static const char *const sides[LQ_GONIO_SIDES] = {"reflected", "transmitted"};
static const char *const orders[LQ_GONIO_ORDERS] = {"once", "twice", "more"};

typedef struct slice_row {
    double mu;
    int channel, side, order;
    lq_compared compared;
    double z;
} slice_row;

typedef struct slice_job {
    const validate_request *request;
    lq_stack *stack;
    char *text; /* of the stack */
    lq_stack_query query;
    int channels;
    lq_stack_light *exact; /* [(m * channels + c) * LQ_GONIO_ORDERS + order] */
    bool converged;
    size_t count;
    slice_row *rows;
    double worst, z_limit;
    size_t files;
} slice_job;

static lq_status prepare(slice_job *job, lq_error *error) {
    const validate_request *request = job->request;
    lq_status status = validate_stack_open(request, &job->stack, error);
    if (status == LQ_OK) status = lq_stack_text(job->stack, &job->text, error);
    if (status == LQ_OK) status = lq_output_folder(request->slices, error);
    if (status != LQ_OK) return status;
    job->query = cli_light_query(&request->light);
    job->query.tolerance = request->settings.settings.tolerance;
    job->query.threads = (int)request->threads;
    job->query.paths = LQ_GONIO_ORDERS;
    job->channels = lq_stack_channels(job->stack);
    const size_t lights = job->query.mu_count * (size_t)job->channels * LQ_GONIO_ORDERS;
    job->exact = calloc(lights, sizeof *job->exact);
    job->rows = calloc(lights * LQ_GONIO_SIDES, sizeof *job->rows);
    if (job->exact && job->rows) return LQ_OK;
    snprintf(error->text, sizeof error->text, "out of memory");
    return LQ_NO_MEMORY;
}

/* ======================================================================================
 *                                       Numbers
 * ====================================================================================== */

/* As validate_stack has it: what fewer than a few rays met is missing from their standard error. */
static void compare(slice_job *job, const lq_gonio *g, size_t m) {
    for (int side = 0; side < g->sides; side++)
        for (int c = 0; c < g->channels; c++)
            for (int order = 0; order < LQ_GONIO_ORDERS; order++) {
                const lq_stack_light *exact =
                    &job->exact[(m * (size_t)g->channels + (size_t)c) * LQ_GONIO_ORDERS + (size_t)order];
                const lq_gonio_part part = {side, order, order, c};
                slice_row row = {.mu = g->mu, .channel = c, .side = side, .order = order};
                row.compared.value = side ? exact->transmitted.energy : exact->reflected.energy;
                row.compared.reference = lq_gonio_energy(g, LQ_SLICE_CLASSIC, &part, &row.compared.noise);
                row.compared.noise = hypot(row.compared.noise, 3.0 / (double)g->samples);
                row.compared.allowance = exact->error + lq_gonio_lost(g);
                row.z = lq_compared_score(&row.compared);
                job->worst = fmax(job->worst, fabs(row.z));
                job->rows[job->count++] = row;
            }
}

static lq_status write_slice(slice_job *job, const lq_gonio *g, int side, lq_slice_layout layout,
                             lq_error *error) {
    const validate_request *request = job->request;
    const lq_slice_label label = {.name = job->stack->name[0] ? job->stack->name : "stack",
                                  .stack = job->text,
                                  .interfaces = cli_interfaces[request->light.interfaces],
                                  .from = cli_sides[request->light.from],
                                  .seed = request->seed,
                                  .side = side,
                                  .layout = layout};
    char path[4096];
    const int length = snprintf(path, sizeof path - 8, "%s/mu-%g-%s-%s", request->slices, g->mu, sides[side],
                                lq_slice_layout_names[layout]);
    if (length >= (int)sizeof path - 8) {
        snprintf(error->text, sizeof error->text, "the name of the folder for slices is too long");
        return LQ_BAD_INPUT;
    }
    snprintf(path + length, 8, ".exr");
    lq_status status = lq_slice_write_exr(g, &label, path, error);
    snprintf(path + length, 8, ".png");
    if (status == LQ_OK) status = lq_slice_write_png(g, &label, path, error);
    job->files += status == LQ_OK ? 2u : 0u;
    return status;
}

static lq_status measure(slice_job *job, size_t m, lq_error *error) {
    lq_stack_query query = job->query;
    lq_gonio g;
    cli_progress bar;
    query.mu = &job->query.mu[m];
    cli_progress_begin(&bar, "walks");
    lq_status status = lq_gonio_measure(&g, job->stack, &query, LQ_SLICE_LAYOUTS, job->request->samples,
                                        job->request->seed, &bar.progress, error);
    cli_progress_end(&bar);
    if (status == LQ_OK) compare(job, &g, m);
    for (int side = 0; status == LQ_OK && side < g.sides; side++)
        for (int layout = 0; status == LQ_OK && layout < LQ_SLICE_LAYOUTS; layout++)
            status = write_slice(job, &g, side, (lq_slice_layout)layout, error);
    lq_gonio_free(&g);
    return status;
}

static lq_status compute(slice_job *job, lq_error *error) {
    cli_progress bar;
    cli_progress_begin(&bar, "exact");
    lq_status status = lq_stack_solve(job->stack, &job->query, job->exact, &bar.progress, error);
    cli_progress_end(&bar);
    job->converged = status == LQ_OK;
    if (status == LQ_NOT_CONVERGED) status = LQ_OK;
    for (size_t m = 0; status == LQ_OK && m < job->query.mu_count; m++) status = measure(job, m, error);
    job->z_limit = lq_z_limit(job->count);
    return status;
}

static const char *complaint(const slice_job *job) {
    if (!(job->worst <= job->z_limit)) return "noise does not explain the difference to the walk";
    if (!job->converged) return "the solver did not reach its tolerance";
    return NULL;
}

/* ======================================================================================
 *                                        Report
 * ====================================================================================== */

static void print_text(const slice_job *job) {
    const validate_request *request = job->request;
    printf("%s: interfaces %s, light from %s, walks of %zu samples, seed %zu; energies by how often light "
           "met the first interface\n\n",
           job->stack->name[0] ? job->stack->name : request->stack, cli_interfaces[request->light.interfaces],
           cli_sides[request->light.from], request->samples, request->seed);
    printf("%-8s%s %-11s %-5s  %10s  %8s  %10s  %8s  %6s\n", "mu", job->channels > 1 ? " channel" : "",
           "side", "met", "exact", "error", "walk", "noise", "z");
    for (size_t i = 0; i < job->count; i++) {
        const slice_row *row = &job->rows[i];
        printf("%-8.6g", row->mu);
        if (job->channels > 1) printf(" %7d", row->channel);
        printf(" %-11s %-5s  %10.7f  %8.1e  %10.7f  %8.1e  %6.2f\n", sides[row->side], orders[row->order],
               row->compared.value, row->compared.allowance, row->compared.reference, row->compared.noise,
               row->z);
    }
    printf("\nlargest |z| %.2f; by chance below %.2f in all but 1 of %.0f reports\n", job->worst,
           job->z_limit, 1.0 / LQ_FALSE_ALARM);
    const char *why = complaint(job);
    printf("%zu files in %s\n\n%s%s\n", job->files, request->slices, why ? "FAILED: " : "passed",
           why ? why : "");
}

static bool print_json(const slice_job *job) {
    json_t *rows = json_array();
    const char *why = complaint(job);
    for (size_t i = 0; i < job->count; i++) {
        const slice_row *row = &job->rows[i];
        lq_json_append(&rows, json_pack("{s:f, s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:o}", "mu", row->mu,
                                        "channel", row->channel, "side", sides[row->side], "met",
                                        orders[row->order], "exact", lq_json_number(row->compared.value),
                                        "error", lq_json_number(row->compared.allowance), "walk",
                                        lq_json_number(row->compared.reference), "noise",
                                        lq_json_number(row->compared.noise), "z", lq_json_number(row->z)));
    }
    json_t *root = json_pack(
        "{s:o, s:s, s:s, s:I, s:I, s:o, s:o, s:f, s:b, s:o}", "stack", lq_json_text(job->stack->name),
        "interfaces", cli_interfaces[job->request->light.interfaces], "from",
        cli_sides[job->request->light.from], "samples", (json_int_t)job->request->samples, "seed",
        (json_int_t)job->request->seed, "rows", rows, "z_max", lq_json_number(job->worst), "z_limit",
        job->z_limit, "passed", !why, "complaint", why ? lq_json_text(why) : json_null());
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
}

static int report(const slice_job *job) {
    if (!job->request->json) print_text(job);
    else if (!print_json(job)) return CLI_FAILED;
    return complaint(job) ? CLI_EXCEEDED : CLI_DONE;
}

int validate_slices(const validate_request *request) {
    slice_job job = {.request = request};
    lq_error error = {""};
    lq_status status = prepare(&job, &error);
    if (status == LQ_OK) status = compute(&job, &error);
    const int code = status == LQ_OK ? report(&job) : cli_fail_status(status, &error);
    free(job.exact);
    free(job.rows);
    free(job.text);
    lq_stack_free(job.stack);
    return code;
}
