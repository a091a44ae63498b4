/* print.c - the three output formats of `lacquer stack`. */
#include "program/stack/stack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "program/message.h"
#include "program/output.h"
#include "program/verb.h"

bool stack_is_opaque(const lq_stack *stack) {
    return stack->layers[stack->layer_count - 1].type != LQ_LAYER_DIELECTRIC;
}

static size_t paths_of(const stack_result *r) {
    return r->query->paths ? r->query->paths : 1;
}

static const lq_stack_light *light_at(const stack_result *r, size_t m, int channel, size_t path) {
    return &r->light[(m * (size_t)r->channels + (size_t)channel) * paths_of(r) + path];
}

/* ======================================================================================
 *                                         CSV
 * ====================================================================================== */

static void print_csv_moments(const lq_stack_lobe *lobe) {
    if (lobe->energy > 0.0) printf(",%.9g,%.9g,%.9g", lobe->sin2, lobe->mean, lobe->across);
    else printf(",,,");
}

const char stack_csv_columns[] =
    "mu,channel,reflected,transmitted,sin2,mean,across,transmitted_sin2,transmitted_mean,transmitted_across,"
    "error";

void stack_print_csv_numbers(double mu, int channel, const lq_stack_light *light, bool opaque) {
    printf("%.15g,%d,%.9g,", mu, channel, light->reflected.energy);
    if (!opaque) printf("%.9g", light->transmitted.energy);
    print_csv_moments(&light->reflected);
    print_csv_moments(&light->transmitted);
    printf(",");
}

static void print_csv_row(const stack_result *r, size_t m, int channel, size_t path) {
    const lq_stack_light *light = light_at(r, m, channel, path);
    stack_print_csv_numbers(r->query->mu[m], channel, light, stack_is_opaque(r->stack));
    printf("%.2g", light->error);
    if (r->query->paths) printf(",%zu", path + 1);
    printf("\n");
}

void stack_print_csv(const stack_result *r) {
    printf("%s%s\n", stack_csv_columns, r->query->paths ? ",path" : "");
    for (size_t m = 0; m < r->query->mu_count; m++)
        for (int c = 0; c < r->channels; c++)
            for (size_t p = 0; p < paths_of(r); p++) print_csv_row(r, m, c, p);
}

/* ======================================================================================
 *                                         Text
 * ====================================================================================== */

static void print_text_lobe(const lq_stack_lobe *lobe) {
    if (lobe->energy > 0.0)
        printf("  %9.6f %8.5f %8.5f %8.5f", lobe->energy, lobe->sin2, lobe->mean, lobe->across);
    else printf("  %9.6f %8s %8s %8s", lobe->energy, "-", "-", "-");
}

void stack_print_text(const stack_result *r) {
    const bool opaque = stack_is_opaque(r->stack);
    const bool rgb = r->channels > 1, paths = r->query->paths;
    printf("%-8s%s%s  %9s %8s %8s %8s", "mu", rgb ? " channel" : "", paths ? " path" : "", "reflected",
           "sin2", "mean", "across");
    if (!opaque) printf("  %9s %8s %8s %8s", "transm.", "sin2", "mean", "across");
    printf("  %7s\n", "error");
    for (size_t m = 0; m < r->query->mu_count; m++)
        for (int c = 0; c < r->channels; c++)
            for (size_t p = 0; p < paths_of(r); p++) {
                const lq_stack_light *light = light_at(r, m, c, p);
                printf("%-8.6g", r->query->mu[m]);
                if (rgb) printf(" %7d", c);
                if (paths) printf(" %4zu", p + 1);
                print_text_lobe(&light->reflected);
                if (!opaque) print_text_lobe(&light->transmitted);
                printf("  %7.1e\n", light->error);
            }
}

/* ======================================================================================
 *                                         JSON
 * ====================================================================================== */

json_t *stack_lobe_json(const lq_stack_lobe *lobe) {
    if (!(lobe->energy > 0.0)) return json_pack("{s:f}", "energy", 0.0);
    return json_pack("{s:f, s:f, s:f, s:f}", "energy", lobe->energy, "sin2", lobe->sin2, "mean", lobe->mean,
                     "across", lobe->across);
}

static json_t *row_json(const stack_result *r, size_t m, int channel, size_t path) {
    const lq_stack_light *light = light_at(r, m, channel, path);
    const bool opaque = stack_is_opaque(r->stack);
    json_t *row = json_pack("{s:f, s:i, s:o, s:f}", "mu", r->query->mu[m], "channel", channel, "reflected",
                            stack_lobe_json(&light->reflected), "error", light->error);
    if (!opaque) lq_json_set(&row, "transmitted", stack_lobe_json(&light->transmitted));
    if (r->query->paths) lq_json_set(&row, "path", json_integer((json_int_t)path + 1));
    return row;
}

int stack_print_json(const stack_result *r) {
    json_t *rows = json_array();
    for (size_t m = 0; m < r->query->mu_count; m++)
        for (int c = 0; c < r->channels; c++)
            for (size_t p = 0; p < paths_of(r); p++) lq_json_append(&rows, row_json(r, m, c, p));
    json_t *root = json_pack("{s:o, s:s, s:s, s:o}", "stack", lq_json_text(r->stack->name), "from",
                             r->query->from_below ? "below" : "above", "interfaces",
                             r->query->single ? "single" : "all", "light", rows);
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12)) ? CLI_DONE : CLI_FAILED;
}
