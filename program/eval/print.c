/* print.c - the three output formats of `lacquer eval`. */
#include "program/eval/eval.h"

#include "program/message.h"
#include "program/output.h"
#include "program/verb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FEWEST_DIGITS = 9, MOST_DIGITS = 15 };

void eval_format_value(char *text, double value, double estimate) {
    int digits = FEWEST_DIGITS;
    if (estimate > 0) digits = (int)fmax(digits, fmin(MOST_DIGITS, ceil(-log10(estimate)) + 1));
    snprintf(text, EVAL_NUMBER_SIZE, "%.*g", digits, value);
}

void eval_format_estimate(char *text, double estimate) {
    snprintf(text, EVAL_NUMBER_SIZE, "%.1e", estimate);
    if (estimate <= 0) snprintf(text, EVAL_NUMBER_SIZE, "0");
    if (strtod(text, NULL) >= estimate) return;
    double last_digit = pow(10, floor(log10(estimate)) - 1);
    snprintf(text, EVAL_NUMBER_SIZE, "%.1e", estimate + last_digit / 2);
}

void eval_print_text(const eval_source *source, const eval_result *result) {
    char value[EVAL_NUMBER_SIZE], estimate[EVAL_NUMBER_SIZE];
    eval_format_estimate(estimate, result->estimate);
    for (int i = 0; i < source->channel_count; i++) {
        eval_format_value(value, result->values[i], result->estimate);
        if (source->channel_count > 1) printf("%s ", source->channels[i]);
        if (source->kind) printf("%s ± %s\n", value, estimate);
        else printf("%s\n", value);
    }
}

void eval_print_csv_header(const eval_source *source) {
    for (int i = 0; i < source->channel_count; i++)
        printf(",%s", source->channel_count > 1 ? source->channels[i] : "value");
    printf("%s\n", source->kind ? ",error" : "");
}

void eval_print_csv_result(const eval_source *source, const eval_result *result) {
    char text[EVAL_NUMBER_SIZE];
    for (int i = 0; i < source->channel_count; i++) {
        eval_format_value(text, result->values[i], result->estimate);
        printf(",%s", text);
    }
    eval_format_estimate(text, result->estimate);
    if (source->kind) printf(",%s", text);
    printf("\n");
}

/* ======================================================================================
 *                                         JSON
 * ====================================================================================== */

static json_t *source_json(const eval_source *source) {
    const lq_settings *settings = &source->settings;
    if (!source->kind) return json_pack("{s:o}", "file", lq_json_text(source->path));
    json_t *root = json_pack("{s:s, s:o}", "table", source->kind->id, "ndf", lq_json_text(settings->ndf));
    if (source->kind->takes & LQ_TAKES_SCATTERING)
        lq_json_set(&root, "scattering",
                    lq_json_text(settings->scattering == LQ_SINGLE ? "single" : "multiple"));
    if (source->kind->takes & LQ_TAKES_MASKING)
        lq_json_set(&root, "masking",
                    lq_json_text(settings->masking == LQ_SEPARABLE ? "separable" : "correlated"));
    return root;
}

static void add_values(json_t **root, const eval_source *source, const eval_result *result) {
    json_t *values = json_object();
    for (int i = 0; i < source->channel_count; i++)
        lq_json_set(&values, source->channels[i], lq_json_number(result->values[i]));
    if (source->channel_count == 1)
        lq_json_set(root, "value", json_incref(json_object_get(values, source->channels[0])));
    else lq_json_set(root, "values", json_incref(values));
    json_decref(values);
    if (!source->kind) return;
    lq_json_set(root, "error", lq_json_number(result->estimate));
    lq_json_set(root, "converged", json_boolean(result->status == LQ_OK));
}

int eval_print_json(const eval_source *source, const eval_point *point, const eval_result *result) {
    json_t *root = source_json(source), *at = json_object();
    for (int i = 0; i < source->axis_count; i++)
        lq_json_set(&at, source->axes[i].name, lq_json_number(point->at[i]));
    lq_json_set(&root, "point", at);
    add_values(&root, source, result);
    return cli_print_json(root, JSON_REAL_PRECISION(MOST_DIGITS)) ? CLI_DONE : CLI_FAILED;
}
