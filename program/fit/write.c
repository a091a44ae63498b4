/* The result of a fit as JSON, and the curve itself as a table. */
#include "program/fit/bounces.h"
#include "program/message.h"
#include "system/output.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *errors_json(const fit_errors *errors) {
    return json_pack("{s:o, s:o, s:o}", "rms", number(errors->rms), "max", number(errors->max), "max-at",
                     number(errors->max_at));
}

static json_t *coefficients(const lq_family *family, const double *p) {
    json_t *object = json_object();
    for (int k = 0; k < family->parameters; k++) {
        const char name[2] = {family->names[k], '\0'};
        json_object_set_new(object, name, number(p[k]));
    }
    return object;
}

static json_t *covariance(const lq_family *family, const lq_fit_answer *answer) {
    json_t *rows = json_array();
    for (int i = 0; i < family->parameters; i++) {
        json_t *row = json_array();
        for (int k = 0; k < family->parameters; k++)
            json_array_append_new(row, number(answer->covariance[i * LQ_FAMILY_PARAMETERS + k]));
        json_array_append_new(rows, row);
    }
    return rows;
}

static json_t *describe(const fit_job *job) {
    const lq_family *family = lq_family_at(job->request.family);
    json_t *root = json_object();
    json_object_set_new(root, "lacquer", json_string(LQ_VERSION));
    json_object_set_new(root, "mapping", json_string(lq_mapping_name(job->request.mapping)));
    json_object_set_new(root, "ndf", json_string(lq_ndf_text(job->ndf)));
    json_object_set_new(root, "family", json_string(family->name));
    json_object_set_new(root, "formula", json_string(family->formula));
    json_object_set_new(root, "inverse", family->inverse ? json_string(family->inverse) : json_null());
    json_object_set_new(root, "range", json_pack("[f, f]", job->request.low, job->request.high));
    json_object_set_new(root, "points", json_integer((json_int_t)job->count));
    json_object_set_new(root, "norm", json_string(job->request.smallest_rms ? "rms" : "max"));
    json_object_set_new(root, "coefficients", coefficients(family, job->answer.p));
    json_object_set_new(root, "covariance", covariance(family, &job->answer));
    json_object_set_new(root, "iterations", json_integer(job->answer.iterations));
    json_object_set_new(root, "relative-error", errors_json(&job->errors));
    if (job->published >= 0) {
        const lq_family *paper = lq_family_at(job->published);
        json_object_set_new(root, "published",
                            json_pack("{s:s, s:s, s:o, s:o}", "source", paper->source, "formula",
                                      paper->formula, "coefficients", coefficients(paper, job->published_p),
                                      "relative-error", errors_json(&job->published_errors)));
    }
    return root;
}

static bool write_root(const fit_job *job, json_t *root) {
    char *text = root ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(10)) : NULL;
    json_decref(root);
    lq_error error = {"the result is not valid UTF-8"};
    lq_output *output = NULL;
    lq_status status = text ? lq_output_open(&output, job->request.output, &error) : LQ_BAD_INPUT;
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
    return write_root(job,
                      json_pack("{s:s, s:s, s:s, s:I, s:o}", "lacquer", LQ_VERSION, "table", table, "ndf",
                                lq_ndf_text(job->ndf), "samples", (json_int_t)samples, "rows", rows));
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
