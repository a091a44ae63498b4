/* stack.c - `lacquer bench stack`: the exact solver of stacks against random walks, and against itself in
 * RGB. */
#include "program/bench/stack.h"

#include "program/message.h"
#include "program/progress.h"
#include "program/verb.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double tolerance = 1e-4;

/* Short runs are repeated until they took this long together, solvers at least three times, walks twice. */
static const double long_enough = 0.3;

/* One channel for the speed, RGB for what two more channels cost: where nothing but absorption, albedo or
 * base differs between them, most of the work is common. */
static const char *const built_in[] = {
    "{\"name\": \"frosted-metal\", \"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}},"
    "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": 0.05}}]}",
    "{\"name\": \"varnished-base\", \"layers\": ["
    "{\"dielectric\": {\"n\": 1.3, \"alpha\": 0.1}, \"medium\": {\"tau\": 0.9}},"
    "{\"dielectric\": {\"n\": 1.8, \"alpha\": 0.4}, \"medium\": {\"tau\": 0.7}},"
    "{\"lambertian\": {\"rho\": 0.7}}]}",
    "{\"name\": \"six-interfaces\", \"layers\": ["
    "{\"dielectric\": {\"n\": 1.3, \"alpha\": 0.1}}, {\"dielectric\": {\"n\": 1.5, \"alpha\": 0.3}},"
    "{\"dielectric\": {\"n\": 1.2, \"alpha\": 0.2}}, {\"dielectric\": {\"n\": 1.6, \"alpha\": 0.4}},"
    "{\"dielectric\": {\"n\": 1.4, \"alpha\": 0.15}},"
    "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": 0.2}}]}",
    "{\"name\": \"frosted-absorption-rgb\", \"layers\": ["
    "{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}, \"medium\": {\"tau\": [0.8, 0.5, 0.3]}},"
    "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": 0.05}}]}",
    "{\"name\": \"frosted-base-rgb\", \"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}},"
    "{\"conductor\": {\"n\": [0.2, 0.4, 1.4], \"kappa\": [3.9, 2.4, 1.6], \"alpha\": 0.05}}]}",
    "{\"name\": \"varnished-albedo-rgb\", \"layers\": ["
    "{\"dielectric\": {\"n\": 1.3, \"alpha\": 0.1}, \"medium\": {\"tau\": 0.9}},"
    "{\"dielectric\": {\"n\": 1.8, \"alpha\": 0.4}, \"medium\": {\"tau\": 0.7}},"
    "{\"lambertian\": {\"rho\": [0.7, 0.4, 0.1]}}]}"};

enum { BUILT_IN = sizeof built_in / sizeof *built_in };

static lq_status no_memory(lq_error *error) {
    snprintf(error->text, sizeof error->text, "out of memory");
    return LQ_NO_MEMORY;
}

/* ======================================================================================
 *                                         Rows
 * ====================================================================================== */

/* Runs of one thing, and what they left; NOT_CONVERGED is a result like any other. */
typedef lq_status bench_run(const bench_stack_job *b, const lq_stack *stack, const lq_progress *progress,
                            bench_stack_row *row, lq_error *error);

/* `light` has room for all cosines and channels. */
static lq_status solve(const bench_stack_job *b, const lq_stack *stack, double at, lq_stack_light *light,
                       const lq_progress *progress, lq_error *error) {
    double mu[BENCH_STACK_COSINES];
    for (int i = 0; i < BENCH_STACK_COSINES; i++) mu[i] = (i + 0.5) / BENCH_STACK_COSINES;
    const lq_stack_query query = {
        .mu = mu, .mu_count = BENCH_STACK_COSINES, .tolerance = at, .threads = b->job->threads};
    return lq_stack_solve(stack, &query, light, progress, error);
}

static lq_status run_solver(const bench_stack_job *b, const lq_stack *stack, const lq_progress *progress,
                            bench_stack_row *row, lq_error *error) {
    const size_t count = BENCH_STACK_COSINES * (size_t)row->channels;
    lq_stack_light *light = calloc(count, sizeof *light);
    if (!light) return no_memory(error);
    const lq_status status = solve(b, stack, row->setting, light, progress, error);
    row->error = 0.0;
    for (size_t i = 0; i < count; i++) row->error = fmax(row->error, light[i].error);
    free(light);
    return status;
}

static double lobes_apart(const lq_stack_lobe *a, const lq_stack_lobe *b) {
    const double sin2 = fabs(a->sin2 - b->sin2), mean = fabs(a->mean - b->mean);
    const double means = fmax(sin2, fmax(mean, fabs(a->across - b->across)));
    return fmax(fabs(a->energy - b->energy), b->energy * means);
}

/* What a solver is off by, which its estimate is meant to be above. */
static lq_status measure_off(const bench_stack_job *b, const lq_stack *stack, bench_stack_row *row,
                             lq_error *error) {
    const size_t count = BENCH_STACK_COSINES * (size_t)row->channels;
    lq_stack_light *light = calloc(2 * count, sizeof *light), *fine = light + count;
    if (!light) return no_memory(error);
    lq_status status = solve(b, stack, row->setting, light, NULL, error);
    if (status == LQ_OK || status == LQ_NOT_CONVERGED)
        status = solve(b, stack, row->setting / 10.0, fine, NULL, error);
    row->off = 0.0;
    for (size_t i = 0; i < count; i++) {
        row->off = fmax(row->off, lobes_apart(&light[i].reflected, &fine[i].reflected));
        row->off = fmax(row->off, lobes_apart(&light[i].transmitted, &fine[i].transmitted));
    }
    free(light);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* The means over a lobe count by its energy: those of a faint one are noisy and say little. */
static double noise_of(const lq_stack_lobe *lobe, const lq_stack_lobe *noise) {
    const double means = fmax(noise->sin2, fmax(noise->mean, noise->across));
    return fmax(noise->energy, lobe->energy * means);
}

static lq_status run_walk(const bench_stack_job *b, const lq_stack *stack, const lq_progress *progress,
                          bench_stack_row *row, lq_error *error) {
    const double mu = BENCH_STACK_WALK_COSINE;
    const lq_stack_query query = {.mu = &mu, .mu_count = 1, .threads = b->job->threads};
    lq_stack_walked walked[LQ_STACK_CHANNELS];
    const lq_status status =
        lq_stack_walk(stack, &query, (size_t)row->setting, b->job->seed, walked, progress, error);
    row->error = 0.0;
    for (int c = 0; status == LQ_OK && c < row->channels; c++) {
        const lq_stack_walked *w = &walked[c];
        row->error = fmax(row->error, noise_of(&w->light.reflected, &w->reflected_noise));
        row->error = fmax(row->error, noise_of(&w->light.transmitted, &w->transmitted_noise));
    }
    return status;
}

static lq_status run_table(const bench_stack_job *b, const lq_stack *stack, const lq_progress *progress,
                           bench_stack_row *row, lq_error *error) {
    const lq_stack_query query = {.tolerance = row->setting, .threads = b->job->threads};
    const size_t nodes = BENCH_STACK_COSINES;
    lq_axis axes[2] = {{.size = 0}, {.size = 0}};
    lq_table *table = NULL;
    lq_status status = lq_axis_make(&axes[0], "mu", 0.0, 1.0, nodes, LQ_MAP_LINEAR, 1.0, error);
    if (status == LQ_OK)
        status = lq_axis_make(&axes[1], "top.alpha", 0.0, 1.0, nodes, LQ_MAP_LINEAR, 1.0, error);
    if (status == LQ_OK) status = lq_stack_precompute(stack, &query, axes, 2, progress, &table, error);
    const char *estimate = table ? lq_table_fact(table, "error") : NULL;
    row->error = estimate ? strtod(estimate, NULL) : NAN;
    lq_table_free(table);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    return status;
}

static lq_status run_once(bench_stack_job *b, bench_run *run, const lq_stack *stack, bench_stack_row *row,
                          const lq_progress *progress, lq_error *error) {
    const double start = cli_seconds();
    const clock_t cpu = clock();
    const lq_status status = run(b, stack, progress, row, error);
    const double seconds = cli_seconds() - start;
    if (!row->runs || seconds < row->fastest) {
        row->fastest = seconds;
        row->cpu = (double)(clock() - cpu) / CLOCKS_PER_SEC;
    }
    row->slowest = row->runs ? fmax(row->slowest, seconds) : seconds;
    row->runs++;
    if (status == LQ_NOT_CONVERGED) row->above = true;
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

/* One row for each of `count` stacks, which take turns: what else the machine does meets all of them. */
static lq_status measure(bench_stack_job *b, bench_run *run, size_t least, const lq_stack *const *stacks,
                         size_t count, const bench_stack_row *like, lq_error *error) {
    bench_stack_row *rows = &b->rows[b->row_count];
    lq_status status = LQ_OK;
    cli_progress bar;
    for (size_t i = 0; i < count; i++) {
        rows[i] = *like;
        rows[i].channels = lq_stack_channels(stacks[i]);
        rows[i].ratio = rows[i].off = NAN;
        snprintf(rows[i].stack, sizeof rows[i].stack, "%s", stacks[i]->name);
    }
    cli_progress_begin(&bar, like->method);
    const double start = cli_seconds();
    while (status == LQ_OK && (rows[0].runs < least || cli_seconds() - start < long_enough))
        for (size_t i = 0; status == LQ_OK && i < count; i++)
            status = run_once(b, run, stacks[i], &rows[i], &bar.progress, error);
    cli_progress_end(&bar);
    if (status == LQ_OK) b->row_count += count;
    return status;
}

/* ======================================================================================
 *                                        Stacks
 * ====================================================================================== */

static void keep_first(lq_quantity *q) {
    *q = (lq_quantity){.value = {q->value[0], q->value[0], q->value[0]}};
}

/* The first channel of a stack in RGB, as a stack of its own. */
static lq_status take_first(const lq_stack *stack, lq_stack **first, lq_error *error) {
    const lq_status status = lq_stack_copy(first, stack, error);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < stack->layer_count; i++) {
        lq_layer *l = &(*first)->layers[i];
        lq_quantity *const all[] = {
            &l->n,          &l->kappa,          &l->alpha_x,        &l->alpha_y,      &l->rotate,  &l->rho,
            &l->medium.tau, &l->medium.sigma_a, &l->medium.sigma_s, &l->medium.depth, &l->medium.g};
        for (size_t k = 0; k < sizeof all / sizeof *all; k++) keep_first(all[k]);
    }
    return LQ_OK;
}

/* The solver, with its first channel beside it where there are three, then the walk. */
static lq_status measure_stack(bench_stack_job *b, const lq_stack *stack, lq_error *error) {
    lq_stack *first = NULL;
    const bool rgb = lq_stack_channels(stack) > 1;
    lq_status status = rgb ? take_first(stack, &first, error) : LQ_OK;
    if (status != LQ_OK) return status;
    const lq_stack *const pair[] = {stack, first};
    const bench_stack_row solver = {.method = "solver", .setting = tolerance, .entries = BENCH_STACK_COSINES};
    const bench_stack_row walk = {.method = "walk", .setting = b->job->longest_walk, .entries = 1};
    bench_stack_row *rows = &b->rows[b->row_count];
    status = measure(b, run_solver, 3, pair, rgb ? 2 : 1, &solver, error);
    lq_stack_free(first);
    if (status == LQ_OK) status = measure_off(b, stack, &rows[0], error);
    if (status == LQ_OK && rgb) rows[0].ratio = rows[0].fastest / rows[1].fastest;
    if (status == LQ_OK) status = measure(b, run_walk, 2, pair, 1, &walk, error);
    if (status != LQ_OK) return status;
    bench_stack_row *walked = &b->rows[b->row_count - 1];
    walked->ratio = bench_stack_walk_seconds(&rows[0], walked) / rows[0].fastest;
    return LQ_OK;
}

double bench_stack_walk_seconds(const bench_stack_row *solver, const bench_stack_row *walk) {
    const double samples = pow(walk->error / solver->off, 2.0);
    return walk->fastest / (double)walk->entries * samples * (double)solver->entries;
}

/* The table is that of the first stack alone: 64 stacks at 64 cosines. */
static lq_status measure_text(bench_stack_job *b, const char *text, const char *path, unsigned flags,
                              bool table, lq_error *error) {
    lq_stack *stack = NULL;
    const bench_stack_row row = {
        .method = "table", .setting = tolerance, .entries = BENCH_STACK_COSINES * BENCH_STACK_COSINES};
    lq_status status = path ? lq_stack_read(&stack, path, flags, error)
                            : lq_stack_parse(&stack, text, "built-in stack", flags, error);
    if (status == LQ_OK && !stack->name[0])
        snprintf(stack->name, sizeof stack->name, "%s", path ? path : "stack");
    if (status == LQ_OK) status = measure_stack(b, stack, error);
    if (status == LQ_OK && table)
        status = measure(b, run_table, 1, (const lq_stack *const[]){stack}, 1, &row, error);
    lq_stack_free(stack);
    return status;
}

/* ======================================================================================
 *                                       The call
 * ====================================================================================== */

static int report(const bench_stack_job *b) {
    lq_error error = {""};
    bench_stack_print(b);
    const lq_status status = b->job->csv ? bench_stack_write_csv(b, &error) : LQ_OK;
    if (status != LQ_OK) return cli_fail_status(status, &error);
    for (size_t i = 0; i < b->row_count; i++)
        if (b->rows[i].above) {
            cli_message("%s: at tolerance %g the error estimate is %.2e", b->rows[i].stack,
                        b->rows[i].setting, b->rows[i].error);
            return CLI_EXCEEDED;
        }
    return CLI_DONE;
}

int bench_stack(const bench_job *job, const char *path, bool trusted) {
    _Static_assert(BUILT_IN * 3 + 1 <= BENCH_STACK_ROWS, "a solver, its first channel and a walk each");
    bench_stack_job b = {.job = job};
    lq_error error = {""};
    lq_status status = LQ_OK;
    if (path) status = measure_text(&b, NULL, path, trusted ? LQ_STACK_TRUSTED : 0, job->full, &error);
    for (int i = 0; !path && status == LQ_OK && i < BUILT_IN; i++)
        status = measure_text(&b, built_in[i], NULL, 0, job->full && i == 0, &error);
    return status == LQ_OK ? report(&b) : cli_fail_status(status, &error);
}
