/* layered_report.c - figures as CSV and JSON, curves as pictures, and the page that shows all of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/draw.h"
#include "system/status.h"
#include "system/stream.h"
#include "validate/layered_page.h"
#include "validate/layered_rows.h"

static const char *const sides[LQ_GONIO_SIDES] = {"reflected", "transmitted"};
static const char *const parts[LQ_PARTS] = {"direct", "rest"};

static double number(json_t *object, const char *key) {
    json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

/* Nothing where there is no number. */
static void put(FILE *out, double value) {
    if (isfinite(value)) fprintf(out, ",%.9g", value);
    else fputs(",", out);
}

static lq_status open_in(const lq_layered_request *r, const char *name, lq_stream *stream, lq_error *error) {
    char path[5000];
    snprintf(path, sizeof path, "%.4000s/%s", r->folder, name);
    return lq_stream_open(stream, path, error);
}

/* ======================================================================================
 *                                         CSV
 * ====================================================================================== */

static void put_key(FILE *out, const lq_layered_row *row) {
    fprintf(out, "%s,%s,%g,%s,%s", row->stack, row->category, row->theta, sides[row->side], row->model);
}

static void put_errors(void *user, const lq_layered_row *row) {
    FILE *out = user;
    json_t *of = json_object_get(row->figures, "rmse");
    if (row->curve) return;
    put_key(out, row);
    put(out, number(of, "all"));
    put(out, number(of, "rest"));
    put(out, number(of, "all_noise"));
    put(out, number(of, "rest_noise"));
    fputs(row->refused ? ",refused\n" : ",\n", out);
}

static void put_lobe(FILE *out, json_t *model, json_t *exact) {
    static const char *const keys[] = {"energy", "sin2", "mean", "across"};
    for (int k = 0; k < 4; k++) {
        put(out, number(model, keys[k]));
        put(out, number(exact, keys[k]));
    }
}

static void put_lobes(void *user, const lq_layered_row *row) {
    FILE *out = user;
    json_t *lobes = json_object_get(row->figures, "lobes");
    if (row->refused) return;
    for (int part = 0; part < LQ_PARTS; part++) {
        json_t *exact = json_object_get(row->exact, parts[part]);
        for (size_t c = 0; c < json_array_size(exact); c++) {
            put_key(out, row);
            fprintf(out, ",%s,%zu", parts[part], c);
            put_lobe(out, json_array_get(json_object_get(lobes, parts[part]), c), json_array_get(exact, c));
            fputs("\n", out);
        }
    }
}

static void put_points(void *user, const lq_layered_row *row) {
    FILE *out = user;
    json_t *point = json_object_get(row->figures, "point");
    if (!row->curve) return;
    put_key(out, row);
    put(out, row->first);
    put(out, number(point, "energy"));
    put(out, number(row->exact, "energy"));
    put(out, number(point, "alpha"));
    put(out, number(row->exact, "alpha"));
    fputs("\n", out);
}

static lq_status write_csv(const lq_layered_request *r, json_t *figures, const char *name, const char *head,
                           lq_layered_take *take, lq_error *error) {
    lq_stream stream;
    lq_status status = open_in(r, name, &stream, error);
    if (status != LQ_OK) return status;
    fprintf(stream.out, "stack,category,theta,side,model%s\n", head);
    lq_layered_rows(figures, take, stream.out);
    return lq_stream_close(&stream, LQ_OK, error);
}

/* ======================================================================================
 *                                        Curves
 * ====================================================================================== */

/* Series of one line over its first parameter: the models, then what is exact. */
typedef struct curve {
    const char *base;
    size_t points, models, last;
    double x[LQ_LAYERED_MAX];
    float *y; /* [series * LQ_LAYERED_MAX + point] */
} curve;

static void take_point(void *user, const lq_layered_row *row) {
    curve *c = user;
    if (!row->curve || strcmp(row->base, c->base) != 0) return;
    if (c->points == 0 || c->last != row->stack_index) c->x[c->points++] = row->first;
    c->last = row->stack_index;
    const size_t at = c->points - 1;
    c->y[row->model_index * LQ_LAYERED_MAX + at] =
        (float)number(json_object_get(row->figures, "point"), "alpha");
    c->y[c->models * LQ_LAYERED_MAX + at] = (float)number(row->exact, "alpha");
}

/* Evenly where the points are, so that what is a line looks like one. */
static lq_status curve_axis(const curve *c, lq_axis *axis, lq_error *error) {
    const double first = c->x[0], last = c->x[c->points - 1];
    bool even = true;
    for (size_t i = 0; i < c->points; i++)
        even &= fabs(c->x[i] - first - (last - first) * (double)i / (double)(c->points - 1)) < 1e-9;
    return even ? lq_axis_make(axis, "alpha0", first, last, c->points, LQ_MAP_LINEAR, 0.0, error)
                : lq_axis_make_custom(axis, "alpha0", c->x, c->points, error);
}

/* Legends are narrow: of a long name what it departs by. */
static const char *short_name(const char *label) {
    const char *change = strchr(label, '+');
    return change && strlen(label) > 12 ? change : label;
}

static lq_status draw_curve(const lq_layered_request *r, const curve *c, lq_error *error) {
    const char *names[LQ_LAYERED_MODELS + 1];
    char path[5000];
    float *values = malloc((c->models + 1) * c->points * sizeof *values);
    lq_axis axis = {.size = 0};
    lq_figure *figure = NULL;
    lq_status status =
        values ? curve_axis(c, &axis, error) : lq_fail(error, LQ_NO_MEMORY, "no memory for a curve");
    for (size_t i = 0; i <= c->models; i++) {
        names[i] = i < c->models ? short_name(r->models[i].label) : "exact";
        for (size_t k = 0; values && k < c->points; k++)
            values[i * c->points + k] = c->y[i * LQ_LAYERED_MAX + k];
    }
    if (status == LQ_OK)
        status = lq_figure_create(&figure, c->base, "light that was inside, normal incidence", error);
    const lq_panel_parts panel = {.form = LQ_PANEL_LINES,
                                  .title = "equivalent roughness over that of the top",
                                  .quantity = "roughness",
                                  .x = &axis,
                                  .series_count = c->models + 1,
                                  .series = names,
                                  .values = values,
                                  .range = (const double[]){0.0, 1.0},
                                  .reference = true};
    if (status == LQ_OK) status = lq_figure_add(figure, &panel, error);
    snprintf(path, sizeof path, "%.4000s/%.200s.png", r->folder, c->base);
    if (status == LQ_OK) status = lq_draw_write(figure, LQ_IMAGE_PNG, path, error);
    lq_figure_free(figure);
    lq_axis_free(&axis);
    free(values);
    return status;
}

static lq_status draw_curves(const lq_layered_request *r, json_t *figures, lq_error *error) {
    const lq_layered_set *set = r->set;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < set->count && status == LQ_OK; i++) {
        const lq_layered_stack *stack = &set->stacks[i];
        if (strcmp(stack->category, "curves") != 0) continue;
        if (i > 0 && strcmp(set->stacks[i - 1].base, stack->base) == 0) continue;
        curve *c = calloc(1, sizeof *c);
        float *y = calloc((r->model_count + 1) * LQ_LAYERED_MAX, sizeof *y);
        if (c && y) {
            *c = (curve){.base = stack->base, .models = r->model_count, .y = y};
            lq_layered_rows(figures, take_point, c);
            status = c->points > 1 ? draw_curve(r, c, error) : LQ_OK;
        } else status = lq_fail(error, LQ_NO_MEMORY, "no memory for a curve");
        free(y);
        free(c);
    }
    return status;
}

/* ======================================================================================
 *                                     All of them
 * ====================================================================================== */

static lq_status write_json(const lq_layered_request *r, json_t *figures, lq_error *error) {
    char path[5000];
    char *text = lq_json_dump(json_pack("{s:s, s:O}", "set", r->set->name, "stacks", figures),
                              JSON_INDENT(1) | JSON_REAL_PRECISION(17));
    if (!text) return lq_fail(error, LQ_NO_MEMORY, "no memory for figures");
    snprintf(path, sizeof path, "%.4000s/figures.json", r->folder);
    const lq_status status = lq_output_save(path, text, strlen(text), error);
    free(text);
    return status;
}

static const char error_head[] = ",rmse_all,rmse_rest,noise_all,noise_rest,note";
static const char lobe_head[] = ",part,channel,energy,energy_exact,sin2,sin2_exact,mean,mean_exact,across,"
                                "across_exact";
static const char point_head[] = ",first,energy,energy_exact,alpha,alpha_exact";

lq_status lq_layered_report(const lq_layered_request *r, json_t *figures, lq_error *error) {
    lq_layered_sums sums = {.all = NULL};
    lq_status status = lq_layered_sum(&sums, figures, r->model_count, error);
    if (status == LQ_OK) status = write_csv(r, figures, "figures.csv", error_head, put_errors, error);
    if (status == LQ_OK) status = write_csv(r, figures, "lobes.csv", lobe_head, put_lobes, error);
    if (status == LQ_OK) status = write_csv(r, figures, "curves.csv", point_head, put_points, error);
    if (status == LQ_OK) status = draw_curves(r, figures, error);
    if (status == LQ_OK) status = write_json(r, figures, error);
    if (status == LQ_OK) status = lq_layered_page(r, figures, &sums, error);
    lq_layered_sums_free(&sums);
    json_decref(figures);
    return status;
}
