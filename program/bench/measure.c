/* measure.c - times the solver and the random walk and measures their errors. */
#include "program/bench/bench.h"

#include "program/progress.h"
#include "system/status.h"
#include "validate/walk_kind.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The small grid of a kind with four axes, or of a dielectric, has the shape of a slice of the full table;
 * others 32 nodes. */
static const struct {
    const char *name;
    size_t nodes;
    double min; /* where it is not the default; at alpha = 0 there would be nothing to compare */
} small_grid[] = {{"mu", 64, 0.0}, {"alpha", 8, 0.03125}, {"n", 32, 0.0}, {"kappa", 32, 0.0},
                  {"eta", 4, 0.0}, {"tau", 8, 0.0},       {"rho", 4, 0.0}};

static const double tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
static const double sample_counts[] = {1e3, 1e4, 1e5, 1e6};

/* Short runs are repeated until they took this long together; the fastest counts. */
static const double long_enough = 0.3;

typedef struct reference {
    lq_drawn *at;
    double *values; /* channels of one point beside each other */
    double *error;  /* estimate of each point */
} reference;

static bool is_dielectric(const lq_kind *kind) {
    return kind->interface && strcmp(kind->interface, "dielectric") == 0;
}

static lq_status make_axes(bench_job *job, lq_error *error) {
    lq_status status = lq_settings_axes(job->kind, &job->options.settings, job->axes, error);
    for (int a = 0; status == LQ_OK && a < job->kind->axis_count; a++) {
        if (job->axes[a].size == 1) continue; /* an NDF of one roughness */
        size_t nodes = 32;
        double min = job->axes[a].min;
        const double max = job->axes[a].max;
        const bool slice = job->kind->axis_count >= 4 || is_dielectric(job->kind);
        for (size_t k = 0; slice && k < sizeof small_grid / sizeof small_grid[0]; k++)
            if (strcmp(small_grid[k].name, job->axes[a].name) == 0) {
                nodes = small_grid[k].nodes;
                min = fmax(min, small_grid[k].min);
            }
        lq_axis_free(&job->axes[a]);
        status =
            lq_axis_make(&job->axes[a], job->kind->axes[a].name, min, max, nodes, LQ_MAP_LINEAR, 1.0, error);
    }
    return status;
}

/* The reference is the solver itself at a tolerance below every row, or, where it does not get there, at the
 * one whose estimate is the smallest. */
static lq_status refer_point(const bench_job *job, const lq_axis *axes, reference *to, size_t i,
                             lq_error *error) {
    lq_settings settings = job->options.settings;
    settings.threads = 1;
    to->at[i] = lq_draw_entry(axes, job->kind->axis_count, job->seed, i);
    double best = INFINITY, values[LQ_MAX_CHANNELS];
    double tolerance = job->reference_tolerance;
    lq_status status = LQ_NOT_CONVERGED;
    for (; status == LQ_NOT_CONVERGED && tolerance < 1e-2; tolerance *= 10.0) {
        if (cli_interrupted()) return lq_fail(error, LQ_CANCELLED, "cancelled");
        double estimate;
        settings.tolerance = tolerance;
        status = lq_eval(job->kind, &settings, to->at[i].at, values, &estimate, error);
        if ((status != LQ_OK && status != LQ_NOT_CONVERGED) || !(estimate < best)) continue;
        best = estimate;
        memcpy(&to->values[i * (size_t)job->kind->channel_count], values,
               (size_t)job->kind->channel_count * sizeof *values);
    }
    to->error[i] = best;
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

static lq_status refer(bench_job *job, const lq_axis *axes, reference *to, lq_error *error) {
    to->at = calloc(job->points, sizeof *to->at);
    to->values = calloc(job->points * (size_t)job->kind->channel_count, sizeof *to->values);
    to->error = calloc(job->points, sizeof *to->error);
    if (!to->at || !to->values || !to->error) {
        snprintf(error->text, sizeof error->text, "no memory for %zu points", job->points);
        return LQ_NO_MEMORY;
    }
    lq_status status = LQ_OK;
#pragma omp parallel for schedule(dynamic) num_threads(job->threads)
    for (size_t i = 0; i < job->points; i++) {
        lq_error cause = {""};
        const lq_status stop = refer_point(job, axes, to, i, &cause);
        if (stop == LQ_OK) continue;
#pragma omp critical(bench_refer)
        {
            status = stop;
            *error = cause;
        }
    }
    for (size_t i = 0; i < job->points; i++) job->reference_error = fmax(job->reference_error, to->error[i]);
    return status;
}

static void refer_free(reference *to) {
    free(to->error);
    free(to->at);
    free(to->values);
}

static void add_error(bench_row *row, double error) {
    row->rms += error * error;
    row->max = fmax(row->max, fabs(error));
}

static void finish_errors(const bench_job *job, bench_row *row) {
    row->rms = sqrt(row->rms / (double)(job->points * (size_t)job->kind->channel_count));
}

static void compare_table(const bench_job *job, const lq_table *table, const reference *to, bench_row *row) {
    const size_t channels = (size_t)table->channel_count;
    for (size_t i = 0; i < job->points; i++)
        for (size_t c = 0; c < channels; c++)
            add_error(row, (double)table->channels[c][to->at[i].entry] - to->values[i * channels + c]);
    finish_errors(job, row);
}

static lq_status run_solver(bench_job *job, const lq_axis *axes, const reference *to,
                            const lq_progress *progress, bench_row *row, lq_error *error) {
    lq_settings settings = job->options.settings;
    settings.tolerance = row->setting;
    row->seconds = INFINITY;
    for (double spent = 0.0; spent < long_enough;) {
        lq_table *table = NULL;
        const double start = cli_seconds();
        const lq_status status = lq_precompute(job->kind, &settings, axes, progress, &table, error);
        const double seconds = cli_seconds() - start;
        if (status != LQ_OK && status != LQ_NOT_CONVERGED) return status;
        spent += seconds;
        row->seconds = fmin(row->seconds, seconds);
        row->entries = lq_table_entries(table);
        if (spent >= long_enough) compare_table(job, table, to, row);
        lq_table_free(table);
    }
    return LQ_OK;
}

static lq_status walk_point(const bench_job *job, const reference *to, size_t i, const bench_row *row,
                            double *values, lq_error *error) {
    if (cli_interrupted()) return lq_fail(error, LQ_CANCELLED, "cancelled");
    const lq_walk_run walk = {.samples = (size_t)row->setting, .seed = job->seed, .purpose = i, .threads = 1};
    lq_walk_mean means[LQ_MAX_CHANNELS];
    const lq_status status =
        lq_walk_kind(job->kind, &job->options.settings, to->at[i].at, &walk, means, error);
    for (int c = 0; status == LQ_OK && c < job->kind->channel_count; c++) values[c] = means[c].mean;
    return status;
}

/* One thread a point: threads inside a walk would cost more than its shortest runs. */
static lq_status run_walk(bench_job *job, const reference *to, bench_row *row, lq_error *error) {
    const size_t channels = (size_t)job->kind->channel_count, count = job->points * channels;
    double *values = calloc(count, sizeof *values);
    if (!values) {
        snprintf(error->text, sizeof error->text, "no memory for %zu points", job->points);
        return LQ_NO_MEMORY;
    }
    lq_status status = LQ_OK;
    const double start = cli_seconds();
#pragma omp parallel for schedule(dynamic) num_threads(job->threads)
    for (size_t i = 0; i < job->points; i++) {
        lq_error cause = {""};
        const lq_status stop = walk_point(job, to, i, row, &values[i * channels], &cause);
        if (stop == LQ_OK) continue;
#pragma omp critical(bench_walk)
        {
            status = stop;
            *error = cause;
        }
    }
    row->seconds = cli_seconds() - start;
    row->entries = job->points;
    for (size_t i = 0; i < count; i++) add_error(row, values[i] - to->values[i]);
    finish_errors(job, row);
    free(values);
    return status;
}

static lq_status run_row(bench_job *job, const lq_axis *axes, const reference *to,
                         const lq_progress *progress, bench_row row, lq_error *error) {
    const lq_status status =
        row.walk ? run_walk(job, to, &row, error) : run_solver(job, axes, to, progress, &row, error);
    row.cpu_per_entry = row.seconds * job->threads / (double)row.entries;
    if (status == LQ_OK) job->rows[job->row_count++] = row;
    return status;
}

static lq_status run_full(bench_job *job, const lq_progress *progress, lq_error *error) {
    lq_axis axes[LQ_MAX_AXES];
    reference to = {NULL, NULL, NULL};
    lq_status status = lq_settings_axes(job->kind, &job->options.settings, axes, error);
    if (status != LQ_OK) return status;
    status = refer(job, axes, &to, error);
    if (status == LQ_OK) {
        const bench_row row = {.full = true, .setting = job->kind->tolerance};
        status = run_row(job, axes, &to, progress, row, error);
    }
    refer_free(&to);
    for (int a = 0; a < job->kind->axis_count; a++) lq_axis_free(&axes[a]);
    return status;
}

/* Without --full: 1e-6, or ten times the finest, so that the reference is finer. */
static double finest_row(const lq_kind *kind) {
    return fmax(1e-6, fmin(10.0 * kind->finest_tolerance, 1e-4));
}

lq_status bench_measure(bench_job *job, const lq_progress *progress, lq_error *error) {
    reference to = {NULL, NULL, NULL};
    job->reference_tolerance = fmax(1e-8, job->kind->finest_tolerance);
    lq_status status = make_axes(job, error);
    if (status == LQ_OK) status = refer(job, job->axes, &to, error);
    for (size_t i = 0; status == LQ_OK && i < sizeof tolerances / sizeof tolerances[0]; i++)
        if (tolerances[i] >= (job->full ? job->kind->finest_tolerance : finest_row(job->kind)))
            status = run_row(job, job->axes, &to, progress, (bench_row){.setting = tolerances[i]}, error);
    const bool walks = lq_walk_knows(job->kind);
    for (size_t i = 0; walks && status == LQ_OK && i < sizeof sample_counts / sizeof sample_counts[0]; i++)
        if (sample_counts[i] <= job->longest_walk)
            status = run_row(job, job->axes, &to, progress,
                             (bench_row){.walk = true, .setting = sample_counts[i]}, error);
    refer_free(&to);
    if (status == LQ_OK && job->full) status = run_full(job, progress, error);
    return status;
}

/* The time of a sample comes from the longest row, its variance from all of them. */
double bench_walk_cost(const bench_job *job, double error) {
    double variance = 0.0, count = 0.0, seconds = NAN;
    for (size_t i = 0; i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        if (!row->walk) continue;
        variance += row->rms * row->rms * row->setting;
        count += 1.0;
        seconds = row->cpu_per_entry / row->setting;
    }
    return seconds * variance / count / (error * error);
}

double bench_solver_cost(const bench_job *job, double error) {
    const bench_row *before = NULL;
    for (size_t i = 0; i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        if (row->walk || row->full) continue;
        if (row->rms <= error) {
            if (!before || !(row->rms > 0.0)) return row->cpu_per_entry;
            const double t = log(before->rms / error) / log(before->rms / row->rms);
            return exp((1.0 - t) * log(before->cpu_per_entry) + t * log(row->cpu_per_entry));
        }
        before = row;
    }
    return NAN;
}

const bench_row *bench_broken_row(const bench_job *job) {
    const double rounding = 3e-8; /* of float32 storage */
    for (size_t i = 0; i < job->row_count; i++) {
        const bench_row *row = &job->rows[i];
        if (!row->walk && !(row->max <= row->setting + job->reference_error + rounding)) return row;
    }
    return NULL;
}
