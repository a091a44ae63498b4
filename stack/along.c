/* along.c - which roughnesses are solved. */
#include "stack/along.h"

#include <math.h>
#include <stdlib.h>

static const double edges[LQ_ALONG_PANELS + 1] = {1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0};

/* With these the last coefficients of the frosted metal's energies and moments are 2e-5 and less. */
static const size_t points[LQ_ALONG_PANELS] = {8, 10, LQ_ALONG_POINTS};

/* The panel of a roughness, or -1. */
static int panel_of(double alpha) {
    for (int p = 0; p < LQ_ALONG_PANELS; p++)
        if (alpha > edges[p] && alpha <= edges[p + 1]) return p;
    return -1;
}

static void add_direct(lq_along *along, size_t node) {
    along->direct[node] = along->count;
    along->value[along->count++] = along->nodes[node];
}

/* The points of a panel, from its first node to its last. */
static void add_panel(lq_along *along, int p, double from, double to) {
    along->panel[p] = (lq_series){points[p], log(from), log(to)};
    along->first[p] = along->count;
    along->panel_used[p] = true;
    for (size_t k = 0; k < points[p]; k++) {
        const double alpha = exp(lq_series_node(&along->panel[p], k));
        along->value[along->count++] = fmin(fmax(alpha, from), to);
    }
}

bool lq_along_make(lq_along *along, const double *nodes, size_t size, bool interpolate) {
    *along = (lq_along){.nodes = nodes, .size = size};
    along->value = malloc((size + LQ_ALONG_PANELS * LQ_ALONG_POINTS) * sizeof *along->value);
    along->direct = calloc(size, sizeof *along->direct);
    if (!along->value || !along->direct) return false;
    for (int p = 0; p < LQ_ALONG_PANELS && interpolate; p++) {
        size_t inside = 0, last = 0;
        for (size_t i = 0; i < size; i++)
            if (panel_of(nodes[i]) == p) {
                inside++;
                last = i;
            }
        if (inside > points[p]) add_panel(along, p, nodes[last + 1 - inside], nodes[last]);
    }
    for (size_t i = 0; i < size; i++) {
        const int p = panel_of(nodes[i]);
        if (p < 0 || !along->panel_used[p]) add_direct(along, i);
    }
    return true;
}

void lq_along_free(lq_along *along) {
    free(along->value);
    free(along->direct);
}

void lq_along_drop(lq_along *along, int panel) {
    along->panel_used[panel] = false;
    for (size_t i = 0; i < along->size; i++)
        if (panel_of(along->nodes[i]) == panel) add_direct(along, i);
}

size_t lq_along_weights(const lq_along *along, size_t node, size_t *first, double weight[LQ_ALONG_POINTS]) {
    const int p = panel_of(along->nodes[node]);
    if (p >= 0 && along->panel_used[p]) {
        *first = along->first[p];
        lq_series_weights(&along->panel[p], log(along->nodes[node]), weight);
        return points[p];
    }
    *first = along->direct[node];
    weight[0] = 1.0;
    return 1;
}
