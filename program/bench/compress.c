/* compress.c - tables compressed in several ways: time, bytes, error. */
#include "program/bench/bench.h"

#include "system/status.h"

#include <omp.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* A table and the axes that are taken out of it. */
typedef struct subject {
    const char *kind;
    const char *nodes[LQ_MAX_AXES];
    int separation_count;
    struct {
        const char *axes[2];
    } separations[2];
} subject;

static const subject subjects[] = {
    {"fgd", {"0:1:24", "0.03:1:16", "0:4:12", "0:4:12"}, 1, {{{"n", "kappa"}}}},
    {"fgd-dielectric", {"0:1:24", "0.03:1:16", "1:4:12"}, 1, {{{"eta", NULL}}}},
    {"tir-pass", {"0:1:24", "0.03:1:16", "0:4:12"}, 1, {{{"eta", NULL}}}},
    {"transmission", {"0:1:16", "0.03:1:8", "1:2.5:8", "0:1:8"}, 2, {{{"tau", NULL}}, {{"eta", NULL}}}},
};
static const size_t bases[] = {1, 2, 4, 8};
enum {
    SUBJECTS = sizeof subjects / sizeof subjects[0],
    COUNTS = sizeof bases / sizeof bases[0],
    SCHEMES = 2
};

static lq_status make_table(const subject *s, int threads, const lq_kind *kind, lq_table **table,
                            lq_error *error) {
    lq_axis axes[LQ_MAX_AXES] = {{.size = 0}};
    lq_settings settings = lq_settings_default();
    settings.threads = threads;
    lq_status status = LQ_OK;
    for (int a = 0; status == LQ_OK && a < kind->axis_count; a++)
        status = lq_axis_parse(&axes[a], kind->axes[a].name, s->nodes[a], error);
    if (status == LQ_OK) status = lq_precompute(kind, &settings, axes, NULL, table, error);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

static lq_pca_options choose(const subject *s, const lq_table *table, lq_scheme scheme, size_t count,
                             bench_compression *row) {
    lq_pca_options options = lq_pca_options_default();
    size_t used = 0;
    options.scheme = scheme;
    options.separation_count = s->separation_count;
    for (int k = 0; k < s->separation_count; k++) {
        lq_separation *separation = &options.separations[k];
        const char *one = s->separations[k].axes[0], *other = s->separations[k].axes[1];
        separation->axis_count = other ? 2 : 1;
        separation->axes[0] = lq_table_axis(table, one);
        if (other) separation->axes[1] = lq_table_axis(table, other);
        separation->bases = k == 0 ? count : 4;
        used += (size_t)snprintf(row->separated + used, sizeof row->separated - used, "%s%s%s%s:%zu",
                                 k ? "," : "", one, other ? "+" : "", other ? other : "", separation->bases);
    }
    return options;
}

static double cpu_seconds(void) {
    return (double)clock() / (double)CLOCKS_PER_SEC;
}

static lq_status compress_one(const subject *s, const lq_table *table, lq_scheme scheme, size_t count,
                              bench_compression *row, lq_error *error) {
    *row = (bench_compression){.kind = s->kind, .scheme = scheme == LQ_JOINT ? "joint" : "sequential"};
    const lq_pca_options options = choose(s, table, scheme, count, row);
    lq_factored *factored = NULL;
    lq_pca_errors errors;
    const double start = cpu_seconds();
    lq_status status = lq_pca(table, 0, &options, NULL, &factored, error);
    row->seconds = cpu_seconds() - start;
    if (status == LQ_OK) status = lq_factored_errors(factored, table, 0, &errors, error);
    if (status == LQ_OK) {
        row->entries = lq_table_entries(table);
        row->table_bytes = row->entries * 2; /* as half */
        row->bytes = lq_factored_bytes(factored);
        row->rms = errors.rms;
        row->p99 = errors.p99;
        row->max = errors.max;
    }
    lq_factored_free(factored);
    return status;
}

static lq_status compress_subject(const subject *s, int threads, const lq_progress *progress, double done,
                                  bench_compression *list, size_t *count, lq_error *error) {
    static const lq_scheme schemes[SCHEMES] = {LQ_SEQUENTIAL, LQ_JOINT};
    const lq_kind *kind = lq_kind_find(s->kind, error);
    lq_table *table = NULL;
    lq_status status = kind ? make_table(s, threads, kind, &table, error) : LQ_BAD_INPUT;
    for (int k = 0; status == LQ_OK && k < SCHEMES * COUNTS; k++) {
        status = compress_one(s, table, schemes[k / COUNTS], bases[k % COUNTS], &list[*count], error);
        if (status == LQ_OK) ++*count;
        const double fraction = (done + (double)(k + 1) / (SCHEMES * COUNTS)) / SUBJECTS;
        if (status == LQ_OK && !progress->report(progress->user, fraction))
            status = lq_fail(error, LQ_CANCELLED, "cancelled");
    }
    lq_table_free(table);
    return status;
}

lq_status bench_compress(const lq_kind *only, int threads, const lq_progress *progress,
                         bench_compression *list, size_t *count, lq_error *error) {
    _Static_assert(SUBJECTS * COUNTS * SCHEMES <= BENCH_MAX_COMPRESSIONS, "the list holds all of them");
    lq_status status = LQ_OK;
    *count = 0;
    for (int s = 0; status == LQ_OK && s < SUBJECTS; s++)
        if (!only || strcmp(only->id, subjects[s].kind) == 0)
            status = compress_subject(&subjects[s], threads, progress, s, list, count, error);
    return status;
}
