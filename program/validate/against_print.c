/* against_print.c - the report of `lacquer validate --against FILE`, as text and as JSON. */
#include "program/validate/against.h"

#include "program/output.h"

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

static json_t *worst_json(const against_job *job, int c) {
    json_t *worst = json_object();
    for (int a = 0; a < job->other->axis_count; a++)
        lq_json_set(&worst, job->other->axes[a].name, lq_json_number(job->worst_at[c].at[a]));
    lq_json_set(&worst, "value", lq_json_number(job->worst_pair[c].value));
    lq_json_set(&worst, "reference", lq_json_number(job->worst_pair[c].reference));
    return worst;
}

static json_t *pattern_json(const against_job *job, const lq_pattern *p) {
    json_t *correlation = json_object();
    for (int a = 0; a < job->other->axis_count; a++)
        lq_json_set(&correlation, job->other->axes[a].name, lq_json_number(p->correlation[a]));
    return json_pack("{s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:s}", "spots", (json_int_t)p->spots, "zeros",
                     (json_int_t)p->zeros, "outliers", (json_int_t)p->outliers, "rms", lq_json_number(p->rms),
                     "mean", lq_json_number(p->mean), "correlation", correlation, "independent",
                     lq_json_number(p->independent), "z_mean", lq_json_number(p->z_mean), "looks_like",
                     lq_verdict_text(p->verdict));
}

static json_t *channel_json(const against_job *job, int c) {
    const lq_comparison *r = &job->result[c];
    json_t *root = json_pack("{s:o, s:o, s:o, s:o, s:o}", "max", lq_json_number(r->max), "rms",
                             lq_json_number(r->rms), "mean", lq_json_number(r->mean), "p99",
                             lq_json_number(r->p99), "worst", worst_json(job, c));
    if (job->patterned) lq_json_set(&root, "pattern", pattern_json(job, &job->pattern[c]));
    return root;
}

static json_t *variants_json(const lq_variants *variants) {
    json_t *list = json_array();
    for (size_t i = 0; i < variants->count; i++)
        lq_json_append(&list, json_pack("{s:o, s:o}", "what", lq_json_text(variants->list[i].what), "rms",
                                        lq_json_number(variants->list[i].rms)));
    return list;
}

bool against_print_json(const against_job *job) {
    json_t *root = json_pack(
        "{s:o, s:s, s:o, s:I}", "file", lq_json_text(job->request->file), "table", job->origin.kind->id,
        "against", lq_json_text(job->file ? job->other_name : "exact"), "entries", (json_int_t)job->entries);
    for (int c = 0; c < job->other->channel_count; c++)
        lq_json_set(&root, job->other->channel_names[c], channel_json(job, c));
    const char *complaint = against_complaint(job);
    if (job->variants.count > 0) lq_json_set(&root, "definitions", variants_json(&job->variants));
    if (job->variants.other)
        lq_json_set(&root, "looks_like_definition", lq_json_text(job->variants.list[0].what));
    lq_json_set(&root, "passed", json_boolean(!complaint));
    lq_json_set(&root, "complaint", complaint ? lq_json_text(complaint) : json_null());
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
}
