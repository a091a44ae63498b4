/* The result of a fit as JSON, and the curve itself as a table. */
#include "program/fit/bounces.h"
#include "program/message.h"
#include "system/json.h"
#include "system/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static json_t *errors_json(const fit_errors *errors) {
    return json_pack("{s:o, s:o, s:o}", "rms", lq_json_number(errors->rms), "max",
                     lq_json_number(errors->max), "max-at", lq_json_number(errors->max_at));
}

static json_t *coefficients(const lq_family *family, const double *p) {
    json_t *object = json_object();
    for (int k = 0; k < family->parameters; k++) {
        const char name[2] = {family->names[k], '\0'};
        lq_json_set(&object, name, lq_json_number(p[k]));
    }
    return object;
}

static json_t *covariance(const lq_family *family, const lq_fit_answer *answer) {
    json_t *rows = json_array();
    for (int i = 0; i < family->parameters; i++) {
        json_t *row = json_array();
        for (int k = 0; k < family->parameters; k++)
            lq_json_append(&row, lq_json_number(answer->covariance[i * LQ_FAMILY_PARAMETERS + k]));
        lq_json_append(&rows, row);
    }
    return rows;
}

static json_t *describe(const fit_job *job) {
    const lq_family *family = lq_family_at(job->request.family);
    json_t *root = json_object();
    lq_json_set(&root, "lacquer", lq_json_text(LQ_VERSION));
    lq_json_set(&root, "mapping", lq_json_text(lq_mapping_name(job->request.mapping)));
    lq_json_set(&root, "ndf", lq_json_text(lq_ndf_text(job->ndf)));
    lq_json_set(&root, "family", lq_json_text(family->name));
    lq_json_set(&root, "formula", lq_json_text(family->formula));
    lq_json_set(&root, "inverse", family->inverse ? lq_json_text(family->inverse) : json_null());
    lq_json_set(&root, "range", json_pack("[f, f]", job->request.low, job->request.high));
    lq_json_set(&root, "points", json_integer((json_int_t)job->count));
    lq_json_set(&root, "norm", lq_json_text(job->request.smallest_rms ? "rms" : "max"));
    lq_json_set(&root, "coefficients", coefficients(family, job->answer.p));
    lq_json_set(&root, "covariance", covariance(family, &job->answer));
    lq_json_set(&root, "iterations", json_integer(job->answer.iterations));
    lq_json_set(&root, "relative-error", errors_json(&job->errors));
    if (job->published >= 0) {
        const lq_family *paper = lq_family_at(job->published);
        lq_json_set(&root, "published",
                    json_pack("{s:s, s:s, s:o, s:o}", "source", paper->source, "formula", paper->formula,
                              "coefficients", coefficients(paper, job->published_p), "relative-error",
                              errors_json(&job->published_errors)));
    }
    return root;
}

static bool write_root(const fit_job *job, json_t *root) {
    char *text = lq_json_dump(root, JSON_INDENT(2) | JSON_REAL_PRECISION(10));
    lq_error error = {"no memory for the result"};
    lq_output *output = NULL;
    lq_status status = text ? lq_output_open(&output, job->request.output, &error) : LQ_NO_MEMORY;
    if (status == LQ_OK && (status = lq_output_print(output, &error, "%s\n", text)) == LQ_OK)
        status = lq_output_commit(output, &error);
    else lq_output_abandon(output);
    free(text);
    return status == LQ_OK || (cli_fail_status(status, &error), false);
}

bool fit_write_json(const fit_job *job) {
    return write_root(job, describe(job));
}

bool fit_write_rows(const fit_job *job, const char *table, size_t samples, json_t *rows) {
    return write_root(job, json_pack("{s:s, s:s, s:o, s:I, s:o}", "lacquer", LQ_VERSION, "table", table,
                                     "ndf", lq_json_text(lq_ndf_text(job->ndf)), "samples",
                                     (json_int_t)samples, "rows", rows));
}

/* f over alpha as log2 f, and its inverse: alpha over log2 f. Linear filtering between the nodes is within
 * 0.1 % of f on [1e-3, 0.95]. */
static lq_status fill(const fit_job *job, lq_table *table, bool inverse) {
    for (size_t i = 0; i < table->axes[0].size; i++) {
        const double at = table->axes[0].nodes[i];
        table->channels[0][i] =
            (float)(inverse ? lq_curve_inverse(&job->curve, exp2(at)) : log2(lq_curve_f(&job->curve, at)));
    }
    lq_status status = lq_table_set_fact(table, "ndf", lq_ndf_text(job->ndf), NULL);
    if (status == LQ_OK)
        status =
            lq_table_set_fact(table, "mapping", inverse ? "alpha over log2 f" : "log2 f over alpha", NULL);
    if (status == LQ_OK) status = lq_table_set_fact(table, "version", LQ_VERSION, NULL);
    return status;
}

static lq_status write_table(const fit_job *job, bool inverse, const char *path, lq_error *error) {
    const double low = 1e-3 * job->curve.pole, high = 0.95 * job->curve.pole;
    static const char *const names[] = {"log2-f", "alpha"};
    const char *channel = names[inverse];
    lq_axis axis = {.nodes = NULL};
    lq_table *table = NULL;
    lq_status status =
        inverse ? lq_axis_make(&axis, "log2-f", log2(lq_curve_f(&job->curve, low)),
                               log2(lq_curve_f(&job->curve, high)), 4096, LQ_MAP_LINEAR, 1.0, error)
                : lq_axis_make(&axis, "alpha", low, high, 4096, LQ_MAP_POWER, 2.0, error);
    if (status == LQ_OK) status = lq_table_create(&table, &axis, 1, &channel, 1, error);
    if (status == LQ_OK) status = fill(job, table, inverse);
    const size_t length = strlen(path);
    const bool npy = length > 4 && strcmp(path + length - 4, ".npy") == 0;
    if (status == LQ_OK) status = (npy ? lq_table_write_npy : lq_table_write_exr)(table, path, error);
    lq_table_free(table);
    lq_axis_free(&axis);
    return status;
}

bool fit_write_texture(const fit_job *job) {
    char other[1024];
    const char *path = job->request.texture, *dot = strrchr(path, '.');
    const int stem = (int)(dot ? dot - path : (long)strlen(path));
    snprintf(other, sizeof other, "%.*s-inverse%s", stem, path, dot ? dot : "");
    lq_error error = {""};
    lq_status status = write_table(job, false, path, &error);
    if (status == LQ_OK) status = write_table(job, true, other, &error);
    return status == LQ_OK || (cli_fail_status(status, &error), false);
}
