/* print.c - the report of `lacquer validate`, as text and as JSON. */
#include "program/validate/validate.h"

#include "program/output.h"

#include <math.h>
#include <stdio.h>

/* ======================================================================================
 *                                         Text
 * ====================================================================================== */

static void print_head(const validate_job *job) {
    char what[128];
    lq_origin_describe(job->origin.kind, &job->origin.settings, what, sizeof what);
    printf("%s: %s, tolerance %g\n", cli_basename(job->request.file), what, job->origin.settings.tolerance);
    for (int i = 0; i < job->table->axis_count; i++)
        printf("%s%s %zu", i ? " x " : "", job->table->axes[i].name, job->table->axes[i].size);
    printf(" nodes; %zu stored entries and %zu points between them, seed %zu", job->stored, job->between,
           job->request.seed);
    if (job->request.walk) printf(", walks of %zu samples", job->request.samples);
    printf("\n\n");
}

static void print_point(const validate_job *job, const validate_list *list, size_t i) {
    const lq_drawn *drawn = &list->at[i / job->channels];
    for (int a = 0; a < job->table->axis_count; a++)
        printf(" %s=%.6g", job->table->axes[a].name, drawn->at[a]);
    if (job->channels > 1) printf(" %s", job->table->channel_names[i % job->channels]);
}

static void print_errors(const validate_job *job) {
    printf("%-22s %9s %9s %9s %9s  worst point: first, second\n", "first - second", "max", "rms", "bias",
           "p99");
    for (int k = 0; k < VALIDATE_LISTS; k++) {
        const validate_list *list = &job->lists[k];
        const lq_comparison *r = &list->result;
        if (!list->used) continue;
        printf("%-22s %9.2e %9.2e %9.1e %9.2e ", list->title, r->max, r->rms, r->mean, r->p99);
        print_point(job, list, r->worst);
        printf(": %.7f, %.7f\n", list->compared[r->worst].value, list->compared[r->worst].reference);
    }
}

static void print_scores(const validate_job *job) {
    printf("\n%-22s %9s %9s %9s %9s  worst point: first, second +- noise\n", "in standard errors", "max |z|",
           "mean z^2", "bias z", "|z| > 4");
    for (int k = STORED_WALK; k < VALIDATE_LISTS; k++) {
        const validate_list *list = &job->lists[k];
        const lq_comparison *r = &list->result;
        const lq_compared *worst = &list->compared[r->z_worst];
        printf("%-22s %9.2f %9.2f %9.2f %9zu ", list->title, r->z_max, r->z2, r->z_bias, r->beyond4);
        print_point(job, list, r->z_worst);
        printf(": %.7f, %.7f +- %.1e\n", worst->value, worst->reference, worst->noise);
    }
    const lq_comparison *r = &job->lists[STORED_WALK].result;
    printf(
        "expected by chance: max |z| and |bias z| below %.2f (all of them, in all but 1 of %.0f reports),\n"
        "mean z^2 at most 1, |z| > 4 at %.2g points of a list\n",
        r->z_limit, 1.0 / LQ_FALSE_ALARM, r->beyond4_expected);
}

void validate_print_text(const validate_job *job) {
    print_head(job);
    print_errors(job);
    if (job->request.walk) print_scores(job);
    printf("\nall %zu values: %zu not finite or out of range; %zu that stick out of their neighbours were "
           "compared\n",
           job->entries.looked_at, job->entries.faults, job->suspects);
    const char *complaint = validate_complaint(job);
    printf("\n%s%s", complaint ? "FAILED: " : "passed", complaint ? complaint : "");
    if (job->request.budget > 0.0) printf(", budget %g", job->request.budget);
    printf("\n");
}

/* ======================================================================================
 *                                         JSON
 * ====================================================================================== */

static json_t *point_json(const validate_job *job, const validate_list *list, size_t i) {
    json_t *point = json_object();
    const lq_drawn *drawn = &list->at[i / job->channels];
    for (int a = 0; a < job->table->axis_count; a++)
        lq_json_set(&point, job->table->axes[a].name, lq_json_number(drawn->at[a]));
    lq_json_set(&point, "channel", lq_json_text(job->table->channel_names[i % job->channels]));
    lq_json_set(&point, "value", lq_json_number(list->compared[i].value));
    lq_json_set(&point, "reference", lq_json_number(list->compared[i].reference));
    lq_json_set(&point, "noise", lq_json_number(list->compared[i].noise));
    return point;
}

static json_t *list_json(const validate_job *job, const validate_list *list, bool scored) {
    const lq_comparison *r = &list->result;
    json_t *root = json_pack("{s:I, s:o, s:o, s:o, s:o}", "count", (json_int_t)r->count, "max",
                             lq_json_number(r->max), "rms", lq_json_number(r->rms), "bias",
                             lq_json_number(r->mean), "p99", lq_json_number(r->p99));
    lq_json_set(&root, "worst", point_json(job, list, r->worst));
    if (list->judged) lq_json_set(&root, "explained", json_boolean(r->explained));
    if (!scored) return root;
    lq_json_set(&root, "z_max", lq_json_number(r->z_max));
    lq_json_set(&root, "z_limit", lq_json_number(r->z_limit));
    lq_json_set(&root, "z_bias", lq_json_number(r->z_bias));
    lq_json_set(&root, "z2", lq_json_number(r->z2));
    lq_json_set(&root, "beyond4", json_integer((json_int_t)r->beyond4));
    lq_json_set(&root, "beyond4_expected", lq_json_number(r->beyond4_expected));
    lq_json_set(&root, "z_worst", point_json(job, list, r->z_worst));
    return root;
}

bool validate_print_json(const validate_job *job) {
    json_t *root = json_pack("{s:o, s:s, s:o, s:f, s:I, s:I}", "file", lq_json_text(job->request.file),
                             "table", job->origin.kind->id, "ndf", lq_json_text(job->origin.settings.ndf),
                             "tolerance", job->origin.settings.tolerance, "points",
                             (json_int_t)job->request.points, "seed", (json_int_t)job->request.seed);
    if (job->request.walk) lq_json_set(&root, "samples", json_integer((json_int_t)job->request.samples));
    if (job->request.budget > 0.0) lq_json_set(&root, "budget", lq_json_number(job->request.budget));
    for (int k = 0; k < VALIDATE_LISTS; k++)
        if (job->lists[k].used)
            lq_json_set(&root, job->lists[k].key, list_json(job, &job->lists[k], k >= STORED_WALK));
    lq_json_set(&root, "values",
                json_pack("{s:I, s:I, s:I}", "looked_at", (json_int_t)job->entries.looked_at, "faults",
                          (json_int_t)job->entries.faults, "sticking_out", (json_int_t)job->suspects));
    const char *complaint = validate_complaint(job);
    lq_json_set(&root, "passed", json_boolean(!complaint));
    lq_json_set(&root, "complaint", complaint ? lq_json_text(complaint) : json_null());
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
}
