/* stack.c - `lacquer validate stack`: the exact solver of stacks against random walks of single rays. */
#include "program/validate/validate.h"

#include "program/message.h"
#include "program/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDES = 2, QUANTITIES = 4 };
static const char *const sides[SIDES] = {"reflected", "transmitted"};
static const char *const quantities[QUANTITIES] = {"energy", "sin2", "mean", "across"};

typedef struct stack_row {
    size_t mu;
    int channel, side, quantity;
    lq_compared compared; /* exact, walk */
    double z;
} stack_row;

typedef struct stack_job {
    const validate_request *request;
    lq_stack *stack;
    lq_stack_query query;
    int channels;
    lq_stack_light *exact;   /* [mu_count * channels] */
    lq_stack_walked *walked; /* likewise */
    bool converged;
    size_t count;
    stack_row *rows;
    size_t worst; /* the row of the largest |z| */
    double z_limit;
} stack_job;

/* ======================================================================================
 *                                       Numbers
 * ====================================================================================== */

lq_status validate_stack_open(const validate_request *request, lq_stack **stack, lq_error *error) {
    const double tolerance = request->settings.settings.tolerance;
    if (tolerance != 0.0 && (tolerance < CLI_STACK_TOLERANCE_MIN || tolerance > CLI_STACK_TOLERANCE_MAX)) {
        snprintf(error->text, sizeof error->text, "--tolerance: a stack accepts %g to %g, not %g",
                 CLI_STACK_TOLERANCE_MIN, CLI_STACK_TOLERANCE_MAX, tolerance);
        return LQ_BAD_INPUT;
    }
    return lq_stack_read(stack, request->stack, request->trust.plugins ? LQ_STACK_TRUSTED : 0, error);
}

static lq_status prepare(stack_job *job, lq_error *error) {
    const validate_request *request = job->request;
    const double tolerance = request->settings.settings.tolerance;
    lq_status status = validate_stack_open(request, &job->stack, error);
    if (status != LQ_OK) return status;
    job->query = cli_light_query(&request->light);
    job->query.tolerance = tolerance;
    job->query.threads = (int)request->threads;
    job->channels = lq_stack_channels(job->stack);
    const size_t lights = job->query.mu_count * (size_t)job->channels;
    job->exact = calloc(lights, sizeof *job->exact);
    job->walked = calloc(lights, sizeof *job->walked);
    job->rows = calloc(lights * SIDES * QUANTITIES, sizeof *job->rows);
    if (job->exact && job->walked && job->rows) return LQ_OK;
    snprintf(error->text, sizeof error->text, "out of memory");
    return LQ_NO_MEMORY;
}

static lq_status compute(stack_job *job, lq_error *error) {
    cli_progress bar;
    cli_progress_begin(&bar, "exact");
    lq_status status = lq_stack_solve(job->stack, &job->query, job->exact, &bar.progress, error);
    cli_progress_end(&bar);
    job->converged = status == LQ_OK;
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
    cli_progress_begin(&bar, "walks");
    status = lq_stack_walk(job->stack, &job->query, job->request->samples, job->request->seed, job->walked,
                           &bar.progress, error);
    cli_progress_end(&bar);
    return status;
}

static double quantity_of(const lq_stack_lobe *lobe, int quantity) {
    return (const double[QUANTITIES]){lobe->energy, lobe->sin2, lobe->mean, lobe->across}[quantity];
}

/* An event that fewer than a few of the walks met is missing from their standard error: an energy is
 * uncertain by 3/samples besides (as lq_walk_noise has it), a mean over the light by that fraction of it.
 * What the walks gave up counts likewise. */
static void add_row(stack_job *job, stack_row row) {
    const size_t at = row.mu * (size_t)job->channels + (size_t)row.channel;
    const lq_stack_light *exact = &job->exact[at];
    const lq_stack_walked *walked = &job->walked[at];
    const bool back = row.side == 0;
    const lq_stack_lobe *lobe = back ? &walked->light.reflected : &walked->light.transmitted;
    const lq_stack_lobe *noise = back ? &walked->reflected_noise : &walked->transmitted_noise;
    const double energy = row.quantity == 0 ? 1.0 : lobe->energy;
    if (!(energy > 0.0)) return;
    row.compared = (lq_compared){
        .value = quantity_of(back ? &exact->reflected : &exact->transmitted, row.quantity),
        .reference = quantity_of(lobe, row.quantity),
        .allowance = exact->error + walked->light.error / energy,
        .noise = hypot(quantity_of(noise, row.quantity), 3.0 / (double)job->request->samples / energy)};
    row.z = lq_compared_score(&row.compared);
    if (fabs(row.z) > fabs(job->rows[job->worst].z)) job->worst = job->count;
    job->rows[job->count++] = row;
}

static void compare(stack_job *job) {
    const bool opaque = job->stack->layers[job->stack->layer_count - 1].type != LQ_LAYER_DIELECTRIC;
    for (size_t m = 0; m < job->query.mu_count; m++)
        for (int c = 0; c < job->channels; c++)
            for (int side = 0; side < (opaque ? 1 : SIDES); side++)
                for (int q = 0; q < QUANTITIES; q++)
                    add_row(job, (stack_row){.mu = m, .channel = c, .side = side, .quantity = q});
    job->z_limit = lq_z_limit(job->count);
}

/* The rows of one walk share its noise, so that the sum of their z is no normal deviate: each counts alone.
 */
static const char *complaint(const stack_job *job) {
    if (!(fabs(job->rows[job->worst].z) <= job->z_limit))
        return "noise does not explain the difference to the walk";
    if (!job->converged) return "the solver did not reach its tolerance";
    return NULL;
}

/* ======================================================================================
 *                                        Report
 * ====================================================================================== */

static const char *interfaces_of(const stack_job *job) {
    return cli_interfaces[job->request->light.interfaces];
}

static void print_row(const stack_job *job, const stack_row *row) {
    printf("%-8.6g", job->query.mu[row->mu]);
    if (job->channels > 1) printf(" %7d", row->channel);
    printf(" %-11s %-6s  %10.7f  %8.1e  %10.7f  %8.1e  %6.2f\n", sides[row->side], quantities[row->quantity],
           row->compared.value, row->compared.allowance, row->compared.reference, row->compared.noise,
           row->z);
}

static void print_text(const stack_job *job) {
    printf("%s: interfaces %s, light from %s, walks of %zu samples, seed %zu\n\n",
           job->stack->name[0] ? job->stack->name : job->request->stack, interfaces_of(job),
           cli_sides[job->request->light.from], job->request->samples, job->request->seed);
    printf("%-8s%s %-11s %-6s  %10s  %8s  %10s  %8s  %6s\n", "mu", job->channels > 1 ? " channel" : "",
           "side", "", "exact", "error", "walk", "noise", "z");
    for (size_t i = 0; i < job->count; i++) print_row(job, &job->rows[i]);
    printf("\nlargest |z| %.2f; by chance below %.2f in all but 1 of %.0f reports\n",
           fabs(job->rows[job->worst].z), job->z_limit, 1.0 / LQ_FALSE_ALARM);
    const char *why = complaint(job);
    printf("\n%s%s\n", why ? "FAILED: " : "passed", why ? why : "");
}

static json_t *row_json(const stack_job *job, const stack_row *row) {
    return json_pack("{s:f, s:i, s:s, s:s, s:o, s:o, s:o, s:o, s:o}", "mu", job->query.mu[row->mu], "channel",
                     row->channel, "side", sides[row->side], "quantity", quantities[row->quantity], "exact",
                     lq_json_number(row->compared.value), "error", lq_json_number(row->compared.allowance),
                     "walk", lq_json_number(row->compared.reference), "noise",
                     lq_json_number(row->compared.noise), "z", lq_json_number(row->z));
}

static bool print_json(const stack_job *job) {
    json_t *rows = json_array();
    const char *why = complaint(job);
    for (size_t i = 0; i < job->count; i++) lq_json_append(&rows, row_json(job, &job->rows[i]));
    json_t *root = json_pack(
        "{s:o, s:s, s:s, s:I, s:I, s:o, s:o, s:f, s:b, s:o}", "stack", lq_json_text(job->stack->name),
        "interfaces", interfaces_of(job), "from", cli_sides[job->request->light.from], "samples",
        (json_int_t)job->request->samples, "seed", (json_int_t)job->request->seed, "rows", rows, "z_max",
        lq_json_number(fabs(job->rows[job->worst].z)), "z_limit", job->z_limit, "passed", !why, "complaint",
        why ? lq_json_text(why) : json_null());
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
}

static int report(const stack_job *job) {
    if (!job->request->json) print_text(job);
    else if (!print_json(job)) return CLI_FAILED;
    return complaint(job) ? CLI_EXCEEDED : CLI_DONE;
}

int validate_stack(const validate_request *request) {
    stack_job job = {.request = request};
    lq_error error = {""};
    lq_status status = prepare(&job, &error);
    if (status == LQ_OK) status = compute(&job, &error);
    if (status == LQ_OK) compare(&job);
    const int code = status == LQ_OK ? report(&job) : cli_fail_status(status, &error);
    free(job.exact);
    free(job.walked);
    free(job.rows);
    lq_stack_free(job.stack);
    return code;
}
