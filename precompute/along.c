/* along.c - which roughnesses are solved. */
#include "precompute/along.h"

#include <math.h>
#include <stdlib.h>

/* The panel that has a node, or -1. */
static int panel_of(const lq_along *along, size_t node) {
    for (int p = 0; p < LQ_ALONG_PANELS; p++)
        if (along->panel[p].used && node >= along->panel[p].begin && node < along->panel[p].end) return p;
    return -1;
}

static void add_value(lq_along *along, double alpha, size_t same, size_t node) {
    along->same[along->count] = same;
    along->node[along->count] = node;
    along->value[along->count++] = alpha;
}

static void add_direct(lq_along *along, size_t node) {
    along->direct[node] = along->count;
    add_value(along, along->nodes[node], along->count, node);
}

/* Every other one of twice as many less one points is a point of before. */
static void add_points(lq_along *along, int p, size_t points, bool repeats) {
    lq_along_panel *panel = &along->panel[p];
    const double from = along->nodes[panel->begin], to = along->nodes[panel->end - 1];
    const size_t before = panel->first;
    panel->series = (lq_series){points, log(from), log(to)};
    panel->first = along->count;
    for (size_t k = 0; k < points; k++) {
        const double alpha = fmin(fmax(exp(lq_series_node(&panel->series, k)), from), to);
        if (repeats && k % 2 == 0)
            add_value(along, along->value[before + k / 2], before + k / 2, along->size);
        else add_value(along, alpha, along->count, along->size);
    }
}

static void add_panel(lq_along *along, int p, size_t begin, size_t end, size_t points) {
    along->panel[p] = (lq_along_panel){.used = true, .begin = begin, .end = end};
    add_points(along, p, points, false);
}

static bool start(lq_along *along, const double *nodes, size_t size, size_t points) {
    *along = (lq_along){.nodes = nodes, .size = size, .most = size + points};
    along->value = malloc(along->most * sizeof *along->value);
    along->same = malloc(along->most * sizeof *along->same);
    along->node = malloc(along->most * sizeof *along->node);
    along->direct = calloc(size, sizeof *along->direct);
    return along->value && along->same && along->node && along->direct;
}

/* What no panel has. */
static void add_rest(lq_along *along) {
    for (size_t i = 0; i < along->size; i++)
        if (panel_of(along, i) < 0) add_direct(along, i);
}

/* ======================================================================================
 *                                    Which panels
 * ====================================================================================== */

bool lq_along_make(lq_along *along, const double *nodes, size_t size, bool interpolate) {
    static const double edges[LQ_ALONG_PANELS + 1] = {1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0};
    /* With these the last coefficients of the frosted metal's energies and moments are 2e-5 and less. */
    static const size_t points[LQ_ALONG_PANELS] = {8, 10, 11};
    if (!start(along, nodes, size, 8 + 10 + 11)) return false;
    for (int p = 0; p < LQ_ALONG_PANELS && interpolate; p++) {
        size_t begin = 0, end = 0;
        while (begin < size && !(nodes[begin] > edges[p])) begin++;
        for (end = begin; end < size && nodes[end] <= edges[p + 1];) end++;
        if (end - begin > points[p]) add_panel(along, p, begin, end, points[p]);
    }
    add_rest(along);
    return true;
}

/* What a solve costs next to one of a large roughness: measured on dielectrics and conductors. */
static double cost_of(double alpha) {
    return 1.0 + fmin(0.08 / alpha, 2.0);
}

static double cost_of_panel(double from, double to, size_t points) {
    const lq_series series = {points, log(from), log(to)};
    double cost = 0.0;
    for (size_t k = 0; k < points; k++) cost += cost_of(exp(lq_series_node(&series, k)));
    return cost;
}

bool lq_along_plan(lq_along *along, const double *nodes, size_t size, double accuracy) {
    double least = INFINITY, before = 0.0;
    size_t begin = size, points = 0;
    if (!start(along, nodes, size, 2 * LQ_ALONG_POINTS)) return false;
    for (size_t i = 0; i < size; before += cost_of(nodes[i]), i++) {
        if (!(nodes[i] > 0.0)) continue;
        const size_t needed = lq_series_points(log(nodes[size - 1] / nodes[i]), accuracy);
        const bool pays = needed < size - i && needed <= LQ_SERIES_MAX;
        const double cost = pays ? before + cost_of_panel(nodes[i], nodes[size - 1], needed) : INFINITY;
        if (!(cost < least)) continue;
        begin = i;
        points = needed;
        least = cost;
    }
    if (begin < size) add_panel(along, 0, begin, size, points);
    add_rest(along);
    return true;
}

void lq_along_free(lq_along *along) {
    free(along->value);
    free(along->same);
    free(along->node);
    free(along->direct);
}

/* ======================================================================================
 *                                    What did not do
 * ====================================================================================== */

void lq_along_refine(lq_along *along, int p) {
    const lq_along_panel *panel = &along->panel[p];
    const size_t points = 2 * panel->series.nodes - 1, added = points - panel->series.nodes;
    if (points > LQ_SERIES_MAX || added >= panel->end - panel->begin) lq_along_drop(along, p);
    else add_points(along, p, points, true);
}

void lq_along_drop(lq_along *along, int p) {
    along->panel[p].used = false;
    for (size_t i = along->panel[p].begin; i < along->panel[p].end; i++) add_direct(along, i);
}

size_t lq_along_weights(const lq_along *along, size_t node, size_t *first, double weight[LQ_ALONG_POINTS]) {
    const int p = panel_of(along, node);
    if (p >= 0) {
        *first = along->panel[p].first;
        lq_series_weights(&along->panel[p].series, log(along->nodes[node]), weight);
        return along->panel[p].series.nodes;
    }
    *first = along->direct[node];
    weight[0] = 1.0;
    return 1;
}
