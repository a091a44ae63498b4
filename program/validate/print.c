/* print.c - the report of `lacquer validate`, as text and as JSON. */
#include "program/validate/validate.h"

#include "program/output.h"

#include <jansson.h>
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
    printf("\nall %zu entries: %zu not finite or out of range; %zu that stick out of their neighbours were "
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

/* JSON knows no infinity: such a number becomes null. */
static json_t *number(double x) {
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t *point_json(const validate_job *job, const validate_list *list, size_t i) {
    json_t *point = json_object();
    const lq_drawn *drawn = &list->at[i / job->channels];
    for (int a = 0; a < job->table->axis_count; a++)
        json_object_set_new(point, job->table->axes[a].name, number(drawn->at[a]));
    json_object_set_new(point, "channel", json_string(job->table->channel_names[i % job->channels]));
    json_object_set_new(point, "value", number(list->compared[i].value));
    json_object_set_new(point, "reference", number(list->compared[i].reference));
    json_object_set_new(point, "noise", number(list->compared[i].noise));
    return point;
}

static json_t *list_json(const validate_job *job, const validate_list *list, bool scored) {
    const lq_comparison *r = &list->result;
    json_t *root =
        json_pack("{s:I, s:o, s:o, s:o, s:o}", "count", (json_int_t)r->count, "max", number(r->max), "rms",
                  number(r->rms), "bias", number(r->mean), "p99", number(r->p99));
    json_object_set_new(root, "worst", point_json(job, list, r->worst));
    if (list->judged) json_object_set_new(root, "explained", json_boolean(r->explained));
    if (!scored) return root;
    json_object_set_new(root, "z_max", number(r->z_max));
    json_object_set_new(root, "z_limit", number(r->z_limit));
    json_object_set_new(root, "z_bias", number(r->z_bias));
    json_object_set_new(root, "z2", number(r->z2));
    json_object_set_new(root, "beyond4", json_integer((json_int_t)r->beyond4));
    json_object_set_new(root, "beyond4_expected", number(r->beyond4_expected));
    json_object_set_new(root, "z_worst", point_json(job, list, r->z_worst));
    return root;
}

bool validate_print_json(const validate_job *job) {
    json_t *root =
        json_pack("{s:s, s:s, s:s, s:f, s:I, s:I}", "file", job->request.file, "table", job->origin.kind->id,
                  "ndf", job->origin.settings.ndf, "tolerance", job->origin.settings.tolerance, "points",
                  (json_int_t)job->request.points, "seed", (json_int_t)job->request.seed);
    if (!root) return false;
    if (job->request.walk)
        json_object_set_new(root, "samples", json_integer((json_int_t)job->request.samples));
    if (job->request.budget > 0.0) json_object_set_new(root, "budget", json_real(job->request.budget));
    for (int k = 0; k < VALIDATE_LISTS; k++)
        if (job->lists[k].used)
            json_object_set_new(root, job->lists[k].key, list_json(job, &job->lists[k], k >= STORED_WALK));
    json_object_set_new(root, "entries",
                        json_pack("{s:I, s:I, s:I}", "looked_at", (json_int_t)job->entries.looked_at,
                                  "faults", (json_int_t)job->entries.faults, "sticking_out",
                                  (json_int_t)job->suspects));
    const char *complaint = validate_complaint(job);
    json_object_set_new(root, "passed", json_boolean(!complaint));
    json_object_set_new(root, "complaint", complaint ? json_string(complaint) : json_null());
    json_dumpf(root, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    printf("\n");
    json_decref(root);
    return true;
}
