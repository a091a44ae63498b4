/* print_model.c - the three output formats of `lacquer stack --model`. */
#include "program/stack/stack.h"

#include <math.h>

#include "program/output.h"
#include "program/verb.h"

static const lq_model_lobe *lobes_at(const model_result *r, size_t m, int channel) {
    return r->lobes + (m * (size_t)r->channels + (size_t)channel) * lq_model_lobe_count(r->stack);
}

static const lq_stack_light *light_at(const model_result *r, size_t m, int channel) {
    return &r->light[m * (size_t)r->channels + (size_t)channel];
}

/* The last lobe is what goes through, where anything does. */
static size_t lobes_shown(const model_result *r) {
    return lq_model_lobe_count(r->stack) - (stack_is_opaque(r->stack) ? 1 : 0);
}

static const lq_turned_ggx *turned_at(const model_result *r, size_t m, int channel, size_t k) {
    if (!r->turned) return NULL;
    return r->turned + (m * (size_t)r->channels + (size_t)channel) * lq_model_lobe_count(r->stack) + k;
}

static double degrees(const lq_turned_ggx *ggx) {
    return atan2(ggx->sine, ggx->cosine) * 180.0 / 3.14159265358979323846;
}

static void print_turned(const lq_model_lobe *lobe, const lq_turned_ggx *ggx) {
    if (lobe->energy > 0.0) printf(" %8.5f %9.5f %9.5f %8.2f\n", lobe->mean, ggx->x, ggx->y, degrees(ggx));
    else printf(" %8s %9s %9s %8s\n", "-", "-", "-", "-");
}

static void print_text_lobe(const model_result *r, size_t m, int channel, size_t k) {
    const lq_model_lobe *lobe = &lobes_at(r, m, channel)[k];
    printf("%-8.6g", r->query->mu[m]);
    if (r->channels > 1) printf(" %7d", channel);
    if (k < r->stack->layer_count) printf(" %7zu", k + 1);
    else printf(" %7s", "through");
    printf("  %9.6f", lobe->energy);
    if (r->turned) print_turned(lobe, turned_at(r, m, channel, k));
    else if (lobe->energy > 0.0) printf(" %8.5f %10.4g %9.5f\n", lobe->mean, lobe->variance, lobe->alpha);
    else printf(" %8s %10s %9s\n", "-", "-", "-");
}

void model_print_text(const model_result *r) {
    printf("%-8s%s %7s  %9s %8s", "mu", r->channels > 1 ? " channel" : "", "layer", "energy", "mean");
    if (r->turned) printf(" %9s %9s %8s\n", "alpha x", "alpha y", "angle");
    else printf(" %10s %9s\n", "variance", "roughness");
    for (size_t m = 0; m < r->query->mu_count; m++)
        for (int c = 0; c < r->channels; c++)
            for (size_t k = 0; k < lobes_shown(r); k++) print_text_lobe(r, m, c, k);
}

void model_print_csv(const model_result *r) {
    printf("%s\n", stack_csv_columns);
    for (size_t m = 0; m < r->query->mu_count; m++)
        for (int c = 0; c < r->channels; c++) {
            stack_print_csv_numbers(r->query->mu[m], c, light_at(r, m, c), stack_is_opaque(r->stack));
            printf("\n");
        }
}

static json_t *lobe_json(const lq_model_lobe *lobe, size_t k, size_t layers) {
    json_t *layer = k < layers ? json_integer((json_int_t)k + 1) : json_null();
    return json_pack("{s:o, s:f, s:f, s:f, s:f}", "layer", layer, "energy", lobe->energy, "mean", lobe->mean,
                     "variance", lobe->variance, "roughness", lobe->alpha);
}

static json_t *turned_json(const lq_model_lobe *lobe, const lq_turned_ggx *ggx, size_t k, size_t layers) {
    json_t *layer = k < layers ? json_integer((json_int_t)k + 1) : json_null();
    return json_pack("{s:o, s:f, s:f, s:f, s:f, s:f}", "layer", layer, "energy", lobe->energy, "mean",
                     lobe->mean, "alpha_x", ggx->x, "alpha_y", ggx->y, "angle", degrees(ggx));
}

static json_t *lobes_json(const model_result *r, size_t m, int channel) {
    const lq_model_lobe *lobes = lobes_at(r, m, channel);
    const size_t layers = r->stack->layer_count;
    json_t *list = json_array();
    for (size_t k = 0; k < lobes_shown(r); k++)
        lq_json_append(&list, r->turned ? turned_json(&lobes[k], turned_at(r, m, channel, k), k, layers)
                                        : lobe_json(&lobes[k], k, layers));
    return list;
}

static json_t *row_json(const model_result *r, size_t m, int channel) {
    const lq_stack_light *light = light_at(r, m, channel);
    json_t *row = json_pack("{s:f, s:i, s:o, s:o}", "mu", r->query->mu[m], "channel", channel, "reflected",
                            stack_lobe_json(&light->reflected), "lobes", lobes_json(r, m, channel));
    if (!stack_is_opaque(r->stack)) lq_json_set(&row, "transmitted", stack_lobe_json(&light->transmitted));
    return row;
}

int model_print_json(const model_result *r) {
    json_t *rows = json_array();
    for (size_t m = 0; m < r->query->mu_count; m++)
        for (int c = 0; c < r->channels; c++) lq_json_append(&rows, row_json(r, m, c));
    json_t *root = json_pack("{s:o, s:s, s:s?, s:s?, s:s?, s:s?, s:o}", "stack", lq_json_text(r->stack->name),
                             "model", r->model, "variant", r->variant, "mapping", r->mapping, "first",
                             r->first_name, "tables", r->tables, "light", rows);
    return cli_print_json(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12)) ? CLI_DONE : CLI_FAILED;
}
