/* One texel of a factored table that is not what it was.
 *
 * A changed texel moves what is decoded at its centre, and half as much half way to its neighbours. Seen over
 * the texels of its image, with the other axes held anywhere, that is a point that sticks out. The points
 * that do so most are compared with the solver, and so are the neighbours: error minus the mean of the errors
 * to either side (at an edge: minus the errors of the next two, continued), the least over the axes of the
 * image, is what the texel alone is off by. Rounding and fit
 * leave some of that everywhere; one that exceeds the others many times is not theirs.
 */
#include "validate/certificate_checks.h"

#include "pca/factors.h"
#include "system/status.h"
#include "validate/certificate_suspects.h"
#include "validate/stream.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { HOLDS = 6, LOOKED_AT = 10, STREAM_HOLDS = 0x686f6c64 };

/* How many times the median of those looked at, and at least this much: twice what half precision leaves
 * near 1. */
static const double times_median = 5.0, least_spike = 1e-3;

/* A departure that half precision and the fit leave anyway. */
static const double usual = 3e-4;

/* A texel under suspicion: where it is, and its neighbours along the axes of its image. */
typedef struct site {
    int piece, factor;
    size_t texel;
    double score;
    double at[LQ_MAX_AXES], beside[4][LQ_MAX_AXES];
    double weight[4]; /* of the errors beside, which add up to what is expected of it */
    int neighbours;   /* pairs: 1 or 2 */
    double spike;
} site;

/* ---------------------------------------------------------------------------------- the image */

/* Set what a texture axis reads to the centre of its texel `i`. The axis it depends on must be set before. */
static void set_coordinate(const lq_texture_axis *axis, size_t i, double *x) {
    const double u = axis->texels.nodes[i];
    if (axis->coordinate == LQ_COORDINATE_AXIS) {
        x[axis->axis] = u;
        return;
    }
    const double eta = x[axis->other], critical = eta < 1.0 ? sqrt((1.0 - eta) * (1.0 + eta)) : 0.0;
    x[axis->axis] = u < 0.0 ? (u + 1.0) * critical : critical + u * (1.0 - critical);
}

/* The point of texel (column, row), the other axes as in `held`. */
static void texel_point(const lq_factor *factor, size_t column, size_t row, const double *held, double *x) {
    memcpy(x, held, LQ_MAX_AXES * sizeof *x);
    if (factor->axis_count > 1) set_coordinate(&factor->axes[1], row, x);
    set_coordinate(&factor->axes[0], column, x);
}

static size_t rows_of(const lq_factor *factor) {
    return factor->axis_count > 1 ? factor->axes[1].texels.size : 1;
}

/* Decoded values at every texel centre, as a table over texel numbers. */
static lq_status decode_image(const lq_factored *factored, const lq_factor *factor, const double *held,
                              lq_table **image, lq_error *error) {
    lq_axis axes[2] = {{.size = 0}};
    const size_t size[2] = {factor->axes[0].texels.size, rows_of(factor)};
    const char *const names[] = {"column", "row"}, *channel = "decoded";
    lq_status status = LQ_OK;
    for (int a = 0; status == LQ_OK && a < 2; a++)
        status =
            lq_axis_make(&axes[a], names[a], 0.0, (double)(size[a] - 1), size[a], LQ_MAP_LINEAR, 1.0, error);
    if (status == LQ_OK) status = lq_table_create(image, axes, 2, &channel, 1, error);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    for (size_t i = 0; status == LQ_OK && i < size[0] * size[1]; i++) {
        double x[LQ_MAX_AXES];
        texel_point(factor, i % size[0], i / size[0], held, x);
        (*image)->channels[0][i] = (float)lq_factored_lookup(factored, x);
    }
    return status;
}

/* ------------------------------------------------------------------------------------ the sites */

static bool inside(const lq_domain *domain, int axes, const double *x) {
    for (int a = 0; a < axes; a++)
        if (!(x[a] >= domain->min[a] - 1e-9 && x[a] <= domain->max[a] + 1e-9)) return false;
    return true;
}

typedef struct pair {
    size_t first, second;
} pair;

/* One to either side, whose mean is expected; at an end the next two, which are continued. */
static pair neighbours_of(size_t i, size_t count, double *weight) {
    const bool low = i == 0, high = i + 1 == count;
    weight[0] = low || high ? 2.0 : 0.5;
    weight[1] = low || high ? -1.0 : 0.5;
    return low ? (pair){1, 2} : high ? (pair){count - 2, count - 3} : (pair){i - 1, i + 1};
}

/* Point and neighbours; false where some lie outside of the domain or the piece. */
static bool place(site *s, const lq_certified *certified, const lq_factor *factor, const double *held) {
    const lq_piece *piece = &certified->subject.factored->pieces[s->piece];
    const int axes = certified->subject.factored->axis_count;
    const size_t width = factor->axes[0].texels.size, height = rows_of(factor);
    const size_t column = s->texel % width, row = s->texel / width;
    const lq_domain box = certified->certificate.plan.domain;
    lq_domain both = box;
    for (int a = 0; a < axes; a++) {
        both.min[a] = fmax(box.min[a], piece->min[a]);
        both.max[a] = fmin(box.max[a], piece->max[a]);
    }
    texel_point(factor, column, row, held, s->at);
    s->neighbours = 0;
    if (width >= 5) {
        const pair p = neighbours_of(column, width, s->weight);
        texel_point(factor, p.first, row, held, s->beside[0]);
        texel_point(factor, p.second, row, held, s->beside[1]);
        s->neighbours = 1;
    }
    if (height >= 5) {
        const int from = 2 * s->neighbours++;
        const pair p = neighbours_of(row, height, s->weight + from);
        texel_point(factor, column, p.first, held, s->beside[from]);
        texel_point(factor, column, p.second, held, s->beside[from + 1]);
    }
    bool good = s->neighbours > 0 && inside(&both, axes, s->at);
    for (int k = 0; k < 2 * s->neighbours; k++) good = good && inside(&both, axes, s->beside[k]);
    return good;
}

/* Among the best, each texel once. */
static void keep(site *list, size_t *count, const site *s) {
    size_t at = 0;
    while (at < *count &&
           !(list[at].piece == s->piece && list[at].factor == s->factor && list[at].texel == s->texel))
        at++;
    if (at == LOOKED_AT) at--; /* a new one, where the least is */
    if (at < *count && list[at].score >= s->score) return;
    if (at == *count) ++*count;
    for (; at > 0 && list[at - 1].score < s->score; at--) list[at] = list[at - 1];
    list[at] = *s;
}

/* The suspects of one image; `list` holds those by departure, `alone` those compared with what is beside. */
static lq_status look(const lq_certified *certified, int p, int f, const double *held, site *list,
                      size_t *count, lq_error *error) {
    const lq_factored *factored = certified->subject.factored;
    const lq_factor *factor = &factored->pieces[p].factors[f];
    lq_suspect suspects[LQ_SUSPECTS];
    lq_table *image = NULL;
    const lq_status status = decode_image(factored, factor, held, &image, error);
    if (status == LQ_OK) lq_suspects_find(image, usual, suspects);
    for (size_t i = 0; status == LQ_OK && i < LQ_SUSPECTS; i++) {
        const size_t half = i / LQ_LISTED;
        site s = {.piece = p, .factor = f, .texel = suspects[i].index, .score = suspects[i].score};
        if (s.score > 0.0 && place(&s, certified, factor, held))
            keep(list + half * LOOKED_AT, &count[half], &s);
    }
    lq_table_free(image);
    return status;
}

static lq_status find_sites(const lq_certified *certified, site *list, size_t *count, lq_error *error) {
    const lq_factored *factored = certified->subject.factored;
    const lq_domain *domain = &certified->certificate.plan.domain;
    lq_status status = LQ_OK;
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; f < factored->pieces[p].factor_count; f++) {
            lq_stream stream = lq_stream_open(certified->certificate.request.seed, STREAM_HOLDS,
                                              (uint64_t)(p * LQ_MAX_FACTORS + f));
            for (int h = 0; status == LQ_OK && h < HOLDS; h++) {
                double held[LQ_MAX_AXES] = {0.0};
                for (int a = 0; a < factored->axis_count; a++) {
                    const double min = fmax(domain->min[a], factored->pieces[p].min[a]);
                    const double max = fmin(domain->max[a], factored->pieces[p].max[a]);
                    held[a] = min + (max - min) * lq_stream_uniform(&stream);
                }
                status = look(certified, p, f, held, list, count, error);
            }
        }
    return status;
}

/* ----------------------------------------------------------------------------------- the spikes */

static lq_status error_at(const lq_sample_request *r, const lq_factored *factored, const double *x,
                          double *off, lq_error *error) {
    double exact, estimate;
    const lq_status status = lq_point_exact(r->kind, &r->settings, r->curve, x, &exact, &estimate, error);
    *off = (lq_factored_lookup(factored, x) - exact) / (r->relative ? fabs(exact) : 1.0);
    return status;
}

static lq_status measure(const lq_certified *certified, site *s, lq_error *error) {
    const lq_sample_request *r = &certified->certificate.request;
    double here, off[4];
    lq_status status = error_at(r, certified->subject.factored, s->at, &here, error);
    for (int k = 0; status == LQ_OK && k < 2 * s->neighbours; k++)
        status = error_at(r, certified->subject.factored, s->beside[k], &off[k], error);
    s->spike = INFINITY;
    for (int k = 0; status == LQ_OK && k < s->neighbours; k++)
        s->spike = fmin(s->spike,
                        fabs(here - s->weight[2 * k] * off[2 * k] - s->weight[2 * k + 1] * off[2 * k + 1]));
    return status;
}

static int by_spike(const void *a, const void *b) {
    const double x = ((const site *)a)->spike, y = ((const site *)b)->spike;
    return (x < y) - (x > y);
}

static void judge(lq_certified *certified, site *list, size_t count) {
    char at[160] = "";
    if (count == 0) {
        lq_check_add(certified, "single texels", 0.0, least_spike, "no texel sticks out of its neighbours");
        return;
    }
    qsort(list, count, sizeof *list, by_spike);
    lq_point_text(certified->subject.origin.kind, list[0].at, at, sizeof at);
    lq_check_add(
        certified, "single texels", list[0].spike, fmax(times_median * list[count / 2].spike, least_spike),
        "error of one texel against its neighbours', the worst of %zu that stick out: factor %d of piece "
        "%d, at %s",
        count, list[0].factor, list[0].piece, at);
}

lq_status lq_check_texels(lq_certified *certified, lq_error *error) {
    if (!certified->subject.factored) return LQ_OK;
    const lq_sample_request *r = &certified->certificate.request;
    const int threads = r->threads > 0 ? r->threads : omp_get_num_procs();
    site *list = calloc((size_t)2 * LOOKED_AT, sizeof *list);
    size_t count[2] = {0, 0};
    lq_status states[2 * LOOKED_AT];
    lq_error causes[2 * LOOKED_AT];
    if (!list) return lq_fail(error, LQ_NO_MEMORY, "no memory for texels");
    lq_status status = find_sites(certified, list, count, error);
    memmove(list + count[0], list + LOOKED_AT, count[1] * sizeof *list);
    const size_t all = count[0] + count[1];
    if (status == LQ_OK) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
        for (size_t i = 0; i < all; i++) states[i] = measure(certified, &list[i], &causes[i]);
    }
    for (size_t i = 0; status == LQ_OK && i < all; i++) {
        status = states[i];
        if (status != LQ_OK && error) *error = causes[i];
    }
    if (status == LQ_OK) judge(certified, list, all);
    free(list);
    return status;
}
