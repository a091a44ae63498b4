/* layered_page.c - one page that needs no script; its pictures are files beside it. */
#include "validate/layered_page.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/document.h"
#include "system/status.h"
#include "system/stream.h"

static const char *const sides[LQ_GONIO_SIDES] = {"reflected", "transmitted"};

static const char intro[] =
    "<p>RMSE (Ba19 eq. 4): root mean square over 90 &times; 360 cells of direction of what a model's f cos "
    "theta_o misses of the measured one, net of the measurement's noise; over angles of incidence and sides "
    "too. First all light, then light that was inside, without the direct lobe.</p>\n"
    "<p>Slices: azimuth from 0 (away from the light) to 180 degrees to the right, polar angle from 0 to 90 "
    "degrees upwards; four decades below the brightest measured cell. Below each model what it differs by: "
    "red is too much, full colour a tenth of that cell.</p>\n";

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double lq_layered_median(const double *values, size_t count, size_t step, const bool *used) {
    double *sorted = malloc((count + 1) * sizeof *sorted);
    size_t n = 0;
    for (size_t i = 0; sorted && i < count; i++)
        if (isfinite(values[i * step]) && (!used || used[i])) sorted[n++] = values[i * step];
    if (n > 0) qsort(sorted, n, sizeof *sorted, ascending);
    const double median = n == 0 ? NAN : 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
    free(sorted);
    return median;
}

/* ======================================================================================
 *                                        Tables
 * ====================================================================================== */

static void put_head(FILE *out, const lq_layered_request *r, const char *first) {
    const char *heads[1 + LQ_LAYERED_MODELS] = {first};
    for (size_t m = 0; m < r->model_count; m++) heads[1 + m] = r->models[m].label;
    lq_document_table(out, heads, 1 + r->model_count);
}

static void put_median(FILE *out, const lq_layered_request *r, const lq_layered_sums *sums,
                       const char *category) {
    bool used[LQ_LAYERED_MAX];
    size_t count = 0;
    for (size_t i = 0; i < sums->stacks; i++) {
        used[i] = strcmp(r->set->stacks[i].category, category) == 0;
        count += used[i];
    }
    fprintf(out, "<tr><td>%s (%zu)</td>", category, count);
    for (size_t m = 0; m < sums->models; m++) {
        const double all = lq_layered_median(&sums->all[m], sums->stacks, sums->models, used);
        const double rest = lq_layered_median(&sums->rest[m], sums->stacks, sums->models, used);
        if (isfinite(all)) fprintf(out, "<td>%.4f / %.4f</td>", all, rest);
        else fputs("<td></td>", out);
    }
    fputs("</tr>\n", out);
}

static bool seen_before(const lq_layered_set *set, size_t i) {
    for (size_t k = 0; k < i; k++)
        if (strcmp(set->stacks[k].category, set->stacks[i].category) == 0) return true;
    return false;
}

static size_t best_of(const double *row, size_t count) {
    size_t best = count;
    for (size_t m = 0; m < count; m++)
        if (isfinite(row[m]) && (best == count || row[m] < row[best])) best = m;
    return best;
}

static void put_stack_row(FILE *out, const lq_layered_request *r, const lq_layered_sums *sums, size_t i) {
    const double *all = &sums->all[i * sums->models], *rest = &sums->rest[i * sums->models];
    const size_t best = best_of(all, sums->models);
    const char *name = r->set->stacks[i].stack->name;
    fprintf(out, "<tr><td><a href=\"#%s\">%s</a></td>", name, name);
    for (size_t m = 0; m < sums->models; m++) {
        if (isfinite(all[m]))
            fprintf(out, "<td%s>%.4f / %.4f</td>", m == best ? " class=\"best\"" : "", all[m], rest[m]);
        else fputs("<td class=\"soft\">refused</td>", out);
    }
    fputs("</tr>\n", out);
}

static bool is_curve(const lq_layered_stack *stack) {
    return strcmp(stack->category, "curves") == 0;
}

static void put_tables(FILE *out, const lq_layered_request *r, const lq_layered_sums *sums) {
    const lq_layered_set *set = r->set;
    lq_document_heading(out, 2, NULL, "Medians");
    put_head(out, r, "category");
    for (size_t i = 0; i < set->count; i++)
        if (!seen_before(set, i) && !is_curve(&set->stacks[i]))
            put_median(out, r, sums, set->stacks[i].category);
    lq_document_table_end(out);
    lq_document_heading(out, 2, NULL, "Every stack");
    put_head(out, r, "stack");
    for (size_t i = 0; i < set->count; i++)
        if (!is_curve(&set->stacks[i])) put_stack_row(out, r, sums, i);
    lq_document_table_end(out);
}

/* ======================================================================================
 *                                        Slices
 * ====================================================================================== */

typedef struct showing {
    FILE *out;
    const lq_layered_request *request;
    const char *stack;
    double theta;
    int side;
} showing;

static void put_slice(const showing *s, const lq_layered_row *row, const char *label) {
    char path[512];
    lq_layered_picture(path, sizeof path, s->request->set->name, row->stack, row->theta, row->side, label);
    fprintf(s->out, "<figure><img class=\"slice\" loading=\"lazy\" src=\"%s\" alt=\"%s\"><figcaption>%s",
            path, label ? label : "measured", label ? label : "measured");
    if (label) fprintf(s->out, "<br>%.4f / %.4f", lq_layered_rmse(row, true), lq_layered_rmse(row, false));
    fputs("</figcaption></figure>\n", s->out);
}

/* The first row of an angle and side shows what was measured there. */
static void show(void *user, const lq_layered_row *row) {
    showing *s = user;
    if (row->curve) return;
    if (!s->stack || strcmp(s->stack, row->stack) != 0)
        fprintf(s->out, "%s<h3 id=\"%s\">%s</h3>\n<div>", s->stack ? "</div></div>\n" : "", row->stack,
                row->stack);
    if (!s->stack || strcmp(s->stack, row->stack) != 0 || s->theta != row->theta || s->side != row->side) {
        fprintf(s->out, "</div><p class=\"soft\">%g degrees, %s</p><div class=\"row\">\n", row->theta,
                sides[row->side]);
        put_slice(s, row, NULL);
    }
    if (row->refused) fprintf(s->out, "<figure><figcaption>%s: refused</figcaption></figure>\n", row->model);
    else put_slice(s, row, row->model);
    s->stack = row->stack;
    s->theta = row->theta;
    s->side = row->side;
}

static void put_curves(FILE *out, const lq_layered_set *set) {
    for (size_t i = 0; i < set->count; i++) {
        if (!is_curve(&set->stacks[i])) continue;
        if (i > 0 && strcmp(set->stacks[i - 1].base, set->stacks[i].base) == 0) continue;
        fprintf(out, "<p><img src=\"%s.png\" width=\"720\" alt=\"%s\"></p>\n", set->stacks[i].base,
                set->stacks[i].base);
    }
}

lq_status lq_layered_page(const lq_layered_request *r, json_t *figures, const lq_layered_sums *sums,
                          lq_error *error) {
    char path[5000], title[160];
    lq_stream stream;
    snprintf(path, sizeof path, "%.4000s/index.html", r->folder);
    const lq_status opened = lq_stream_open(&stream, path, error);
    if (opened != LQ_OK) return opened;
    snprintf(title, sizeof title, "Layered models on the set %.80s", r->set->name);
    lq_document_begin(stream.out, title);
    fprintf(stream.out,
            "<p>lacquer " LQ_VERSION
            ", %zu walks a slice, seed %llu. <a href=\"figures.csv\">figures.csv</a>, "
            "<a href=\"lobes.csv\">lobes.csv</a>, <a href=\"figures.json\">figures.json</a></p>\n",
            r->samples, (unsigned long long)r->seed);
    showing s = {.out = stream.out, .request = r};
    const bool slices = !is_curve(&r->set->stacks[0]);
    if (slices) {
        fputs(intro, stream.out);
        put_tables(stream.out, r, sums);
    }
    put_curves(stream.out, r->set);
    lq_layered_rows(figures, show, &s);
    if (s.stack) fputs("</div></div>\n", stream.out);
    lq_document_end(stream.out);
    return lq_stream_close(&stream, LQ_OK, error);
}
