/* against_print.c - the report of `lacquer validate --against FILE`, as text and as JSON. */
#include "program/validate/against.h"

#include "program/output.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>

/* ======================================================================================
 *                                         Text
 * ====================================================================================== */

static void print_head(const against_job *job) {
    char what[128];
    lq_origin_describe(job->origin.kind, &job->origin.settings, what, sizeof what);
    printf("%s - %s: %s, tolerance %g\n", cli_basename(job->other_name),
           job->file ? cli_basename(job->request->file) : "exact", what, job->origin.settings.tolerance);
    for (int i = 0; i < job->other->axis_count; i++)
        printf("%s%s %zu", i ? " x " : "", job->other->axes[i].name, job->other->axes[i].size);
    printf(" nodes; %zu entries", job->entries);
    if (!job->patterned) printf(" drawn at random, seed %zu", job->request->seed);
    if (job->computed) printf("; the reference is computed at these nodes");
    printf("\n");
}

static void print_figures(const against_job *job, int c) {
    const lq_comparison *r = &job->result[c];
    const lq_compared *pair = &job->worst_pair[c];
    printf("  rms         %.3e\n  mean        %+.2e\n  p99         %.2e\n  max         %.3e at", r->rms,
           r->mean, r->p99, r->max);
    for (int a = 0; a < job->other->axis_count; a++)
        printf(" %s=%.6g", job->other->axes[a].name, job->worst_at[c].at[a]);
    printf(": %.7f, %.7f\n", pair->value, pair->reference);
}

static void print_sampling(const against_job *job, const lq_pattern *p) {
    if (p->best_axis >= 0)
        printf("  sampling    rms would be %.2e with %s sampled at %s\n",
               p->sampled[p->best_axis][p->best_sampling], job->other->axes[p->best_axis].name,
               lq_sampling_name(p->best_sampling));
    else printf("  sampling    i/(N-1): half a cell or i/N on any axis fits worse\n");
}

static void print_entry(const lq_table *table, size_t entry) {
    for (int a = 0; a < table->axis_count; a++) {
        printf(" %s=%.6g", table->axes[a].name, table->axes[a].nodes[entry % table->axes[a].size]);
        entry /= table->axes[a].size;
    }
}

static void print_pattern(const against_job *job, int c) {
    const lq_pattern *p = &job->pattern[c];
    if (p->spots > 0) printf("  spots       %zu entries are wrong, all others agree\n", p->spots);
    if (p->zeros > 0) {
        printf("  zeros       %zu entries are 0 where the reference is not, first at", p->zeros);
        print_entry(job->other, p->zero_at);
        printf("\n");
    }
    if (p->outliers > 0)
        printf("  outliers    %zu beyond 8 rms; without them rms %.3e, mean %+.2e\n", p->outliers, p->rms,
               p->mean);
    printf("  neighbours  correlated by");
    for (int a = 0; a < job->other->axis_count; a++)
        printf("%s %s %.3f", a ? "," : "", job->other->axes[a].name, p->correlation[a]);
    printf("; about %.0f independent errors\n", p->independent);
    printf("  mean        %+.2f of its standard errors\n", p->z_mean);
    print_sampling(job, p);
    printf("  looks like  %s\n", lq_verdict_text(p->verdict));
}

/* The few closest definitions, and what the table was said to be. */
static void print_variants(const against_job *job) {
    const lq_variants *v = &job->variants;
    if (v->count == 0) return;
    printf("\ndefinitions (rms of the best 95 %% of %zu entries)\n", v->entries);
    for (size_t i = 0; i < v->count && i < 4; i++) printf("  %.3e  %s\n", v->list[i].rms, v->list[i].what);
    if (v->count > 4 && v->stated > v->list[3].rms) printf("  %.3e  as stated\n", v->stated);
    if (v->other) printf("  looks like another definition: %s\n", v->list[0].what);
}

void against_print_text(const against_job *job) {
    print_head(job);
    for (int c = 0; c < job->other->channel_count; c++) {
        printf("\n%s\n", job->other->channel_names[c]);
        print_figures(job, c);
        if (job->patterned) print_pattern(job, c);
    }
    print_variants(job);
    const char *complaint = against_complaint(job);
    printf("\n%s%s", complaint ? "FAILED: " : "passed", complaint ? complaint : "");
    if (job->request->budget > 0.0) printf(", budget %g", job->request->budget);
    printf("\n");
}

/* ======================================================================================
 *                                         JSON
 * ====================================================================================== */

/* JSON knows no infinity: such a number becomes null. */
static json_t *number(double x) {
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t *worst_json(const against_job *job, int c) {
    json_t *worst = json_object();
    for (int a = 0; a < job->other->axis_count; a++)
        json_object_set_new(worst, job->other->axes[a].name, number(job->worst_at[c].at[a]));
    json_object_set_new(worst, "value", number(job->worst_pair[c].value));
    json_object_set_new(worst, "reference", number(job->worst_pair[c].reference));
    return worst;
}

static json_t *pattern_json(const against_job *job, const lq_pattern *p) {
    json_t *correlation = json_object();
    for (int a = 0; a < job->other->axis_count; a++)
        json_object_set_new(correlation, job->other->axes[a].name, number(p->correlation[a]));
    return json_pack("{s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:s}", "spots", (json_int_t)p->spots, "zeros",
                     (json_int_t)p->zeros, "outliers", (json_int_t)p->outliers, "rms", number(p->rms), "mean",
                     number(p->mean), "correlation", correlation, "independent", number(p->independent),
                     "z_mean", number(p->z_mean), "looks_like", lq_verdict_text(p->verdict));
}

static json_t *channel_json(const against_job *job, int c) {
    const lq_comparison *r = &job->result[c];
    json_t *root = json_pack("{s:o, s:o, s:o, s:o, s:o}", "max", number(r->max), "rms", number(r->rms),
                             "mean", number(r->mean), "p99", number(r->p99), "worst", worst_json(job, c));
    if (root && job->patterned) json_object_set_new(root, "pattern", pattern_json(job, &job->pattern[c]));
    return root;
}

static json_t *variants_json(const lq_variants *variants) {
    json_t *list = json_array();
    for (size_t i = 0; i < variants->count; i++)
        json_array_append_new(list, json_pack("{s:s, s:o}", "what", variants->list[i].what, "rms",
                                              number(variants->list[i].rms)));
    return list;
}

bool against_print_json(const against_job *job) {
    json_t *root =
        json_pack("{s:s, s:s, s:s, s:I}", "file", job->request->file, "table", job->origin.kind->id,
                  "against", job->file ? job->other_name : "exact", "entries", (json_int_t)job->entries);
    if (!root) return false;
    for (int c = 0; c < job->other->channel_count; c++)
        json_object_set_new(root, job->other->channel_names[c], channel_json(job, c));
    const char *complaint = against_complaint(job);
    if (job->variants.count > 0) json_object_set_new(root, "definitions", variants_json(&job->variants));
    if (job->variants.other)
        json_object_set_new(root, "looks_like_definition", json_string(job->variants.list[0].what));
    json_object_set_new(root, "passed", json_boolean(!complaint));
    json_object_set_new(root, "complaint", complaint ? json_string(complaint) : json_null());
    json_dumpf(root, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    printf("\n");
    json_decref(root);
    return true;
}
